# The compiled loop takes plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""Frames and joins of a library, as one walks them who never comes to an end.

Joins that lead to a dead end, be it minutes later, are left out; of very many the smoothest are kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray

from onbeat._shapes import Bools, Float32, Ints
from onbeat.dance.optimal import Problem
from onbeat.dance.score import FINE
from onbeat.errors import PlanError

PAD = 15
"""Frames before and after a join in which it can change stops: 0.5 s."""
MOST_JOINS = 100_000
"""Joins looked at; of a library that has more the smoothest from each frame are kept."""


@dataclass(frozen=True, eq=False)
class Ground:
    """Frames and joins of a library, as they are walked for ever.

    Parameters
    ----------
    left : (N,) frames of the same clip that follow.
    stops, stop_worth, stop_shift : frames with a stop, and as in ``score.Frames``.
    indptr, targets, costs : joins in compressed rows, those of a frame from the cheapest on.
    seam_ptr, seam_at, seam_sign : stops made and unmade by each join, as in ``seams.Seams``.
    hold : m.
    lasting : (N,) true where the dance can go on for ever.
    """

    left: Ints
    stops: NDArray[np.int32]
    stop_worth: Float32
    stop_shift: NDArray[np.int32]
    indptr: NDArray[np.int32]
    targets: NDArray[np.int32]
    costs: Float32
    seam_ptr: NDArray[np.int32]
    seam_at: NDArray[np.int32]
    seam_sign: Float32
    hold: int
    lasting: Bools

    @classmethod
    def of(cls, problem: Problem, most_joins: int = MOST_JOINS) -> Ground:
        """Frames and joins of a problem at playback rate 1 (its music is not used).

        Raises
        ------
        PlanError
            If no dance over the joins goes on for ever.
        """
        graph, laid = problem.graph, problem.frames
        lasting = laid.left >= 0
        _thin_out(graph.indptr, graph.targets, laid.left, problem.hold, lasting)
        if not lasting.any():
            raise PlanError("the joins of this library lead to dead ends only: its clips have too few poses in common")
        landing = np.minimum(graph.targets + problem.hold, len(laid) - 1)
        good = (laid.left[graph.targets] >= problem.hold) & lasting[landing]
        kept = _smoothest(graph.sources, problem.join_costs, good, most_joins)
        many = np.bincount(graph.sources[kept], minlength=len(laid))
        seam_ptr, at, sign = problem.changes
        near = np.abs(at) < PAD * FINE
        changes = np.diff(seam_ptr)[kept]
        which = (
            np.repeat(seam_ptr[:-1][kept], changes) + np.arange(changes.sum()) - np.repeat(_before(changes), changes)
        )
        return cls(
            laid.left,
            np.flatnonzero(laid.stop_worth > 0).astype(np.int32),
            laid.stop_worth,
            laid.stop_shift.astype(np.int32),
            np.append(0, np.cumsum(many)).astype(np.int32),
            graph.targets[kept].astype(np.int32),
            problem.join_costs[kept],
            np.append(_before(changes), changes.sum()).astype(np.int32),
            np.clip(at[which], 1 - PAD * FINE, PAD * FINE - 1),
            np.where(near[which], sign[which], 0).astype(np.float32),
            problem.hold,
            lasting,
        )

    def __len__(self) -> int:
        return len(self.left)

    @cached_property
    def goals(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """The frames that joins lead to, and the place of each join's target among them."""
        goals, place = np.unique(self.targets, return_inverse=True)
        return goals.astype(np.int32), place.astype(np.int32)


def _before(many: Ints) -> Ints:
    return np.cumsum(many) - many


def _smoothest(sources: Ints, costs: Float32, good: Bools, most: int) -> Ints:
    """Good joins by frame and cost, and no more from each frame than that all together are ``most`` at most."""
    order = np.lexsort((costs, sources))
    order = order[good[order]]
    row = sources[order]
    rank = np.arange(len(row)) - np.searchsorted(row, row)
    fan = int(np.searchsorted(np.cumsum(np.bincount(rank)), most, side="right"))
    return order[rank < max(fan, 1)]


@njit(cache=True, nogil=True)
def _thin_out(indptr, targets, left, hold, lasting):
    """Take from ``lasting`` the frames from which every way ends; the rest is the greatest set that needs no other."""
    changed = True
    while changed:
        changed = False
        for f in range(len(left) - 1, -1, -1):
            if not lasting[f] or (left[f] > 0 and lasting[f + 1]):
                continue
            way = False
            for e in range(indptr[f], indptr[f + 1]):
                g = targets[e]
                if left[g] >= hold and lasting[g + hold]:
                    way = True
                    break
            if not way:
                lasting[f] = False
                changed = True
