"""Shards: files that only grow, in which the arrays of a library lie one after the other.

What was written stays where it is. The index (``index``) names a place only after its bytes are on disk, so a builder
that was stopped leaves at most bytes that no row names; the next one writes over them.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from onbeat.errors import LibraryError

SHARD = 1 << 30
"""Bytes after which a new file is begun."""
ALIGNMENT = 64
"""Bytes: each place begins at a multiple of it, so that its arrays can be mapped as they are."""
Bytes = NDArray[np.uint8]


class Span(NamedTuple):
    """A place in the shards of one series: number of the file, first byte, bytes."""

    shard: int
    offset: int
    size: int

    @property
    def end(self) -> tuple[int, int]:
        """Where the next place may begin."""
        return self.shard, self.offset + -(-self.size // ALIGNMENT) * ALIGNMENT


class Shards(Protocol):
    """One series of shards."""

    def append(self, arrays: Sequence[np.ndarray]) -> Span:
        """Write arrays one after the other, and say where."""
        ...

    def sync(self) -> None:
        """Return when all that was written is on disk."""
        ...

    def read(self, span: Span) -> Bytes:
        """The bytes of a place, read-only; a ``LibraryError`` says if they are not there."""
        ...


class DiskShards:
    """Shards in a folder: ``clips-00000.bin``, ``clips-00001.bin`` and so on.

    Parameters
    ----------
    folder : where the files lie; made when it is first written to.
    series : the first part of their names.
    end : number of the last file and its bytes that the index knows of; appending begins there.
    """

    def __init__(self, folder: Path, series: str, end: tuple[int, int] = (0, 0)) -> None:
        self._folder, self._series, self._end = folder, series, end
        self._writing: int | None = None
        self._maps: dict[int, Bytes] = {}

    def path(self, shard: int) -> Path:
        """The file of a shard."""
        return self._folder / f"{self._series}-{shard:05}.bin"

    def append(self, arrays: Sequence[np.ndarray]) -> Span:
        """Write arrays one after the other; an ``OSError`` leaves only bytes that the next call writes over."""
        shard, offset = self._end
        if offset >= SHARD:
            self.close()
            shard, offset = shard + 1, 0
        handle = self._open(shard)
        os.lseek(handle, offset, os.SEEK_SET)
        span = Span(shard, offset, sum(_write(handle, array) for array in arrays))
        self._end = span.end
        return span

    def _open(self, shard: int) -> int:
        if self._writing is None:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._writing = os.open(self.path(shard), os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
            os.ftruncate(self._writing, self._end[1] if shard == self._end[0] else 0)
        return self._writing

    def sync(self) -> None:
        """Return when all that was written is on disk."""
        if self._writing is not None:
            os.fsync(self._writing)

    def read(self, span: Span) -> Bytes:
        """The mapped bytes of a place."""
        found = self._maps.get(span.shard)
        if found is None or span.offset + span.size > len(found):
            found = self._maps[span.shard] = self._map(span.shard)
        if min(span.offset, span.size) < 0 or span.offset + span.size > len(found):
            raise LibraryError(
                f"{self.path(span.shard)} ends at byte {len(found)}, {span.offset + span.size} are expected; "
                "build the library again"
            )
        return found[span.offset : span.offset + span.size]

    def _map(self, shard: int) -> Bytes:
        path = self.path(shard)
        try:
            size = path.stat().st_size
            # an empty file cannot be mapped; not a memmap, whose slices are slow
            return np.asarray(np.memmap(path, np.uint8, "r")) if size else np.zeros(0, np.uint8)
        except (OSError, ValueError) as error:
            raise LibraryError(f"{path} is missing or damaged ({error}); build the library again") from None

    def bytes_on_disk(self) -> int:
        """Bytes of all files."""
        return sum(path.stat().st_size for path in self._folder.glob(f"{self._series}-*.bin"))

    def begin_anew(self) -> None:
        """Append to a new file from now on."""
        self.close()
        self._end = self._end[0] + 1, 0

    def drop(self, kept: Iterable[int]) -> None:
        """Delete the files of all shards but those kept, and what is appended to."""
        stay = {self.path(shard).name for shard in {*kept, self._end[0]}}
        for path in self._folder.glob(f"{self._series}-*.bin"):
            if path.name not in stay:
                with contextlib.suppress(OSError):  # somebody reads it (on Windows): the next builder tries again
                    path.unlink()

    def close(self) -> None:
        """Close the file that is written to."""
        if self._writing is not None:
            os.close(self._writing)
            self._writing = None


class MemoryShards:
    """Shards of a library that is kept nowhere."""

    def __init__(self) -> None:
        self._parts: list[Bytes] = []

    def append(self, arrays: Sequence[np.ndarray]) -> Span:
        """Keep the bytes of arrays, one after the other."""
        whole = np.frombuffer(b"".join(np.ascontiguousarray(array).tobytes() for array in arrays), np.uint8)
        self._parts.append(whole)
        return Span(len(self._parts) - 1, 0, len(whole))

    def sync(self) -> None:
        """Nothing is on disk."""

    def read(self, span: Span) -> Bytes:
        """The bytes that were kept."""
        return self._parts[span.shard][span.offset : span.offset + span.size]


def _write(handle: int, array: np.ndarray) -> int:
    """Write all bytes of an array; how many there were."""
    left = np.ascontiguousarray(array).data.cast("B") if array.size else memoryview(b"")
    total = len(left)
    while left:
        left = left[os.write(handle, left) :]
    return total
