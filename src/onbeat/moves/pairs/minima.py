"""Local minima of a table of squared distances, each settled by one sum that is the same on every machine.

The table comes from a matrix product, whose rounding depends on the machine and on the shape. So it only tells which
entries may be minima, within a bound of that rounding; what is too close to call is decided by :func:`squared`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat._shapes import Bools, Float32, Ints

Found = tuple[Ints, Ints, np.ndarray]


@njit(cache=True, nogil=True)
def squared(a: Float32, i: int, b: Float32, j: int) -> float:
    """Squared distance of two rows in float64, summed in a fixed order (eight sums side by side)."""
    width = a.shape[1]
    size = width - width % 8
    s0 = s1 = s2 = s3 = s4 = s5 = s6 = s7 = 0.0
    for k in range(0, size, 8):
        d0, d1 = np.float64(a[i, k]) - np.float64(b[j, k]), np.float64(a[i, k + 1]) - np.float64(b[j, k + 1])
        d2, d3 = np.float64(a[i, k + 2]) - np.float64(b[j, k + 2]), np.float64(a[i, k + 3]) - np.float64(b[j, k + 3])
        d4, d5 = np.float64(a[i, k + 4]) - np.float64(b[j, k + 4]), np.float64(a[i, k + 5]) - np.float64(b[j, k + 5])
        d6, d7 = np.float64(a[i, k + 6]) - np.float64(b[j, k + 6]), np.float64(a[i, k + 7]) - np.float64(b[j, k + 7])
        s0, s1, s2, s3 = s0 + d0 * d0, s1 + d1 * d1, s2 + d2 * d2, s3 + d3 * d3
        s4, s5, s6, s7 = s4 + d4 * d4, s5 + d5 * d5, s6 + d6 * d6, s7 + d7 * d7
    for k in range(size, width):
        d = np.float64(a[i, k]) - np.float64(b[j, k])
        s0 += d * d
    return ((s0 + s1) + (s2 + s3)) + ((s4 + s5) + (s6 + s7))


@njit(cache=True, nogil=True, fastmath={"nnan", "nsz"})
def low_marks(
    here: Float32, left: Float32, right: Float32, up: Float32, down: Float32, top: np.float32, slack: np.float32,
    marks: np.ndarray,
) -> None:  # fmt: skip
    """Mark entries of a row under ``top`` and no more than ``slack`` above their four neighbours.

    Comparisons alone, without a branch: the compiler turns the loop into vector instructions.
    """
    for k in range(len(here)):
        lowest = min(min(left[k], right[k]), min(up[k], down[k]))
        marks[k] = here[k] <= min(lowest + slack, top)


@njit(cache=True, nogil=True)
def table_minima(
    table: Float32, a: Float32, b: Float32, rows: tuple[int, Bools], columns: tuple[int, Bools],
    limits: tuple[float, float], near: int, upper: bool,
) -> Found:  # fmt: skip
    """Minima of a table whose entries are right within a bound.

    Parameters
    ----------
    table : squared distances.
    a, b : pose vectors.
    rows, columns : frame of the first row (column), and which of them may hold a minimum; their neighbours are there.
    limits : largest squared distance, and the bound of the table's rounding.
    near : a minimum is the lowest among so many entries on each side.
    upper : only entries whose frame of a comes before that of b.
    """
    slack = np.float32(2 * limits[1])
    marked = _marked(table, rows[1], columns[1], np.float32(limits[0] + slack), slack)
    first, second = np.empty(len(marked), np.int64), np.empty(len(marked), np.int64)
    value = np.empty(len(marked), np.float64)
    count = 0
    for mark in marked:
        i, j = mark // table.shape[1], mark % table.shape[1]
        x, y = rows[0] + i, columns[0] + j
        if upper and x >= y:
            continue
        squares = _settled(table, i, j, a, x, b, y, limits[0], slack, near)
        if squares >= 0:
            first[count], second[count], value[count] = x, y, squares
            count += 1
    return first[:count], second[:count], value[:count]


@njit(cache=True, nogil=True)
def _marked(table: Float32, rows: Bools, columns: Bools, top: np.float32, slack: np.float32) -> Ints:
    """Entries, counted row by row, that are under ``top`` and no more than ``slack`` above their four neighbours."""
    height, width = table.shape
    found, count = np.empty(1024, np.int64), 0
    marks = np.zeros((width + 7) // 8 * 8, np.uint8)
    eights = marks.view(np.uint64)
    for i in range(1, height - 1):
        if not rows[i]:
            continue
        row, sides = table[i, 1:-1], (table[i, : width - 2], table[i, 2:])
        low_marks(row, sides[0], sides[1], table[i - 1, 1:-1], table[i + 1, 1:-1], top, slack, marks)
        if count + width > len(found):
            found = more(found, width)
        for eight in range(len(eights)):
            if eights[eight] != 0:
                for j in range(8 * eight, 8 * eight + 8):
                    if marks[j] and columns[j + 1]:
                        found[count] = i * width + j + 1
                        count += 1
    return found[:count]


@njit(cache=True, nogil=True)
def _settled(
    table: Float32, i: int, j: int, a: Float32, x: int, b: Float32, y: int, limit: float, slack: np.float32, near: int
) -> float:
    """The exact squared distance of frames x and y at a place of the table if it is a minimum under the limit, else -1.

    Of equal neighbours the earlier one counts, so that a plateau gives one minimum.
    """
    low, high = table[i, j] - slack, table[i, j] + slack
    close = -1
    for di in range(-near, near + 1):
        for dj in range(-near, near + 1):
            other = table[i + di, j + dj]
            if other < low:
                return -1.0
            close += other <= high
    value = squared(a, x, b, y)
    if value >= limit:
        return -1.0
    if close > 0:
        for di in range(-near, near + 1):
            for dj in range(-near, near + 1):
                if table[i + di, j + dj] <= high and is_before(a, x + di, b, y + dj, value, di, dj):
                    return -1.0
    return value


@njit(cache=True, nogil=True)
def is_before(a: Float32, i: int, b: Float32, j: int, value: float, di: int, dj: int) -> bool:
    """Whether a neighbour at di, dj is lower than ``value``, or equal and earlier, by exact sums."""
    if di == 0 and dj == 0:
        return False
    other = squared(a, i, b, j)
    return other < value or (other == value and (di < 0 or (di == 0 and dj < 0)))


@njit(cache=True, nogil=True)
def more(values: Ints, room: int) -> Ints:
    """The same values with room for twice as many, and ``room`` besides."""
    wider = np.empty(2 * len(values) + room, values.dtype)
    for k in range(len(values)):
        wider[k] = values[k]
    return wider
