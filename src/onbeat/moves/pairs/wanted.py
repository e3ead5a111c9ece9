"""How far the wanted minima of two clips reach, told from their cells before any is looked into."""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat._shapes import Float32
from onbeat.moves.pairs.candidates import Range, mark_low

BINS = 128  # steps of squared distance


@njit(cache=True, nogil=True)
def wanted_limit(table: Float32, rows: Range, columns: Range, unit: float, quota: float, limit: float) -> float:
    """A squared distance under which about ``quota`` minima of two clips are; ``limit`` where so few are below it.

    A cell lower than the eight around it holds a minimum, or has one beside it, that is no higher than the cell is.

    Parameters
    ----------
    table : squared distances of all cells of two groups, in ``unit``.
    rows, columns : the cells of the clips.
    """
    if not quota < 0.05 * (rows[1] - rows[0]) * (columns[1] - columns[0]):
        return limit
    found, counts = 0, _counts(table, rows, columns, unit, limit)
    for k in range(BINS):
        found += counts[k]
        if found >= quota:
            return (k + 1) * limit / BINS
    return limit


@njit(cache=True, nogil=True)
def _counts(table: Float32, rows: Range, columns: Range, unit: float, limit: float) -> np.ndarray:
    """How many cells are lower than the eight around them, in steps up to the limit."""
    left, width = columns[0], columns[1] - columns[0]
    counts, step = np.zeros(BINS, np.int64), limit / BINS
    tops, marks = np.full(width, limit / unit, np.float32), np.zeros((width + 7) // 8 * 8, np.uint8)
    eights = marks.view(np.uint64)
    for i in range(rows[0] + 1, rows[1] - 1):
        mark_low(table, i, rows, columns, tops, np.float32(0), marks)
        marks[0] = marks[width - 1] = 0
        for eight in range(len(eights)):
            if eights[eight] != 0:
                for j in range(left + 8 * eight, left + 8 * eight + 8):
                    if marks[j - left]:
                        above = min(table[i - 1, j - 1], table[i - 1, j + 1])
                        if table[i, j] < min(above, min(table[i + 1, j - 1], table[i + 1, j + 1])):
                            counts[min(max(int(table[i, j] * unit / step), 0), BINS - 1)] += 1
    return counts
