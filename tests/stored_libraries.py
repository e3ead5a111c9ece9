"""What a library's folder holds, however it came to it."""

from __future__ import annotations

import sqlite3
from pathlib import Path


def rows(folder: Path, query: str) -> list[tuple]:
    """What a query finds in the index of a library."""
    index = sqlite3.connect(folder / "index.sqlite")
    try:
        return index.execute(query).fetchall()
    finally:
        index.close()


def change(folder: Path, statement: str, *values: object) -> None:
    """Change the index of a library by hand."""
    index = sqlite3.connect(folder / "index.sqlite")
    with index:
        index.execute(statement, values)
    index.close()


def kept(folder: Path) -> dict[str, object]:
    """All that a library is: its recordings, clips and blocks by their checksums, and the bytes of its graph."""
    clips = (
        "SELECT m.position, m.recording, c.content, c.stage, c.mirrored, c.fps, c.frames, c.poses, c.sha256 "
        "FROM members m JOIN clips c ON c.id = m.clip ORDER BY m.position"
    )
    graph = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.glob("graph-*/*")}
    return {
        "generation": rows(folder, "SELECT * FROM generations"),
        "recordings": rows(folder, "SELECT * FROM recordings ORDER BY position"),
        "clips": rows(folder, clips),
        "blocks": sorted(rows(folder, "SELECT key, count, crc FROM blocks")),
        "readings": sorted(rows(folder, "SELECT * FROM readings"), key=str),
        **graph,
    }
