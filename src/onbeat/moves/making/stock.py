"""What a builder has in stock: readings, clips and blocks of pairs, known by their content.

A row of the index is committed after its bytes are on disk, and each task's result for itself: whatever ends a
builder, what it had finished is found by the next one.
"""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Collection, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple, cast

import msgspec
import numpy as np

from onbeat.errors import LibraryError
from onbeat.moves.disk.index import INDEX, committed, create_index, storing
from onbeat.moves.disk.layout import Shape
from onbeat.moves.disk.shards import Bytes, DiskShards, MemoryShards, Span
from onbeat.moves.making.placing import Placed, Reading
from onbeat.moves.making.stretches import MARK, Stretch

SHARDS = "shards"
PAIR = np.dtype([("first", "<u2"), ("second", "<u2"), ("distance", "<f4")])
"""A pair as it is stored: frames of its two groups, and their distance."""
_CLIP = "id, content, sha256, shard, offset, size, mirrored, fps, frames, joints, poses, width, stops, keyposes"


class Row(NamedTuple):
    """A clip in the index: its number, content, digest and place of its bytes, and its counts.

    Its content is its recording's, with the key of its stretch where it is not all of the recording.
    """

    id: int
    content: str
    digest: str
    span: Span
    shape: Shape

    @property
    def stretch(self) -> Stretch:
        """Which part of its recording it is."""
        return Stretch.told(self.content)

    def is_of(self, content: str) -> bool:
        """Whether it was made of a recording of this content."""
        return self.content == content + self.stretch.key


def clip_row(values: tuple[Any, ...]) -> Row:
    """A row of the columns ``CLIP``; a ``LibraryError`` if it cannot be."""
    number, content, digest, *place = values[:6]
    mirrored, fps, *counts = values[6:]
    fps = fps if isinstance(fps, float) else 0.0
    row = Row(number, content, digest, Span(*place), Shape(bool(mirrored), fps, *counts))
    if not _can_be(row):
        raise LibraryError(f"the index of the library is damaged (clip {row.id}); build the library again")
    return row


def block_span(shard: object, offset: object, count: object) -> Span:
    """The place of a block's pairs; a ``LibraryError`` if the index says something that is none."""
    if isinstance(shard, int) and isinstance(offset, int) and isinstance(count, int):
        return Span(shard, offset, count * PAIR.itemsize)
    raise LibraryError("its place is no number; build the library again")


def _can_be(row: Row) -> bool:
    """Whether the numbers of a row fit each other; there may be anything in the index of a damaged library."""
    numbers: list[object] = [*row.span, *row.shape[2:]]
    whole = all(isinstance(number, int) and number >= 0 for number in numbers)
    whole = whole and isinstance(cast("object", row.content), str)
    return whole and 0 < row.shape.fps < 1e6 and row.shape.size == row.span.size


class Stock:
    """The index of a library and its shards, for its one builder.

    Parameters
    ----------
    folder : the library's, or nothing for a library in memory.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self._path = None if folder is None else folder / INDEX
        self.index = create_index(self._path)
        if folder is None:
            self.clips: DiskShards | MemoryShards = MemoryShards()
            self.pairs: DiskShards | MemoryShards = MemoryShards()
        else:
            self.clips = DiskShards(folder / SHARDS, "clips", self._end("clips", "size"))
            self.pairs = DiskShards(folder / SHARDS, "pairs", self._end("blocks", f"count * {PAIR.itemsize}"))

    def _end(self, table: str, size: str) -> tuple[int, int]:
        """Where the last place that the index knows of ends."""
        # a place without bytes may begin where another does
        last = f"SELECT shard, offset, {size} FROM {table} ORDER BY shard DESC, offset DESC, {size} DESC LIMIT 1"
        with storing(self._path):
            row = self.index.execute(last).fetchone()
        return (0, 0) if row is None else Span(*row).end

    def close(self) -> None:
        """Close all files."""
        for shards in (self.clips, self.pairs):
            if isinstance(shards, DiskShards):
                shards.close()
        self.index.close()

    def storing(self) -> AbstractContextManager[None]:
        """What cannot be written becomes a ``StorageError``."""
        return storing(self._path)

    def rows(self, query: str, *values: Any) -> list[tuple[Any, ...]]:
        """What a query finds."""
        with self.storing():
            return self.index.execute(query, values).fetchall()

    def reading(self, content: str, method: str) -> Reading | None:
        """What is known of a content, read by a method."""
        query = "SELECT content, body, seconds, notes, problem FROM readings WHERE content = ? AND method = ?"
        for content_, body, seconds, notes, problem in self.rows(query, content, method):
            return Reading(content_, body, seconds, tuple(msgspec.json.decode(notes, type=list[str])), problem)
        return None

    def put_readings(self, readings: Iterable[Reading], method: str) -> None:
        """Keep what readings gave; not of files that changed meanwhile or cannot be opened."""
        rows = [
            (r.content, method, r.body, r.seconds, msgspec.json.encode(r.notes).decode(), r.problem)
            for r in readings
            if r.content
        ]
        with self.storing(), committed(self.index):
            self.index.executemany("INSERT OR REPLACE INTO readings VALUES (?, ?, ?, ?, ?, ?)", rows)

    def clips_of(self, content: str, stage: str) -> list[Row]:
        """The clips of a recording on a stage: stretch by stretch, each followed by its mirror image."""
        part = "(content = ? OR (content >= ? AND content < ?))"
        query = f"SELECT {_CLIP} FROM clips WHERE {part} AND stage = ?"
        found: list[Row] = []
        for values in self.rows(query, content, content + MARK, content + chr(ord(MARK) + 1), stage):
            try:
                found.append(clip_row(values))
            except LibraryError:
                self._forget([values[0]])
        return sorted(found, key=lambda row: (row.stretch.number, row.shape.mirrored))

    def put_clips(self, placed: Placed, stage: str) -> None:
        """Keep the clips of a recording, or why there is none."""
        if placed.problem is not None:
            self.put_readings([Reading(placed.content, problem=placed.problem)], stage)
            return
        with self.storing():
            spans = [self.clips.append(arrays) for _, _, arrays in placed.clips]
            self._put_rows(
                (placed.content + key, stage, *shape, *span, _digest(arrays))
                for (key, shape, arrays), span in zip(placed.clips, spans, strict=True)
            )

    def put_copy(self, row: Row, stage: str, data: Bytes) -> None:
        """Keep a clip of another library, if it is not there already."""
        query = "SELECT 1 FROM clips WHERE content = ? AND stage = ? AND mirrored = ?"
        if not self.rows(query, row.content, stage, row.shape.mirrored):
            with self.storing():
                span = self.clips.append([data])
                self._put_rows([(row.content, stage, *row.shape, *span, row.digest)])

    def _put_rows(self, rows: Iterable[tuple[Any, ...]]) -> None:
        """Name clips whose bytes were written."""
        self.clips.sync()
        columns = "content, stage, mirrored, fps, frames, joints, poses, width, stops, keyposes"
        places = f"({columns}, shard, offset, size, sha256) VALUES ({', '.join('?' * 14)})"
        with committed(self.index):
            self.index.executemany(f"INSERT OR IGNORE INTO clips {places}", rows)

    def block(self, key: bytes) -> np.ndarray | None:
        """The pairs of a block, of the kind ``PAIR``; nothing if they are not there, or damaged."""
        for shard, offset, count, crc in self.rows("SELECT shard, offset, count, crc FROM blocks WHERE key = ?", key):
            try:
                pairs = self.pairs.read(block_span(shard, offset, count)) if count else np.zeros(0, np.uint8)
            except LibraryError:
                return None
            return pairs.view(PAIR) if zlib.crc32(pairs.data) == crc else None
        return None

    def put_blocks(self, blocks: Iterable[tuple[bytes, np.ndarray]]) -> None:
        """Keep the pairs of blocks."""
        with self.storing():
            rows: list[tuple[bytes, int, int, int, int]] = []
            for key, pairs in blocks:
                span = self.pairs.append([pairs])
                rows.append((key, span.shard, span.offset, len(pairs), zlib.crc32(pairs.tobytes())))
            self.pairs.sync()
            with committed(self.index):
                self.index.executemany("INSERT OR REPLACE INTO blocks VALUES (?, ?, ?, ?, ?)", rows)

    def drop_damaged(self, rows: Iterable[Row]) -> set[str]:
        """Forget clips whose bytes are not what they were; their contents."""
        rows = list(rows)
        with ThreadPoolExecutor(2) as pool:
            good = list(pool.map(self.is_good, rows))
        bad = [row for row, is_good in zip(rows, good, strict=True) if not is_good]
        if bad:
            self._forget([row.id for row in bad])
        return {row.content for row in bad}

    def _forget(self, clips: Iterable[int]) -> None:
        with self.storing(), committed(self.index):
            self.index.executemany("DELETE FROM clips WHERE id = ?", [(clip,) for clip in clips])

    def is_good(self, row: Row) -> bool:
        """Whether the bytes of a clip are what they were when they were written."""
        try:
            return sha256(self.clips.read(row.span).data).hexdigest() == row.digest
        except LibraryError:
            return False


def is_whole(rows: Sequence[Row], kinds: Collection[bool]) -> bool:
    """Whether clips are all of a recording's, as they are (false) or mirror images (true)."""
    wanted = rows[0].stretch.total if rows else 1
    return all(sum(row.shape.mirrored == kind for row in rows) == wanted for kind in kinds)


def _digest(arrays: Iterable[np.ndarray]) -> str:
    total = sha256()
    for array in arrays:
        total.update(np.ascontiguousarray(array).data)
    return total.hexdigest()


def select_clips(index: sqlite3.Connection, where: str = "", *values: Any) -> list[Row]:
    """The clips of an index that a condition names."""
    rows = index.execute(f"SELECT {_CLIP} FROM clips {where}", values).fetchall()  # an open cursor keeps a lock
    return [clip_row(row) for row in rows]
