"""Fetching on the command line: lists, the licence before a download, progress; names where paths are expected."""

from __future__ import annotations

import os
import sys
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from onbeat.cli.progress import Stages
from onbeat.fetch import Receipt, Source, all_sources, fetch, fetched_moves, fetched_song, source_named
from onbeat.fetch.fetching import megabytes
from onbeat.fetch.places import folder_of, is_fetched
from onbeat.fetch.sources import Kind

MIRROR = "ONBEAT_MIRROR"
"""The variable that names a mirror, which is asked first."""
SONG = "song:"


def list_sources(kind: Kind, *, as_json: bool) -> None:
    """What there is to fetch, on stdout."""
    known = all_sources(kind).values()
    if as_json:
        rows = [_row(source) for source in known]
        sys.stdout.write(msgspec.json.format(msgspec.json.encode(rows), indent=2).decode() + "\n")
        return
    for source in known:
        here = "by hand" if source.by_hand else "here" if is_fetched(source) else ""
        line = f"{source.name:<18} {_size(source):>9}  {here:<7}  {source.licence}".rstrip()
        sys.stdout.write(f"{line}\n    {source.title}\n")


def _row(source: Source) -> dict[str, object]:
    told = {
        name: getattr(source, name) for name in ("name", "title", "licence", "licence_url", "credit", "page", "mind")
    }
    return {**told, "bytes": source.size, "by_hand": bool(source.by_hand), "fetched": is_fetched(source)}


def _size(source: Source) -> str:
    if source.size is not None:
        return megabytes(source.size)
    least = sum(file.size or 0 for file in source.files)
    return f"> {megabytes(least)}" if least >= 1e5 else "?"


def fetch_named(kind: Kind, name: str, to: Path | None, *, renew: bool) -> tuple[Receipt, Path]:
    """Fetch a source: its licence on stderr first, then progress there; its receipt and where it lies."""
    source = source_named(kind, name)
    _tell_terms(source)
    lines: list[str] = []
    try:
        with Stages() as stages:
            receipt = fetch(
                source,
                to,
                when=datetime.now(UTC).isoformat(timespec="seconds"),
                mirror=os.environ.get(MIRROR, ""),
                renew=renew,
                step=stages,
                tell=lines.append,
            )
    finally:
        for line in lines:
            _say(line)
    return receipt, folder_of(source) if to is None else to


def _tell_terms(source: Source) -> None:
    """What has to be known before anything is loaded."""
    terms = source.licence + (f" ({source.licence_url})" if source.licence_url else "")
    files = "1 file" if len(source.files) == 1 else f"{len(source.files)} files"
    rows = [
        ("licence", terms),
        ("credit", source.credit),
        ("page", source.page),
        *(("mind", line) for line in source.mind),
        *([("size", f"{files}, {_size(source)}")] if source.files else []),
    ]
    print(f"{source.name}: {source.title}", file=sys.stderr)  # noqa: T201
    for name, value in rows:
        print(f"  {name:<8} {value}", file=sys.stderr)  # noqa: T201


def _say(line: str) -> None:
    print(f"onbeat: {line}", file=sys.stderr)  # noqa: T201


def moves_path(moves: Path) -> Path:
    """A path of moves, or the folder of a motion set that is named and was fetched.

    Raises
    ------
    FetchError
        If it is the name of a set that was not fetched.
    """
    if moves.exists() or str(moves) not in all_sources("moves"):
        return moves
    found = fetched_moves(str(moves))
    _credit(source_named("moves", str(moves)))
    return found


def song_path(song: Path) -> Path:
    """A path of a song, or the file of a song that is named, as ``song:vibe-ace``, and was fetched.

    Raises
    ------
    FetchError
        If no song is known by this name, or it was not fetched.
    """
    if song.exists() or not str(song).startswith(SONG):
        return song
    name = str(song).removeprefix(SONG)
    found = fetched_song(name)
    _credit(source_named("songs", name))
    return found


def _credit(source: Source) -> None:
    _say(f"{source.name} is {source.licence}; credit: {source.credit}")
