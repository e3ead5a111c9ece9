"""Minima from coarse to fine: cells that may hold one are found in the table of cells, and only they are looked into.

Where only the smoothest pairs of two clips are wanted, cells are taken in the order of their guesses, no further than
what is wanted reaches; how far that may be is told first, from the cells alone.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from onbeat._shapes import Float32, Ints
from onbeat.moves.pairs.blocks import Group, Pairs
from onbeat.moves.pairs.candidates import Candidates, Care, Range, candidates
from onbeat.moves.pairs.cells import CELL, Cells, cell_table, cells_of
from onbeat.moves.pairs.inside import FAST, Around, around, minima_inside, rough
from onbeat.moves.pairs.minima import Found, more
from onbeat.moves.pairs.wanted import wanted_limit

# In shares of the limit's square; found on two archives (benchmarks/transitions.py tells what is missed).
COARSE = Care(above=0.45, still=0.1, moving=1.0, guess=0.22, neighbours=1.1, probe=0.16)
APPROXIMATE = Care(above=0.5, still=0.1, moving=1.0, guess=0.18, neighbours=0.7, probe=0.1)
BINS = 64  # steps in which candidates are ordered by their guess


def cell_pairs(a: Group, b: Group, limit: float, care: Care, density: float, near: int) -> Pairs:
    """Local minima of two groups by their cells: of each two clips at least those that ``caps`` keeps."""
    one, two = cells_of(a, near), cells_of(b, near)
    if len(one.start) == 0 or len(two.start) == 0:
        return Pairs.none()
    table, quantum = cell_table(one, two)
    quotas = _quotas(a, b, density)
    square = limit * limit
    first, second, value = _block(
        table, a.poses, b.poses, one, two, quotas, quantum**2, square, care.of(square), around(near), a is b
    )
    return Pairs.joined([Pairs(first, second, np.sqrt(value).astype(np.float32))])


def _quotas(a: Group, b: Group, density: float) -> np.ndarray:
    """How many pairs are wanted of each clip of a and each of b: as ``caps`` keeps."""
    frames = np.diff(a.bounds)[:, None].astype(np.float64) * np.diff(b.bounds)[None, :]
    quotas = np.maximum(np.ceil(np.minimum(density, 1.0) * frames), 1.0)
    if a is b or density >= 1.0:
        quotas[np.eye(len(quotas), dtype=np.bool_) if density < 1.0 else ...] = np.inf
    return quotas


@njit(cache=True, nogil=True)
def _block(
    table: Float32, a: Float32, b: Float32, one: Cells, two: Cells, quotas: np.ndarray, unit: float, limit: float,
    care: Care, wide: Around, same: bool,
) -> Found:  # fmt: skip
    """The minima of all pairs of clips of two groups."""
    first, second, value = np.empty(1024, np.int64), np.empty(1024, np.int64), np.empty(1024, np.float64)
    count = 0
    for k in range(quotas.shape[0]):
        for m in range(k if same else 0, quotas.shape[1]):
            rows, columns = (one.bounds[k], one.bounds[k + 1]), (two.bounds[m], two.bounds[m + 1])
            if rows[1] == rows[0] or columns[1] == columns[0]:
                continue
            upper = same and k == m
            found = _clips(table, a, b, one, two, rows, columns, quotas[k, m], unit, limit, care, wide, upper)
            size = len(found[0])
            if count + size > len(first):
                first, second, value = more(first, size), more(second, size), more(value, size)
            for p in range(size):
                first[count], second[count], value[count] = found[0][p], found[1][p], found[2][p]
                count += 1
    return first[:count], second[:count], value[:count]


@njit(cache=True, nogil=True)
def _clips(
    table: Float32, a: Float32, b: Float32, one: Cells, two: Cells, rows: Range, columns: Range, quota: float,
    unit: float, limit: float, care: Care, wide: Around, upper: bool,
) -> Found:  # fmt: skip
    """The minima of two clips, or the smoothest ``quota`` at least."""
    first = wanted_limit(table, rows, columns, unit, quota, limit)
    picked = candidates(table, one, two, rows, columns, unit, first, care, upper)
    found, enough = _look(a, b, one, two, picked, quota, first, care, wide, upper)
    if first < limit and not enough:
        picked = candidates(table, one, two, rows, columns, unit, limit, care, upper)
        found, _ = _look(a, b, one, two, picked, quota, limit, care, wide, upper)
    return found


@njit(cache=True, nogil=True, fastmath=FAST)
def _look(
    a: Float32, b: Float32, one: Cells, two: Cells, picked: Candidates, quota: float, limit: float, care: Care,
    wide: Around, upper: bool,
) -> tuple[Found, bool]:  # fmt: skip
    """Look into cells, the likeliest first, until the smoothest ``quota`` are among those found; whether they are."""
    order, ends, step = _in_bins(picked[2], limit + care.guess)
    best = np.full(int(min(quota, 2.0 * len(order) + 1)), np.inf)  # more than are there is no bound at all
    first, second, value = np.empty(256, np.int64), np.empty(256, np.int64), np.empty(256, np.float64)
    values, count = np.empty((CELL, CELL), np.float32), 0
    bits = values.reshape(CELL * CELL).view(np.int32)
    for k in range(BINS):
        if k * step > best[-1] + care.guess:
            break
        for place in range(ends[k], ends[k + 1]):
            c = int(order[place])
            last = min(limit, best[-1])
            i, j, spot = int(picked[0][c]), int(picked[1][c]), int(picked[3][c])
            rows, columns = (one.start[i], one.stop[i]), (two.start[j], two.stop[j])
            x, y = min(rows[0] + spot // CELL, rows[1] - 1), min(columns[0] + spot % CELL, columns[1] - 1)
            if picked[2][c] > last + care.guess or rough(a, x, b, y) > last + care.probe:
                continue
            if count + CELL * CELL > len(first):
                first, second, value = more(first, CELL * CELL), more(second, CELL * CELL), more(value, CELL * CELL)
            after = minima_inside(a, b, rows, columns, last, wide, upper, values, bits, first, second, value, count)
            if len(best) <= len(order):
                _insert(best, value, count, after)
            count = after
    return (first[:count], second[:count], value[:count]), best[-1] < np.inf


@njit(cache=True, nogil=True)
def _in_bins(guess: np.ndarray, top: float) -> tuple[Ints, Ints, float]:
    """Numbers of guesses in order of steps up to ``top``, where each step ends, and its size."""
    step = top / (BINS - 1)
    size = len(guess)
    bins, order, ends = np.empty(size, np.int64), np.empty(size, np.int64), np.zeros(BINS + 1, np.int64)
    for c in range(size):
        bins[c] = min(max(int(guess[c] / step), 0), BINS - 1)
        ends[bins[c] + 1] += 1
    ends = np.cumsum(ends)
    place = ends[:-1].copy()
    for c in range(size):
        order[place[bins[c]]] = c
        place[bins[c]] += 1
    return order, ends, step


@njit(cache=True, nogil=True)
def _insert(best: np.ndarray, value: np.ndarray, begin: int, end: int) -> None:
    """Put values in their places among the lowest."""
    for p in range(begin, end):
        k = len(best) - 1
        if value[p] < best[k]:
            while k > 0 and best[k - 1] > value[p]:
                best[k] = best[k - 1]
                k -= 1
            best[k] = value[p]
