# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""What the next seconds can bring: every path from here to a horizon, by dynamic programming over all frames.

The searches that do not see the whole song (``greedy``, ``shiratori2006``) and the random walk share two things: how
long the dance can go on from each frame, so that they never run into a dead end, and the worth of each first branch
with its best completion up to the horizon.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from onbeat._shapes import Array, Bools, Float32, Ints
from onbeat.dance.optimal import Problem, seam
from onbeat.dance.reach import Reach
from onbeat.dance.too_long import too_long
from onbeat.errors import PlanError

IMPOSSIBLE = -1e30


class Branches(NamedTuple):
    """First branches from a frame: after ``wait`` frames a join to frame ``entry``; an entry of −1 is going on."""

    wait: Ints
    entry: Ints
    value: Array


@dataclass(frozen=True, eq=False)
class Roads:
    """Frames and joins as the look-ahead walks them.

    Parameters
    ----------
    base : (M,) the node of the motion graph that each frame shows.
    left : (M,) frames of the same clip and rate that follow.
    indptr, goal, costs : the joins that leave each node in compressed rows: which goal they lead to, what they cost.
    entries : (R, goals) the frames at which a goal can be entered, or −1.
    seams : what each join does to the stops beside it, as in ``Problem.changes``, and the most it can be worth.
    beats : the worth of a stop at each instant, as in ``Music.beat_worth``.
    hold : frames danced at least after a join.
    frames : frames of the song.
    reach : from where all that is kept can be danced; None where nothing is.
    """

    base: Ints
    left: Ints
    indptr: Ints
    goal: Ints
    costs: Array
    entries: Ints
    seams: tuple[NDArray[np.int32], NDArray[np.int32], Float32, Float32]
    beats: Float32
    hold: int
    frames: int
    reach: Reach | None = None

    @classmethod
    def of(cls, problem: Problem) -> Roads:
        """All frames and joins of a problem."""
        return cls(
            problem.frames.base,
            problem.frames.left,
            problem.graph.indptr,
            problem.goals[1],
            problem.join_costs.astype(np.float64),
            problem.entries.astype(np.int64),
            (*problem.changes, problem.promise),
            problem.music.beat_worth,
            problem.hold,
            problem.music.frames,
            None if problem.kept is None else Reach.of(problem),
        )

    def __len__(self) -> int:
        return len(self.base)

    @cached_property
    def survival(self) -> Ints:
        """(M,) frames that can be danced from each frame on, itself counted; no more than the song has."""
        found = self.left + 1
        _survival(self.frames, self.hold, self.indptr, self.goal, self.base, self.left, self.entries, found)
        if found.max() < self.frames:
            raise PlanError(too_long(int(found.max()), self.frames))
        return found

    def ahead(self, t: int) -> Bools:
        """(hold + 1, M) whether the dance can come to its end from each frame that it is about to show at t, t + 1, …

        The frames from t up to there have been run through in the same clip; past the song's end all is well.
        """
        if self.reach is not None:
            return self.reach.ahead(t)
        return self.survival >= self.frames - t - np.arange(self.hold + 1)[:, None]

    def enterable(self, t: int, goals: Ints) -> Bools:
        """Whether a join at song frame t to each of ``goals`` leaves a way to the song's end."""
        landing = np.minimum(goals + self.hold, len(self) - 1)
        if self.reach is not None:
            return self.reach.ahead(t)[self.hold, landing]
        return self.survival[landing] >= self.frames - t - self.hold

    def free(self, t: int, frame: int) -> int:
        """How many frames from ``frame`` on may be shown at the song frames from t on, the clip's end not looked at."""
        rest = self.frames - t
        return rest if self.reach is None else self.reach.free(t, frame, rest)

    def values(self, t: int, table: Array | Float32, first: int = 0) -> Array:
        """(H + 1, M) best sum of ``table`` less the costs of joins, from each frame on; rows before ``first`` left out.

        ``table`` (H, M) holds what each frame is worth at the song frames from t on. Frames from which the song cannot
        be danced to its end have the value ``IMPOSSIBLE``.
        """
        values = np.full((len(table) + 1, len(self)), IMPOSSIBLE)
        ahead = self.ahead(t + len(table))
        values[-1] = np.where(ahead[0], 0.0, IMPOSSIBLE)
        _values(t, first, table, values, ahead, *self._arrays)
        return values

    def branches(self, t: int, frame: int, table: Array | Float32, values: Array) -> Branches:
        """All first branches from ``frame``, each with its best completion up to the horizon, in order of wait."""
        return Branches(*_branches(t, frame, table, values, self.ahead(t + len(table)), *self._arrays))

    @cached_property
    def _arrays(self) -> tuple[Any, ...]:
        return (
            self.frames, self.hold, self.indptr, self.goal, self.costs, self.base, self.left, self.entries,
            *self.seams, self.beats,
        )  # fmt: skip


@njit(cache=True, boundscheck=False)
def _survival(frames, hold, indptr, goal, base, left, entries, found):
    """Raise ``found`` (M,) until it is the longest dance from each frame, or the whole song."""
    goals, nodes = entries.shape[1], len(indptr) - 1
    best, leap = np.zeros(goals, np.int64), np.zeros(nodes, np.int64)
    for f in range(len(found)):
        found[f] = min(found[f], frames)
    changed = True
    while changed:
        changed = False
        for i in range(goals):
            best[i] = 0
            for r in range(entries.shape[0]):
                if entries[r, i] >= 0:
                    best[i] = max(best[i], hold + found[entries[r, i] + hold])
        for i in range(nodes):
            leap[i] = 0
            for e in range(indptr[i], indptr[i + 1]):
                leap[i] = max(leap[i], best[goal[e]])
        for f in range(len(found) - 1, -1, -1):
            longest = max(found[f], leap[base[f]])
            if left[f] > 0:
                longest = max(longest, found[f + 1] + 1)
            longest = min(longest, frames)
            if longest > found[f]:
                found[f] = longest
                changed = True


@njit(cache=True, boundscheck=False)
def _landing(values, k, g, hold, ahead):
    """Value of what follows a join to g at row k: that of its landing, or 0 if it lands well past the horizon."""
    horizon = len(values) - 1
    if k + hold <= horizon:
        return values[k + hold, g + hold]
    return 0.0 if ahead[k + hold - horizon, g + hold] else IMPOSSIBLE


@njit(cache=True, boundscheck=False)
def _values(
    t, first, table, values, ahead,
    frames, hold, indptr, goal, costs, base, left, entries, seam_ptr, seam_at, seam_sign, promise, beats,
):  # fmt: skip
    horizon, size = table.shape
    rest = frames - t - horizon
    nodes, goals = len(indptr) - 1, entries.shape[1]
    best, leap = np.empty(goals), np.empty(nodes)
    sums = np.zeros(size + 1)
    for k in range(horizon - 1, first - 1, -1):
        for f in range(size):  # sums along the diagonals; those that leave their clip are never asked for
            sums[f] = sums[f + 1] + table[k, f]
        if k + hold < horizon:
            for f in range(size - hold):
                sums[f] -= table[k + hold, f + hold]
        for i in range(goals):
            best[i] = IMPOSSIBLE
            for r in range(entries.shape[0]):
                g = entries[r, i]
                if g >= 0:
                    best[i] = max(best[i], sums[g] + _landing(values, k, g, hold, ahead))
        for i in range(nodes):
            top = IMPOSSIBLE
            for e in range(indptr[i], indptr[i + 1]):
                worth = best[goal[e]] - costs[e]
                if worth + promise[e] > top:  # most joins cannot win whatever their stops are worth
                    top = max(top, worth + seam(t + k, e, seam_ptr, seam_at, seam_sign, beats))
            leap[i] = top
        for f in range(size):
            on = IMPOSSIBLE
            if left[f] > 0:
                on = table[k, f] + values[k + 1, f + 1]
            elif k + 1 == horizon and rest == 0:
                on = table[k, f]
            values[k, f] = max(leap[base[f]], on) if t + k > 0 else on


@njit(cache=True, boundscheck=False)
def _branches(
    t, frame, table, values, ahead,
    frames, hold, indptr, goal, costs, base, left, entries, seam_ptr, seam_at, seam_sign, promise, beats,
):  # fmt: skip
    horizon, rates = len(table), entries.shape[0]
    rest = frames - t - horizon
    last = min(horizon, left[frame] + 1)
    count = 1
    for k in range(last):
        i = base[frame + k]
        count += (indptr[i + 1] - indptr[i]) * rates
    wait, entry, value = np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count)
    count, before = 0, 0.0
    for k in range(last):
        i = base[frame + k]
        for e in range(indptr[i], indptr[i + 1] if t + k > 0 else indptr[i]):  # a dance does not begin with a join
            gain = seam(t + k, e, seam_ptr, seam_at, seam_sign, beats) - costs[e]
            for r in range(rates):
                g = entries[r, goal[e]]
                if g < 0:
                    continue
                worth = before + gain + _landing(values, k, g, hold, ahead)
                for n in range(min(hold, horizon - k)):
                    worth += table[k + n, g + n]
                if worth > 0.5 * IMPOSSIBLE:
                    wait[count], entry[count], value[count] = k, g, worth
                    count += 1
        before += table[k, frame + k]
    whole = left[frame] + 1 >= horizon if rest == 0 else left[frame] >= horizon
    if whole and (rest == 0 or ahead[0, frame + horizon]):
        wait[count], entry[count], value[count] = horizon, -1, before
        count += 1
    return wait[:count], entry[:count], value[:count]
