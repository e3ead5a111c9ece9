"""Minima inside a cell: the frames of two cells compared with one another and with those around them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from onbeat._shapes import Float32, Ints
from onbeat.moves.pairs.cells import CELL
from onbeat.moves.pairs.minima import is_before, squared

ROUGH = 1e-4
"""Share by which :func:`rough` errs at most: a sum of D positive terms errs by D roundings of itself, D up to 800."""
FAST = {"reassoc", "contract", "nsz"}
"""Sums in whatever order is fastest, in those who inline them, too; infinite numbers stay what they are."""
Range = tuple[int, int]
Ints32 = NDArray[np.int32]


@njit(cache=True, nogil=True, fastmath=FAST, inline="always")
def rough(a: Float32, i: int, b: Float32, j: int) -> np.float32:
    """Squared distance of two rows in float32, in whatever order is fastest."""
    total = np.float32(0)
    for k in range(a.shape[1]):
        d = a[i, k] - b[j, k]
        total += d * d
    return total


@njit(cache=True, nogil=True, fastmath=FAST, inline="always")
def _sixteen(a: Float32, i: int, b: Float32, j: int, values: Float32) -> None:
    """As :func:`rough`, of four rows of a and four of b: each is read once, and sixteen sums stay in registers."""
    p0 = p1 = p2 = p3 = q0 = q1 = q2 = q3 = np.float32(0)
    r0 = r1 = r2 = r3 = s0 = s1 = s2 = s3 = np.float32(0)
    for k in range(a.shape[1]):
        w, x, y, z = b[j, k], b[j + 1, k], b[j + 2, k], b[j + 3, k]
        c, d, e, f = a[i, k], a[i + 1, k], a[i + 2, k], a[i + 3, k]
        p0, p1, p2, p3 = p0 + (c - w) ** 2, p1 + (c - x) ** 2, p2 + (c - y) ** 2, p3 + (c - z) ** 2
        q0, q1, q2, q3 = q0 + (d - w) ** 2, q1 + (d - x) ** 2, q2 + (d - y) ** 2, q3 + (d - z) ** 2
        r0, r1, r2, r3 = r0 + (e - w) ** 2, r1 + (e - x) ** 2, r2 + (e - y) ** 2, r3 + (e - z) ** 2
        s0, s1, s2, s3 = s0 + (f - w) ** 2, s1 + (f - x) ** 2, s2 + (f - y) ** 2, s3 + (f - z) ** 2
    values[0, 0], values[0, 1], values[0, 2], values[0, 3] = p0, p1, p2, p3
    values[1, 0], values[1, 1], values[1, 2], values[1, 3] = q0, q1, q2, q3
    values[2, 0], values[2, 1], values[2, 2], values[2, 3] = r0, r1, r2, r3
    values[3, 0], values[3, 1], values[3, 2], values[3, 3] = s0, s1, s2, s3


@njit(cache=True, nogil=True, inline="always")
def _fill(a: Float32, b: Float32, rows: Range, columns: Range, values: Float32) -> None:
    """The table of the frames of two cells, about."""
    if rows[1] - rows[0] == CELL and columns[1] - columns[0] == CELL:
        _sixteen(a, rows[0], b, columns[0], values)
    else:
        values[...] = np.inf  # no frames there
        for x in range(rows[1] - rows[0]):
            for y in range(columns[1] - columns[0]):
                values[x, y] = rough(a, rows[0] + x, b, columns[0] + y)


@njit(cache=True, nogil=True, inline="always")
def minima_inside(
    a: Float32, b: Float32, rows: Range, columns: Range, limit: float, wide: Around, upper: bool,
    table: Float32, bits: Ints32, first: Ints, second: Ints, value: np.ndarray, count: int,
) -> int:  # fmt: skip
    """Write the minima among the frames of two cells, and their exact squared distances, from place ``count`` on.

    Parameters
    ----------
    a, b : pose vectors.
    rows, columns : frames of the cells.
    limit, upper : as of :func:`onbeat.moves.pairs.minima.table_minima`.
    wide : the entries among which a minimum is the lowest.
    table, bits : (CELL, CELL) room for the table of the frames, and the same room seen as (CELL²,) int32.
    first, second, value : where to write.

    Returns
    -------
    The place after the last.
    """
    _fill(a, b, rows, columns, table)
    top = np.float32(limit * (1 + ROUGH))
    place = _lowest(bits)
    u, v = place // CELL, place % CELL
    if table[u, v] > top:
        return count
    whole = rows[1] - rows[0] == CELL and columns[1] - columns[0] == CELL
    if wide.near < 2 or not _stands_alone(table, u, v):
        return _several(a, b, rows, columns, limit, wide, upper, table, whole, first, second, value, count)
    i, j = rows[0] + u, columns[0] + v
    exact = _settled(a, b, i, j, table, place, whole, limit, wide) if not upper or i < j else -1.0
    if exact >= 0:
        first[count], second[count], value[count] = i, j, exact
        count += 1
    return count


@njit(cache=True, nogil=True, fastmath=FAST)
def _several(
    a: Float32, b: Float32, rows: Range, columns: Range, limit: float, wide: Around, upper: bool, table: Float32,
    whole: bool, first: Ints, second: Ints, value: np.ndarray, count: int,
) -> int:  # fmt: skip
    """As :func:`minima_inside`, of a table that is there, where it may hold several."""
    for x in range(CELL):
        for y in range(CELL):
            i, j = rows[0] + x, columns[0] + y
            if table[x, y] > limit * (1 + ROUGH) or (upper and i >= j) or not _lowest_inside(table, x, y, wide.steps):
                continue
            exact = _settled(a, b, i, j, table, CELL * x + y, whole, limit, wide)
            if exact >= 0:
                first[count], second[count], value[count] = i, j, exact
                count += 1
    return count


@njit(cache=True, nogil=True, inline="always")
def _lowest(bits: Ints32) -> int:
    """Which of the entries of a cell, row by row, is the lowest, to a millionth.

    Numbers from zero are ordered as their bits are. The last four bits make room for the place, so that the least of
    all is found without a branch.
    """
    least = np.int32(2**31 - 1)
    for k in range(CELL * CELL):
        least = min(least, (bits[k] & np.int32(-16)) | np.int32(k))
    return int(least & np.int32(15))


@njit(cache=True, nogil=True, inline="always")
def _stands_alone(table: Float32, u: int, v: int) -> bool:
    """Whether no entry but the lowest can be a minimum among two on each side, as is nearly always so.

    Those near it are higher, unless they equal it; those three away must be lower than what is between.
    """
    equal, slack, sharp = 0, table[u, v] * np.float32(1 + 3 * ROUGH), np.float32(1 - ROUGH)
    for x in range(4):
        for y in range(4):
            equal += table[x, y] <= slack
    low = 0
    if u in (0, 3):
        far, near = (3, 2) if u == 0 else (0, 1)
        for y in range(4):
            lowest = min(min(table[near, max(y - 1, 0)], table[near, y]), table[near, min(y + 1, 3)])
            low += table[far, y] * sharp <= lowest
    if v in (0, 3):
        far, near = (3, 2) if v == 0 else (0, 1)
        for x in range(4):
            lowest = min(min(table[max(x - 1, 0), near], table[x, near]), table[min(x + 1, 3), near])
            low += table[x, far] * sharp <= lowest
    return equal == 1 and low == 0


class Around(NamedTuple):
    """The entries among which a minimum is the lowest, as steps from it, the likeliest to be lower first.

    Where two clips move alike, the table has valleys along its diagonals.

    Parameters
    ----------
    near : how far to each side.
    steps : (K, 2) all of them.
    outside : (CELL² + 1, K, 2) for each place in a whole cell those that lead out of it; the last row: all, for others.
    many : (CELL² + 1,) how many these are.
    """

    near: int
    steps: Ints
    outside: Ints
    many: Ints


def around(near: int) -> Around:
    """All entries up to ``near`` away in both directions."""
    steps = [(i, j) for i in range(-near, near + 1) for j in range(-near, near + 1) if (i, j) != (0, 0)]
    steps.sort(key=lambda step: (max(map(abs, step)), abs(step[0] - step[1])))
    outside, count = np.zeros((CELL * CELL + 1, len(steps), 2), np.int64), np.zeros(CELL * CELL + 1, np.int64)
    for place in range(CELL * CELL + 1):
        x, y = divmod(place, CELL)
        out = [(i, j) for i, j in steps if x == CELL or not (0 <= x + i < CELL and 0 <= y + j < CELL)]
        outside[place, : len(out)], count[place] = np.reshape(out, (-1, 2)), len(out)
    return Around(near, np.reshape(np.array(steps, np.int64), (-1, 2)), outside, count)


@njit(cache=True, nogil=True, inline="always")
def _lowest_inside(table: Float32, x: int, y: int, steps: Ints) -> bool:
    """Whether a value may be the lowest of its neighbours in the same cell."""
    least = table[x, y] * np.float32(1 - ROUGH)
    for k in range(len(steps)):
        p, q = x + steps[k, 0], y + steps[k, 1]
        if 0 <= p < CELL and 0 <= q < CELL and table[p, q] < least:
            return False
    return True


@njit(cache=True, nogil=True, inline="always")
def _settled(
    a: Float32, b: Float32, i: int, j: int, table: Float32, place: int, whole: bool, limit: float, wide: Around
) -> float:
    """The exact squared distance of two frames if it is a minimum under the limit, else -1.

    It is known to be the lowest of its cell, about: so those outside tell.
    """
    here = table[place // CELL, place % CELL]
    low, high = np.float32(here * (1 - ROUGH)), np.float32(here * (1 + ROUGH))
    close = False
    row = place if whole else CELL * CELL
    for k in range(wide.many[row]):
        other = rough(a, i + wide.outside[row, k, 0], b, j + wide.outside[row, k, 1])
        if other < low:
            return -1.0
        close = close or other <= high
    value = squared(a, i, b, j)
    if value >= limit or ((close or _equals(table, high)) and not _first(a, b, i, j, value, wide.steps)):
        return -1.0
    return value


@njit(cache=True, nogil=True)
def _equals(table: Float32, high: np.float32) -> bool:
    """Whether more than one entry is as low as this."""
    count = 0
    for x in range(CELL):
        for y in range(CELL):
            count += table[x, y] <= high
    return count > 1


@njit(cache=True, nogil=True)
def _first(a: Float32, b: Float32, i: int, j: int, value: float, steps: Ints) -> bool:
    """Whether no neighbour is lower, nor an earlier one equal, by exact sums."""
    for k in range(len(steps)):
        di, dj = steps[k, 0], steps[k, 1]
        if is_before(a, i + di, b, j + dj, value, di, dj):
            return False
    return True
