"""Close pairs of frames: local minima of the distance table, found block by block.

The table of all pairs is never held: each block is one matrix product, scanned at once for its local minima. A block
reads a rim of its neighbours, so that minima at its edge are those of the whole table.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import njit
from threadpoolctl import threadpool_limits

from onbeat._shapes import Float32, Ints

_Pairs = tuple[Ints, Ints, Float32]
BLOCK = 1024  # rows and columns of a block: 4 MB of float32, which stays in cache


@njit(cache=True, nogil=True)
def _minima(
    table: Float32, top: int, left: int, rows: tuple[int, int], columns: tuple[int, int], limit: float, reach: int
) -> tuple[Ints, Ints, Float32]:
    """Local minima of a table under ``limit`` within ``rows`` × ``columns``; indices are shifted by top and left."""
    size = 1024
    first, second, value = np.empty(size, np.int64), np.empty(size, np.int64), np.empty(size, np.float32)
    count = 0
    height, width = table.shape
    for i in range(rows[0], rows[1]):
        for j in range(columns[0], columns[1]):
            here = table[i, j]
            if here >= limit:
                continue
            lowest = True
            for di in range(-reach, reach + 1):
                for dj in range(-reach, reach + 1):
                    a, b = i + di, j + dj
                    inside = 0 <= a < height and 0 <= b < width
                    # equal neighbours: the earlier one counts, so that a plateau gives one minimum
                    if inside and (table[a, b] < here or (table[a, b] == here and (di < 0 or (di == 0 and dj < 0)))):
                        lowest = False
            if lowest:
                if count == size:
                    size *= 2
                    first, second, value = _grown(first, size), _grown(second, size), _grown(value, size)
                first[count], second[count], value[count] = i + top, j + left, here
                count += 1
    return first[:count], second[:count], value[:count]


@njit(cache=True, nogil=True)
def _grown(values: np.ndarray, size: int) -> np.ndarray:
    grown = np.empty(size, values.dtype)
    grown[: len(values)] = values
    return grown


def _block(a: Float32, b: Float32, start: tuple[int, int], limit: float, reach: int) -> tuple[Ints, Ints, Float32]:
    """The minima of the block whose first row and column are ``start``."""
    top, left = max(start[0] - reach, 0), max(start[1] - reach, 0)
    rows, columns = a[top : start[0] + BLOCK + reach], b[left : start[1] + BLOCK + reach]
    table = rows @ columns.T
    table *= np.float32(-2)
    table += np.einsum("ij,ij->i", rows, rows)[:, None]
    table += np.einsum("ij,ij->i", columns, columns)[None, :]
    inner_rows = (start[0] - top, min(start[0] - top + BLOCK, len(rows)))
    inner_columns = (start[1] - left, min(start[1] - left + BLOCK, len(columns)))
    return _minima(table, top, left, inner_rows, inner_columns, limit, reach)


def clip_pairs(
    clips: Sequence[Float32],
    limit: float,
    wanted: Callable[[int, int], bool] = lambda a, b: True,
    reach: int = 2,
    workers: int = 2,
    step: Callable[[float], None] | None = None,
) -> tuple[Ints, Ints, Float32]:
    """Pairs of frames at a local minimum of their distance, each two clips searched for themselves.

    The pairs of two clips depend on nothing but these two: a frame nearer than ``reach`` to an end of its clip, whose
    neighbours are not all known, is in no pair. So pairs that were found once can be kept when other clips change.

    Parameters
    ----------
    clips : for each clip (n, D) pose vectors.
    wanted : tells whether clips a ≤ b are to be searched.
    limit : largest distance (not squared).
    reach : a minimum is the lowest among ``reach`` frames on each side in both directions.
    workers : threads; the result does not depend on it.
    step : called with the share done, 0…1.

    Returns
    -------
    Frames of all clips in a row: the first of each pair, the second, later one, and distances, in order.

    Examples
    --------
    >>> x = np.array([[9.0], [5.0], [1.0]], np.float32)
    >>> y = np.array([[7.0], [4.8], [2.0]], np.float32)
    >>> i, j, d = clip_pairs([x, y], limit=1.0, reach=1)
    >>> i.tolist(), j.tolist(), d.astype(float).round(2).tolist()
    ([1], [4], [0.2])
    """
    starts = np.concatenate(([0], np.cumsum([len(clip) for clip in clips]))).astype(np.int64)
    # matrix products of equal shapes on equal memory layouts give equal bytes
    clips = [np.array(clip, np.float32, order="C") for clip in clips]

    def row(a: int) -> list[_Pairs]:
        found: list[_Pairs] = []
        for b in range(a, len(clips)):
            if wanted(a, b):
                first, second, squared = _two_clips(clips[a], clips[b], limit, reach)
                found.append((first + starts[a], second + starts[b], squared))
        return found

    found: list[_Pairs] = []
    pool = ThreadPoolExecutor(max(workers, 1))
    with threadpool_limits(1, "blas"):
        try:
            for done, pairs in enumerate(pool.map(row, range(len(clips)))):
                found += pairs
                if step is not None:
                    step(1 - ((len(clips) - 1 - done) / len(clips)) ** 2)
        finally:  # a user who stops it does not wait for all that was planned
            pool.shutdown(cancel_futures=True)
    return _ordered(found)


def _two_clips(a: Float32, b: Float32, limit: float, reach: int) -> _Pairs:
    """Minima of the table of two clips away from its rim; of a clip with itself those above the diagonal."""
    starts = [(i, j) for i in range(0, len(a), BLOCK) for j in range(0, len(b), BLOCK) if a is not b or j + BLOCK > i]
    parts = [_block(a, b, start, limit * limit, reach) for start in starts]
    first, second, squared = (np.concatenate(column) for column in zip(*parts, strict=True))
    keep = (first >= reach) & (first < len(a) - reach) & (second >= reach) & (second < len(b) - reach)
    if a is b:
        keep &= first < second
    return first[keep], second[keep], squared[keep]


def _ordered(parts: list[_Pairs]) -> _Pairs:
    """Parts joined in order of first and second frame, squared distances made distances."""
    if not parts:
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0, np.float32)
    first, second, squared = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.lexsort((second, first))
    return first[order], second[order], np.sqrt(np.maximum(squared[order], 0)).astype(np.float32)
