# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""The value to go over the next seconds, lean enough to be found anew every two of them.

It is the one of :mod:`onbeat.dance.optimal`, at playback rate 1 and with an intensity that stays as it is. What a frame
f is worth is then a part b(f) that does not depend on when it is shown, and a stop's worth where there is one. With
P(f) the sum of b before f in its clip, the value V(t, f) + P(f) does not change from (t, f) to (t + 1, f + 1), but for
stops. Kept along those diagonals d = f − t, a row costs its stops and its joins, and nothing for frames that go on:

    X(t, d) = max( X(t+1, d) + s(t, f),  P(f) + max over joins f → g of  W(t, g) − P(g) − c )
    W(t, g) = Σ_{k<m} s(t+k, g+k) + X(t+m, g−t)

with s the worth of a stop, m the frames danced at least after a join. Joins that lead to a dead end, be it after the
horizon, are left out, so that what is found can always go on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from onbeat._shapes import Array, Float32, Ints
from onbeat.dance.optimal import NEVER
from onbeat.dance.score import FINE
from onbeat.live.choice.ground import PAD, Ground


class Steps(NamedTuple):
    """A way through the library: at frames ``times`` from now, joins ``joins`` to frames ``entries``; its worth."""

    times: Ints
    joins: Ints
    entries: Ints
    worth: float


@njit(cache=True, nogil=True, boundscheck=False, inline="always")
def _changed(t, e, seam_ptr, seam_at, seam_sign, beats):
    """What the stops that join e makes and unmakes are worth when it is taken at frame t."""
    value = np.float32(0)
    for k in range(seam_ptr[e], seam_ptr[e + 1]):
        value += seam_sign[k] * beats[(t + PAD) * FINE + seam_at[k]]
    return value


@njit(cache=True, nogil=True, boundscheck=False)
def _fill(
    first, total, near, every, hold, rows, before, beats, lasting, ends, stops, worth, shift,
    indptr, place, costs, least, goals, seam_ptr, seam_at, seam_sign,
):  # fmt: skip
    """Fill ``rows`` (total + 1, N + total) with X(t, d) at column d + total, for t = total … first."""
    size = len(before)
    sums = np.zeros(size + total, np.float32)
    best = np.empty(len(goals), np.float32)
    for f in range(size):
        rows[total, f] = before[f] if lasting[f] else NEVER
    rows[total, size:] = NEVER
    for t in range(total - 1, first - 1, -1):
        here = rows[t]
        here[:] = rows[t + 1]
        to = total - t
        for f in ends:
            here[f + to] = NEVER
        gone, moment = to - hold, (t + PAD) * FINE
        for s in stops:
            value = worth[s] * beats[moment + shift[s]]
            here[s + to] += value
            sums[s + to] += value
            if gone > 0:
                sums[s + gone] -= worth[s] * beats[moment + hold * FINE + shift[s]]
        if t > near and t % every:
            continue
        for i in range(len(goals)):
            d = goals[i] + to
            best[i] = sums[d] - before[goals[i]] + (rows[t + hold, d] if gone >= 0 else before[d])
        for f in range(size):
            top = here[f + to] - before[f]
            for e in range(indptr[f], indptr[f + 1]):
                value = best[place[e]]
                if value - least[e] > top:  # most joins cannot win whatever their stops are worth
                    top = max(top, value - costs[e] + _changed(t, e, seam_ptr, seam_at, seam_sign, beats))
            here[f + to] = top + before[f]


@njit(cache=True, nogil=True, boundscheck=False)
def _landed(t, g, total, hold, rows, before, beats, worth, shift):
    """W(t, g) − P(g): what a join to g at frame t is worth, and all that may follow."""
    value = np.float64(0)
    for k in range(min(hold, total - t)):
        if worth[g + k] > 0:
            value += worth[g + k] * beats[(t + k + PAD) * FINE + shift[g + k]]
    d = g + total - t
    return value - before[g] + (rows[t + hold, d] if t + hold <= total else before[d])


@njit(cache=True, nogil=True, boundscheck=False)
def _walk(
    frame, wait, total, hold, rows, before, beats, lasting, left, worth, shift,
    indptr, targets, costs, seam_ptr, seam_at, seam_sign, times, joins,
):  # fmt: skip
    """The best way from ``frame`` on, its first join not before ``wait``: how many joins, and what all is worth."""
    t, f, count, outcome = 0, frame, 0, np.float64(NEVER)
    while t < total:
        top, when, which, earned, k = np.float64(NEVER), -1, -1, np.float64(0), 0
        while True:
            so_far = earned + before[f + k] - before[f]
            if t + k == total:
                if lasting[f + k] and so_far > top:
                    top, when, which = so_far, total, -1
                break
            if k >= wait:
                for e in range(indptr[f + k], indptr[f + k + 1]):
                    value = so_far - costs[e] + _changed(t + k, e, seam_ptr, seam_at, seam_sign, beats)
                    value += _landed(t + k, targets[e], total, hold, rows, before, beats, worth, shift)
                    if value > top:
                        top, when, which = value, t + k, e
            if left[f + k] == 0:
                break
            if worth[f + k] > 0:
                earned += worth[f + k] * beats[(t + k + PAD) * FINE + shift[f + k]]
            k += 1
        if count == 0:
            outcome = top
        if which < 0 or top < 0.5 * NEVER:
            break
        times[count], joins[count] = when, which
        count += 1
        t, f, wait = when + hold, targets[which] + hold, 0
    return count, outcome


class Worth:
    """What each frame is worth when it is shown some frames from now, with the best that may follow.

    Parameters
    ----------
    ground : frames and joins.
    shown : (N,) what showing each frame is worth beside its stops.
    beats : ((T + 2 PAD) · FINE,) what a stop at each instant is worth, from ``PAD`` frames before now.
    near, every : after ``near`` frames joins are looked at in every so many frames of time only.
    first : frames from now before which no value is needed: only :meth:`walk` with a wait of ``first`` − m is asked.
    rows : room for the values, at least ``room(ground, T)``; made if not given.
    """

    def __init__(
        self,
        ground: Ground,
        shown: Float32 | Array,
        beats: Float32,
        near: int = 0,
        every: int = 1,
        first: int = 0,
        rows: Float32 | None = None,
    ) -> None:
        self.ground, self.shown, self.beats = ground, shown, beats
        self.total = len(beats) // FINE - 2 * PAD
        size = (self.total + 1, len(ground) + self.total)
        rows = np.empty(room(len(ground), self.total), np.float32) if rows is None else rows
        self.rows = rows[: size[0] * size[1]].reshape(size)
        self.before = _running(shown, ground.left)
        goals, place = ground.goals
        _fill(
            min(first, self.total), self.total, near, every, ground.hold, self.rows, self.before, beats, ground.lasting,
            np.flatnonzero(ground.left == 0).astype(np.int32), ground.stops, ground.stop_worth, ground.stop_shift,
            ground.indptr, place, ground.costs, ground.costs - self._promise(), goals,
            ground.seam_ptr, ground.seam_at, ground.seam_sign,
        )  # fmt: skip

    def _promise(self) -> Float32:
        """(joins,) the most that the stops changed by each join can be worth."""
        high, low = float(self.beats.max()), float(self.beats.min())
        sign = self.ground.seam_sign
        total = np.append(0.0, np.cumsum(np.maximum(sign * high, sign * low)))
        return (total[self.ground.seam_ptr[1:]] - total[self.ground.seam_ptr[:-1]]).astype(np.float32)

    @property
    def now(self) -> Array:
        """(N,) the worth of beginning with each frame now."""
        return self.rows[0, self.total : self.total + len(self.ground)].astype(np.float64) - self.before

    def entered(self) -> Array:
        """(N,) the worth of beginning with each frame now and dancing it for m frames at least."""
        ground, hold = self.ground, min(self.ground.hold, self.total)
        worth = self.rows[hold, self.total : self.total + len(ground)].astype(np.float64) - self.before
        for k in range(hold):
            stops = ground.stops[ground.stops >= k]
            worth[stops - k] += ground.stop_worth[stops] * self.beats[(k + PAD) * FINE + ground.stop_shift[stops]]
        return np.where(ground.left >= hold, worth, float(NEVER))

    def walk(self, frame: int, wait: int = 0) -> Steps:
        """The best way from ``frame`` on over the whole horizon; its first join is not before ``wait`` frames."""
        ground, most = self.ground, self.total // self.ground.hold + 2
        times, joins = np.zeros(most, np.int64), np.zeros(most, np.int64)
        count, worth = _walk(
            frame, wait, self.total, ground.hold, self.rows, self.before, self.beats,
            ground.lasting, ground.left, ground.stop_worth, ground.stop_shift, ground.indptr, ground.targets,
            ground.costs, ground.seam_ptr, ground.seam_at, ground.seam_sign, times, joins,
        )  # fmt: skip
        return Steps(times[:count], joins[:count], ground.targets[joins[:count]].astype(np.int64), float(worth))

    def earned(self, frames: Ints, steps: Steps) -> float:
        """What the first ``frames`` (n,) that a way shows earn, less what its joins up to there cost."""
        ground = self.ground
        at = np.flatnonzero(ground.stop_worth[frames] > 0)
        stops = ground.stop_worth[frames[at]] * self.beats[(at + PAD) * FINE + ground.stop_shift[frames[at]]]
        total = float(np.sum(self.shown[frames], dtype=np.float64)) + float(np.sum(stops, dtype=np.float64))
        for t, e in zip(steps.times.tolist(), steps.joins.tolist(), strict=True):
            if t < len(frames):
                row = slice(int(ground.seam_ptr[e]), int(ground.seam_ptr[e + 1]))
                total += float(np.sum(ground.seam_sign[row] * self.beats[(t + PAD) * FINE + ground.seam_at[row]]))
                total -= float(ground.costs[e])
        return total


def _running(shown: Float32 | Array, left: Ints) -> Float32:
    """(N,) P: sums of ``shown`` over the frames before each of its clip."""
    total = np.cumsum(shown, dtype=np.float64) - shown
    starts = np.append(0, np.flatnonzero(left == 0)[:-1] + 1)
    return (total - np.repeat(total[starts], np.diff(np.append(starts, len(left))))).astype(np.float32)


def room(frames: int, total: int) -> int:
    """Values that a horizon of ``total`` frames needs over ``frames`` of a library."""
    return (total + 1) * (frames + total)


def joined(frame: int, steps: Steps, end: int) -> list[tuple[int, int, int]]:
    """(time, frame, frames) of the stretches of a way from ``frame`` now up to ``end``."""
    times = [0, *steps.times.tolist()]
    entries = [frame, *steps.entries.tolist()]
    ends = [*times[1:], end]
    return [(t, f, min(e, end) - t) for t, f, e in zip(times, entries, ends, strict=True) if t < end and e > t]
