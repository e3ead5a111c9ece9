"""Minima inside a cell: the frames of two cells compared with one another and with those around them."""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat._shapes import Float32, Ints
from onbeat.moves.minima import is_before, squared

ROUGH = 1e-4
"""Share by which :func:`rough` errs at most: a sum of D positive terms errs by D roundings of itself, D up to 800."""
Range = tuple[int, int]


@njit(cache=True, nogil=True, fastmath=True)
def rough(a: Float32, i: int, b: Float32, j: int) -> np.float32:
    """Squared distance of two rows in float32, in whatever order is fastest."""
    total = np.float32(0)
    for k in range(a.shape[1]):
        d = a[i, k] - b[j, k]
        total += d * d
    return total


@njit(cache=True, nogil=True, fastmath=True)
def _four(a: Float32, i: int, b: Float32, j: int) -> tuple[np.float32, np.float32, np.float32, np.float32]:
    """As :func:`rough`, of four rows of b: a's is read once."""
    t0 = t1 = t2 = t3 = np.float32(0)
    for k in range(a.shape[1]):
        here = a[i, k]
        d0, d1, d2, d3 = here - b[j, k], here - b[j + 1, k], here - b[j + 2, k], here - b[j + 3, k]
        t0, t1, t2, t3 = t0 + d0 * d0, t1 + d1 * d1, t2 + d2 * d2, t3 + d3 * d3
    return t0, t1, t2, t3


@njit(cache=True, nogil=True)
def _fill(a: Float32, b: Float32, rows: Range, columns: Range, values: Float32) -> None:
    """The table of the frames of two cells, about."""
    if columns[1] - columns[0] == 4:
        for x in range(rows[1] - rows[0]):
            values[x, 0], values[x, 1], values[x, 2], values[x, 3] = _four(a, rows[0] + x, b, columns[0])
    else:
        for x in range(rows[1] - rows[0]):
            for y in range(columns[1] - columns[0]):
                values[x, y] = rough(a, rows[0] + x, b, columns[0] + y)


@njit(cache=True, nogil=True)
def minima_inside(
    a: Float32, b: Float32, rows: Range, columns: Range, limit: float, near: int, upper: bool, values: Float32,
    first: Ints, second: Ints, value: np.ndarray,
) -> int:  # fmt: skip
    """Write the minima among the frames of two cells, and their exact squared distances; how many there are.

    Parameters
    ----------
    a, b : pose vectors.
    rows, columns : frames of the cells.
    limit, near, upper : as of :func:`onbeat.moves.minima.table_minima`.
    values : room for the table of the frames.
    first, second, value : where to write.
    """
    _fill(a, b, rows, columns, values)
    height, width = rows[1] - rows[0], columns[1] - columns[0]
    top, count = np.float32(limit * (1 + ROUGH)), 0
    for x in range(height):
        for y in range(width):
            i, j = rows[0] + x, columns[0] + y
            if values[x, y] > top or (upper and i >= j) or not _lowest_inside(values, x, y, height, width, near):
                continue
            exact = _settled(a, b, i, j, values[x, y], limit, near)
            if exact >= 0:
                first[count], second[count], value[count] = i, j, exact
                count += 1
    return count


@njit(cache=True, nogil=True)
def _lowest_inside(values: Float32, x: int, y: int, height: int, width: int, near: int) -> bool:
    """Whether a value may be the lowest of its neighbours in the same cell."""
    least = values[x, y] * np.float32(1 - ROUGH)
    for p in range(max(x - near, 0), min(x + near + 1, height)):
        for q in range(max(y - near, 0), min(y + near + 1, width)):
            if values[p, q] < least:
                return False
    return True


@njit(cache=True, nogil=True)
def _settled(a: Float32, b: Float32, i: int, j: int, here: float, limit: float, near: int) -> float:
    """The exact squared distance of two frames if it is a minimum under the limit, else -1; the nearest tell first."""
    low, high = np.float32(here * (1 - ROUGH)), np.float32(here * (1 + ROUGH))
    close = False
    for ring in range(1, near + 1):
        for di in range(-ring, ring + 1):
            for dj in range(-ring, ring + 1):
                if max(abs(di), abs(dj)) == ring:
                    other = rough(a, i + di, b, j + dj)
                    if other < low:
                        return -1.0
                    close = close or other <= high
    value = squared(a, i, b, j)
    if value >= limit or (close and not _first(a, b, i, j, value, near)):
        return -1.0
    return value


@njit(cache=True, nogil=True)
def _first(a: Float32, b: Float32, i: int, j: int, value: float, near: int) -> bool:
    """Whether no neighbour is lower, nor an earlier one equal, by exact sums."""
    for di in range(-near, near + 1):
        for dj in range(-near, near + 1):
            if is_before(a, i + di, b, j + dj, value, di, dj):
                return False
    return True
