"""Whether a library is what it was when it was built: every checksum and every reference."""

from __future__ import annotations

import contextlib
import zlib
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path

import numpy as np

from onbeat.errors import LibraryError
from onbeat.moves.disk.graph_files import graph_digest, lead_somewhere, open_graph
from onbeat.moves.disk.index import INDEX, reading
from onbeat.moves.disk.lock import BusyError, StorageError, building
from onbeat.moves.disk.shards import DiskShards
from onbeat.moves.library import REACH
from onbeat.moves.making.groups import GROUP
from onbeat.moves.making.publish import Draft
from onbeat.moves.making.stock import PAIR, SHARDS, Row, block_span, select_clips
from onbeat.moves.store import Stored, open_library, read_stored

PART = 10_000  # blocks read from the index at a time


def verify_library(folder: Path, step: Callable[[str, float], None] | None = None) -> list[str]:
    """What is wrong with a library, a line each; nothing if all is well.

    Raises
    ------
    LibraryError
        If there is no library, or a builder is at work in it.
    """
    step = step or (lambda what, share: None)
    with _undisturbed(folder):
        try:
            stored = read_stored(folder)
            open_library(folder)
        except LibraryError as error:
            if not (folder / INDEX).is_file():
                raise
            return [str(error)]
        return [*_index(folder), *_clips(folder, step), *_pairs(folder, step), *_graph(folder, stored)]


@contextlib.contextmanager
def _undisturbed(folder: Path) -> Generator[None, None, None]:
    """While nobody builds; where nobody can, for the folder cannot be written, nothing needs to be done."""
    with contextlib.ExitStack() as stack:
        if (folder / INDEX).is_file():
            try:
                stack.enter_context(building(folder))
            except BusyError:
                raise
            except StorageError:
                pass
        yield


def _index(folder: Path) -> Iterator[str]:
    with reading(folder / INDEX) as index:
        for (told,) in index.execute("PRAGMA integrity_check(20)").fetchall():
            if told != "ok":
                yield f"{INDEX}: {told}"


def _clips(folder: Path, step: Callable[[str, float], None]) -> Iterator[str]:
    with reading(folder / INDEX) as index:
        rows = select_clips(index, "ORDER BY shard, offset")
    shards = DiskShards(folder / SHARDS, "clips")

    def check(row: Row) -> str | None:
        try:
            good = sha256(shards.read(row.span).data).hexdigest() == row.digest
        except LibraryError as error:
            return f"clip {row.id}: {error}"
        return None if good else f"clip {row.id}: its bytes in {shards.path(row.span.shard)} are not those it had"

    with ThreadPoolExecutor(2) as pool:
        for number, told in enumerate(pool.map(check, rows)):
            step("clips", 0.6 * number / len(rows))
            if told is not None:
                yield told


def _pairs(folder: Path, step: Callable[[str, float], None]) -> Iterator[str]:
    shards = DiskShards(folder / SHARDS, "pairs")
    for number, (key, shard, offset, count, crc) in enumerate(_blocks(folder)):
        if number % PART == 0:
            step("pairs", 0.6)
        try:
            pairs = shards.read(block_span(shard, offset, count)) if count else np.zeros(0, np.uint8)
        except LibraryError as error:
            yield f"block {key.hex()}: {error}"
            continue
        if zlib.crc32(pairs.data) != crc:
            yield f"block {key.hex()}: its bytes in {shards.path(shard)} are not those it had"
        elif not _can_be(pairs.view(PAIR)):
            yield f"block {key.hex()}: a pair of it cannot be"


def _blocks(folder: Path) -> Iterator[tuple[bytes, int, int, int, int]]:
    """All blocks of an index, some at a time, so that no builder waits."""
    last = b""
    while True:
        with reading(folder / INDEX) as index:
            query = "SELECT key, shard, offset, count, crc FROM blocks WHERE key > ? ORDER BY key LIMIT ?"
            rows = index.execute(query, (last, PART)).fetchall()
        yield from rows
        if len(rows) < PART:
            return
        last = rows[-1][0]


def _can_be(pairs: np.ndarray) -> bool:
    if not len(pairs):
        return True
    farthest = max(int(pairs["first"].max()), int(pairs["second"].max()))
    return farthest < GROUP and bool((pairs["distance"] >= 0).all() and (pairs["distance"] <= 1.001 * REACH).all())


def _graph(folder: Path, stored: Stored) -> Iterator[str]:
    new = stored.generation
    members = [(number, row) for (number, _), row in zip(new.members, stored.rows, strict=True)]
    draft = Draft(new.method, new.options, new.reading, new.stage, new.skeleton, new.entries, members)
    if graph_digest(folder, new.graph, draft.seal) != new.graph:
        yield f"{new.graph}: its bytes are not those it had"
    graph = open_graph(folder, new.graph, stored.clip_of)
    if not lead_somewhere(graph.targets, len(graph)):
        yield f"{new.graph}: joins lead to frames that are not there"
    if draft.content(new.graph) != new.content:
        yield f"{INDEX}: recordings, names or options are not those it had"
