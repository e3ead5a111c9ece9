"""Cells: a few frames of a clip seen as one pose, and the table of cells by sums that are exact.

Neighbouring frames are near each other. So a table with one row for each ``CELL`` frames, a sixteenth of the whole one,
tells where minima may be.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Float32, Ints
from onbeat.moves.pairs.blocks import Group

CELL = 4  # frames: at 30 a second the body moves by some 0.2 of the poses' unit in this time, less than joins are wide
QUANTUM = 2.0**-9
"""Distance to which the poses of cells are rounded at least: a small part of what joins may be apart."""


class Cells(NamedTuple):
    """Cells of a group, those of each clip in a row.

    Parameters
    ----------
    poses : (m, D) float32, the middle of each cell.
    start, stop : (m,) its frames.
    reach : (m,) float32 largest distance of a frame of the cell from its middle.
    bounds : (clips + 1,) the first cell of each clip, and the number of cells.
    quantum : distance that whole poses count as one; 2⁻ᵏ.
    whole : (m, D + 2) float32, poses in whole quanta, their squares' sum, and one.
    """

    poses: Float32
    start: Ints
    stop: Ints
    reach: Float32
    bounds: Ints
    quantum: float
    whole: Float32


@lru_cache(maxsize=32)  # a task goes from one group to the next; 30 MB, as many as an hour has
def cells_of(group: Group, near: int) -> Cells:
    """The cells of all frames that have ``near`` frames of their clip on each side."""
    first, last = group.bounds[:-1] + near, np.maximum(group.bounds[1:] - near, group.bounds[:-1] + near)
    starts = [np.arange(f, e, CELL) for f, e in zip(first.tolist(), last.tolist(), strict=True)]
    counts = np.array([len(s) for s in starts], np.int64)
    start = np.concatenate([np.zeros(0, np.int64), *starts])
    stop = np.minimum(start + CELL, np.repeat(last, counts))
    poses = (group.poses[(start + stop - 1) // 2] + group.poses[(start + stop) // 2]) * np.float32(0.5)
    bounds = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    quantum = _quantum(poses)
    return Cells(poses, start, stop, _reach(group.poses, poses, start, stop), bounds, quantum, _whole(poses, quantum))


def cell_table(one: Cells, two: Cells) -> tuple[Float32, float]:
    """Squared distances of all cells of two groups in squares of a quantum, and the quantum.

    Poses are rounded to whole quanta, few enough that float32 adds their products without rounding: so the table is the
    same for every order of summation.
    """
    quantum = max(one.quantum, two.quantum)
    left, right = (c.whole if c.quantum == quantum else _whole(c.poses, quantum) for c in (one, two))
    right = np.column_stack((-2 * right[:, :-2], right[:, -1], right[:, -2]))
    return left @ right.T, quantum


def _quantum(poses: Float32) -> float:
    """The least power of two for which ``(|a| + |b|)²``, the most that a sum can reach on its way, is below 2²⁴."""
    largest = math.sqrt(float(_squares(poses).max(initial=0.0))) + 1e-12
    return max(2.0 ** math.ceil(math.log2(largest * 1.02 / 2**11)), QUANTUM)


def _whole(poses: Float32, quantum: float) -> Float32:
    whole = np.rint(poses * np.float32(1 / quantum))
    squares = _squares(whole).astype(np.float32)
    return np.column_stack((whole, squares, np.ones_like(squares)))


def _reach(frames: Float32, poses: Float32, start: Ints, stop: Ints) -> Float32:
    """The largest distance of a frame of each cell from its middle: from one of its ends, nearly always."""
    ends = [frames[start], frames[stop - 1]] if len(start) else [poses, poses]
    return np.sqrt(np.maximum(*(_squares(end - poses) for end in ends))).astype(np.float32)


def _squares(rows: Float32) -> np.ndarray:
    return np.einsum("ij,ij->i", rows, rows, dtype=np.float64)
