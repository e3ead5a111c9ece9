"""Cells that may hold a minimum, and a guess of how low it is.

A cell is a candidate if its distance is not much more than wanted, nor than those of the eight cells around it. A
parabola through the nine guesses the lowest distance inside it, and at which frames.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from onbeat._shapes import Float32, Ints
from onbeat.moves.pairs.cells import CELL, Cells
from onbeat.moves.pairs.minima import more

RIM = np.float32(0.5 * (CELL - 1) / CELL)
"""From the middle of a cell to its first frame, in cells."""

Range = tuple[int, int]
Candidates = tuple[Ints, Ints, np.ndarray, Ints]
"""Row and column of each cell, its guess, and the number of the likeliest of its ``CELL``² pairs of frames."""


class Care(NamedTuple):
    """How much is looked into that may be nothing: how far over what is wanted, in squared distance.

    Parameters
    ----------
    above : the distance of a cell at most.
    still, moving : the distance of a cell whose frames lie at most r from its middle: the larger of ``still`` and
        ``moving`` r², which is a factor.
    guess : the guess of the lowest in it.
    neighbours : a cell, over its lowest neighbour.
    probe : the likeliest pair of frames in it.
    """

    above: float
    still: float
    moving: float
    guess: float
    neighbours: float
    probe: float

    def of(self, square: float) -> Care:
        """The same care given as shares of a squared distance, in squared distance."""
        above, still, moving, guess, neighbours, probe = self
        return Care(above * square, still * square, moving, guess * square, neighbours * square, probe * square)


@njit(cache=True, nogil=True)
def candidates(
    table: Float32, one: Cells, two: Cells, rows: Range, columns: Range, unit: float, limit: float, care: Care,
    upper: bool,
) -> Candidates:  # fmt: skip
    """The cells of two clips that may hold a minimum under ``limit``.

    Parameters
    ----------
    table : squared distances of all cells of two groups, in ``unit``.
    rows, columns : the cells of the clips.
    upper : only cells on the diagonal or above it.
    """
    left, width = columns[0], columns[1] - columns[0]
    first, second, spot = np.empty(4096, np.int64), np.empty(4096, np.int64), np.empty(4096, np.int64)
    guess, count = np.empty(4096, np.float64), 0
    tops, marks = np.empty(width, np.float32), np.zeros((width + 7) // 8 * 8, np.uint8)
    eights = marks.view(np.uint64)
    for i in range(rows[0], rows[1]):
        _tops(one.reach[i], two.reach[left : left + width], unit, limit, care, tops)
        mark_low(table, i, rows, columns, tops, np.float32(care.neighbours / unit), marks)
        if count + width > len(first):
            first, second, spot, guess = more(first, width), more(second, width), more(spot, width), more(guess, width)
        for eight in range(len(eights)):
            if eights[eight] != 0:
                for j in range(left + 8 * eight, left + 8 * eight + 8):
                    if marks[j - left] and not (upper and j < i):
                        lowest, inside, x, y = _guess(table, i, j, rows, columns)
                        low = (table[i, j] - lowest) * unit <= care.neighbours
                        if low and inside * unit <= limit + care.guess:
                            first[count], second[count], guess[count] = i, j, inside * unit
                            spot[count] = CELL * int(x * CELL + 0.5 * CELL) + int(y * CELL + 0.5 * CELL)
                            count += 1
    return first[:count], second[:count], guess[:count], spot[:count]


@njit(cache=True, nogil=True)
def _tops(reach: float, others: Float32, unit: float, limit: float, care: Care, tops: Float32) -> None:
    """The most that each cell of a row may be, in the table's unit: more where the body moves fast."""
    low, high = np.float32((limit + care.still) / unit), np.float32((limit + care.above) / unit)
    base, factor = np.float32(limit / unit), np.float32(care.moving / unit)
    for k in range(len(tops)):
        span = reach + others[k]
        tops[k] = min(max(base + factor * span * span, low), high)


@njit(cache=True, nogil=True)
def mark_low(
    table: Float32, i: int, rows: Range, columns: Range, tops: Float32, slack: np.float32, marks: np.ndarray
) -> None:
    """Mark the cells of a row that are low enough, and low among their four neighbours of the same clips."""
    left, right = columns
    width = right - left
    row, up, down = table[i, left:right], table[max(i - 1, rows[0])], table[min(i + 1, rows[1] - 1)]
    if width > 2:
        above, below = up[left + 1 : right - 1], down[left + 1 : right - 1]
        _low(row[1:-1], row[: width - 2], row[2:], above, below, tops[1:-1], slack, marks[1:])
    marks[0], marks[width - 1] = row[0] <= tops[0], row[width - 1] <= tops[width - 1]  # no neighbour on one side


@njit(cache=True, nogil=True, fastmath={"nnan", "nsz"})
def _low(
    here: Float32, left: Float32, right: Float32, up: Float32, down: Float32, tops: Float32, slack: np.float32,
    marks: np.ndarray,
) -> None:  # fmt: skip
    """Comparisons alone, without a branch: the compiler turns the loop into vector instructions."""
    for k in range(len(here)):
        lowest = min(min(left[k], right[k]), min(up[k], down[k]))
        marks[k] = here[k] <= min(lowest + slack, tops[k])


@njit(cache=True, nogil=True)
def _guess(table: Float32, i: int, j: int, rows: Range, columns: Range) -> tuple[float, float, float, float]:
    """The lowest of a cell's neighbours, the lowest of the parabola inside the cell, and where that is, in cells."""
    i0, i1, j0, j1 = max(i - 1, rows[0]), min(i + 1, rows[1] - 1), max(j - 1, columns[0]), min(j + 1, columns[1] - 1)
    c, n, s, w, e = table[i, j], table[i0, j], table[i1, j], table[i, j0], table[i, j1]
    nw, ne, sw, se = table[i0, j0], table[i0, j1], table[i1, j0], table[i1, j1]
    lowest = min(min(min(n, s), min(w, e)), min(min(nw, ne), min(sw, se)))
    gx, gy = 0.5 * (s - n), 0.5 * (e - w)
    hx, hy, hxy = 0.5 * (s - 2 * c + n), 0.5 * (e - 2 * c + w), 0.25 * (se - sw - ne + nw)
    x = _vertex(gx, hx)
    y = _vertex(gy + hxy * x, hy)
    x = _vertex(gx + hxy * y, hx)
    return lowest, c + x * (gx + hx * x + hxy * y) + y * (gy + hy * y), x, y


@njit(cache=True, nogil=True, inline="always")
def _vertex(slope: float, bend: float) -> float:
    """Where a parabola is lowest among the frames of a cell."""
    if 2 * bend * RIM > abs(slope):
        return -0.5 * slope / bend
    return -RIM if slope > 0 else RIM  # pyright: ignore[reportReturnType]
