# The compiled loops take plain arrays and numbers, which numba types itself.
# pyright: reportMissingParameterType=false, reportUnknownParameterType=false
"""The best dance there is in the time-expanded motion graph: exact dynamic programming, in numba.

A state is a virtual frame f about to be shown at song frame t. Its value to go is

    V(t, f) = max( r(t, f) + V(t+1, f+1),  max over joins f → g of  W(t, g) − c )
    W(t, g) = Σ_{k<m} r(t+k, g+k) + V(t+m, g+m)

W is a macro-edge: a join and the m frames that must be danced after it, so that no state has to remember when the
last join was. Its sums run along the diagonals and are updated in O(1). A join leads to the best rate at its target.
Cost: O(T (M + joins)). Rows of V are held for one stretch of the song at a time and computed again when they are
needed, so that memory does not grow with the song.
"""

from __future__ import annotations

import contextlib
import itertools
import mmap
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from onbeat._shapes import Array, Bools, Float32, Ints
from onbeat.dance.score import FINE, Frames, Music
from onbeat.dance.seams import Seams
from onbeat.dance.too_long import too_long
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID, STRETCH, MotionGraph

HOLD = round(STRETCH * GRID)
"""m: song frames danced at least after a join."""
NEVER = np.float32(-1e30)
BARRED = np.float32(-1e5)
"""What it is worth to show another frame than the one that is kept: less than any dance can make up for."""
NO_WAY = (
    "no dance keeps the stretches that are to be kept: between them, or between one of them and the song's beginning "
    "or end, no joins lead from clip to clip in time; keep less, forbid fewer clips, or add clips"
)
ROWS_MEMORY = 460_000_000  # bytes of V held at once


@dataclass(frozen=True, eq=False)
class Problem:
    """All that a search needs: graph, frames, music and the price of joins.

    Parameters
    ----------
    join_costs : (joins,) what each join of the graph costs, in units of the score.
    seams : what each join does to the stops beside it; None if nothing.
    hold : m, song frames danced at least after a join.
    kept : (T,) int32 the virtual frame that must be shown at each song frame, −1 where any may; None if any may always.
    """

    graph: MotionGraph
    frames: Frames
    music: Music
    join_costs: Float32
    seams: Seams | None = None
    hold: int = HOLD
    kept: NDArray[np.int32] | None = None

    def part(self, begin: int, end: int) -> Problem:
        """The song frames from ``begin`` up to ``end``."""
        kept = None if self.kept is None else self.kept[begin:end]
        return replace(self, music=self.music.part(begin, end), kept=kept)

    @cached_property
    def must(self) -> NDArray[np.int32]:
        """(T,) ``kept``, or −1 for every song frame."""
        return np.full(self.music.frames, -1, np.int32) if self.kept is None else self.kept.astype(np.int32)

    @cached_property
    def goals(self) -> tuple[Ints, Ints]:
        """The base frames that joins lead to, and the place of each join's target among them."""
        return np.unique(self.graph.targets, return_inverse=True)

    @cached_property
    def entries(self) -> NDArray[np.int32]:
        """(R, goals) int32 virtual frame of each goal at each rate; −1 where the clip ends too soon after it."""
        entry = self.frames.entry[:, self.goals[0]]
        return np.where(self.frames.left[entry] > self.hold, entry, -1).astype(np.int32)

    @cached_property
    def promise(self) -> Float32:
        """(joins,) the most that the stops changed by each join can be worth."""
        indptr, _, sign = self.changes
        high, low = float(self.music.beat_worth.max()), float(self.music.beat_worth.min())
        each = np.where(sign > 0, high, -low)
        total = np.concatenate(([0.0], np.cumsum(each)))
        return (total[indptr[1:]] - total[indptr[:-1]]).astype(np.float32)

    @cached_property
    def changes(self) -> tuple[NDArray[np.int32], NDArray[np.int32], Float32]:
        """The seams' arrays, empty ones where there are none."""
        if self.seams is None:
            return np.zeros(self.graph.join_count + 1, np.int32), np.zeros(0, np.int32), np.zeros(0, np.float32)
        return self.seams.indptr, self.seams.at, self.seams.sign

    @property
    def worth(self) -> tuple[Any, ...]:
        """Those of ``arrays`` that :func:`rewards` takes."""
        return self.arrays[6:14]

    @cached_property
    def arrays(self) -> tuple[Any, ...]:
        """The arrays as the compiled loops take them."""
        g, f, m = self.graph, self.frames, self.music
        return (
            g.indptr.astype(np.int32),
            self.goals[1].astype(np.int32),
            self.join_costs,
            f.base.astype(np.int32),
            np.flatnonzero(f.left == 0).astype(np.int32),
            self.entries,
            np.flatnonzero(f.stop_worth > 0).astype(np.int32),
            f.stop_worth,
            f.stop_shift.astype(np.int32),
            f.intensity,
            f.idle,
            m.beat_worth,
            m.intensity,
            self.must,
            *self.changes,
            self.promise,
        )


@njit(cache=True, boundscheck=False)
def rewards(t, row, stops, worth, shift, motion, idle, beats, music, must):
    """Fill ``row`` with r(t, ·), the worth of showing each virtual frame at song frame t."""
    now = music[t]
    for f in range(len(row)):
        row[f] = motion[f] * now - idle[f]
    for s in stops:
        row[s] += worth[s] * beats[(t + 4) * FINE + shift[s]]
    if must[t] >= 0:
        own = row[must[t]]
        row[:] = BARRED
        row[must[t]] = own


@njit(cache=True, boundscheck=False, inline="always")
def seam(t, e, indptr, at, sign, beats):
    """What the stops that join e makes and unmakes are worth when it is taken at song frame t."""
    value = np.float32(0)
    if t == 0:  # nothing is danced before the song: a join there is only another beginning
        return value
    for k in range(indptr[e], indptr[e + 1]):
        value += sign[k] * beats[max(0, min((t + 4) * FINE + at[k], len(beats) - 1))]
    return value


@njit(cache=True, boundscheck=False)
def best_entries(sums, after, span, entries, best, which):
    """For each goal the highest W over the rates, and the virtual frame that has it."""
    for i in range(entries.shape[1]):
        top, chosen = NEVER, np.int32(-1)
        for r in range(entries.shape[0]):
            f = entries[r, i]
            if f >= 0:
                value = np.float32(sums[f] + after[f + span])
                if value > top:
                    top, chosen = value, f
        best[i], which[i] = top, chosen


@njit(cache=True, boundscheck=False)
def _backward(
    begin,
    end,
    frames,
    hold,
    buffer,
    sums,
    indptr,
    goal,
    costs,
    base,
    ends,
    entries,
    stops,
    worth,
    shift,
    motion,
    idle,
    beats,
    music,
    must,
    seam_ptr,
    seam_at,
    seam_sign,
    promise,
):
    """Fill rows t − begin of ``buffer`` with V(t, ·) for t = end−1 … begin; the rows from ``end`` on are there."""
    size, nodes, goals = len(base), len(indptr) - 1, entries.shape[1]
    row, gone = np.empty(size, np.float32), np.empty(size, np.float32)
    best, which = np.empty(goals, np.float32), np.empty(goals, np.int32)
    leap = np.empty(nodes, np.float32)
    for t in range(end - 1, begin - 1, -1):
        span = min(hold, frames - t)
        rewards(t, row, stops, worth, shift, motion, idle, beats, music, must)
        # Sums along the diagonals, those at t from those at t + 1. Where a clip ends they run on into the next
        # and mean nothing, but no join leads there.
        for f in range(size - 1):
            sums[f] = sums[f + 1] + row[f]
        sums[size - 1] = row[size - 1]
        if t + hold < frames:
            rewards(t + hold, gone, stops, worth, shift, motion, idle, beats, music, must)
            for f in range(size - hold):
                sums[f] -= gone[f + hold]
        best_entries(sums, buffer[t + span - begin], span, entries, best, which)
        for i in range(nodes):
            top = NEVER
            for e in range(indptr[i], indptr[i + 1]):
                value = best[goal[e]] - costs[e]
                if value + promise[e] > top:  # most joins cannot win whatever their stops are worth
                    top = max(top, value + seam(t, e, seam_ptr, seam_at, seam_sign, beats))
            leap[i] = top
        here, following = buffer[t - begin], buffer[t + 1 - begin]
        for f in range(size - 1):
            here[f] = max(leap[base[f]], row[f] + following[f + 1])
        for f in ends:
            here[f] = max(leap[base[f]], row[f]) if t + 1 == frames else leap[base[f]]


class ValueToGo:
    """V(t, f) for all song frames and virtual frames, computed backwards once and held for one stretch at a time.

    Parameters
    ----------
    problem : what to search.
    rows : song frames held at once; by default as many as ``ROWS_MEMORY`` bytes hold.

    Raises
    ------
    PlanError
        If no dance over the joins is as long as the song.
    """

    def __init__(self, problem: Problem, rows: int | None = None) -> None:
        self.problem = problem
        self.total = problem.music.frames
        size, hold = len(problem.frames), problem.hold
        self.rows = min(max(rows or ROWS_MEMORY // (4 * size), hold + 1), self.total)
        self._kept: dict[int, tuple[Float32, Array]] = {}
        self._buffer = _large((self.rows + hold, size))
        self._loaded = -1
        ahead, sums = np.zeros((hold, size), np.float32), np.zeros(size)
        for begin in reversed(range(0, self.total, self.rows)):
            self._kept[begin] = ahead.copy(), sums.copy()
            self._fill(begin, ahead, sums)
            ahead = self._buffer[:hold].copy()
        if NEVER / 2 < self.optimum < BARRED / 2:
            raise PlanError(NO_WAY)
        if self.optimum < NEVER / 2:
            raise PlanError(too_long(self._longest(), self.total))

    def _fill(self, begin: int, ahead: Float32, sums: Array) -> None:
        end, hold = min(begin + self.rows, self.total), self.problem.hold
        self._buffer[end - begin : end - begin + hold] = ahead
        _backward(begin, end, self.total, hold, self._buffer, sums, *self.problem.arrays)
        self._loaded = begin

    def _longest(self) -> int:
        """Song frames of the longest dance that there is: from so many before the end on, one comes to it."""
        for t in range(self.total):
            begin, _, rows = self.stretch(t)
            if rows[t - begin].max() > NEVER / 2:
                return self.total - t
        return 0

    def stretch(self, t: int) -> tuple[int, int, Float32]:
        """The stretch that holds song frame t: its begin, its end, and V to ``hold`` rows past its end."""
        begin = (t // self.rows) * self.rows
        if begin != self._loaded:
            ahead, sums = self._kept[begin]
            self._fill(begin, ahead, sums.copy())
        return begin, min(begin + self.rows, self.total), self._buffer

    @cached_property
    def optimum(self) -> float:
        """The score of the best dance of all, without any rule of variety."""
        _, _, rows = self.stretch(0)
        return float(rows[0].max())


def _large(shape: tuple[int, int]) -> Float32:
    """A float32 array in huge pages where the system has them: touching it first costs a tenth."""
    memory = mmap.mmap(-1, max(4 * shape[0] * shape[1], 1))
    if hasattr(mmap, "MADV_HUGEPAGE"):
        with contextlib.suppress(OSError):
            memory.madvise(mmap.MADV_HUGEPAGE)
    return np.frombuffer(memory, np.float32, shape[0] * shape[1]).reshape(shape)


@dataclass(frozen=True, eq=False)
class Path:
    """A dance as the search gives it: from song frame ``times[k]`` on, clips run from virtual frame ``entries[k]``."""

    times: Ints
    entries: Ints
    score: float


def reward_along(problem: Problem, t: int, entries: Ints, span: int) -> Array:
    """(len(entries),) sums of r(t+k, f+k) for k < ``span`` and each f of ``entries``."""
    frames, music = problem.frames, problem.music
    steps = np.arange(span)
    shown = np.asarray(entries, np.int64)[:, None] + steps
    worth = music.beat_worth[(t + steps + 4) * FINE + frames.stop_shift[shown]]
    value = frames.stop_worth[shown] * worth + frames.intensity[shown] * music.intensity[t + steps] - frames.idle[shown]
    must = problem.must[t : t + span]
    value = np.where((must >= 0) & (shown != must), BARRED, value)
    return value.sum(axis=1, dtype=np.float64)


def joins_from(problem: Problem, f: int, t: int) -> tuple[Ints, Array]:
    """The virtual frames that joins from virtual frame f enter, at all rates, and their costs at song frame t."""
    graph, base = problem.graph, int(problem.frames.base[f])
    row = slice(int(graph.indptr[base]), int(graph.indptr[base + 1]))
    entries = problem.entries[:, problem.goals[1][row]]
    indptr, at, sign = problem.changes
    worth = problem.music.beat_worth
    gains = [
        float(t > 0) * np.sum(sign[a:b] * worth[np.clip((t + 4) * FINE + at[a:b], 0, len(worth) - 1)], dtype=np.float64)
        for a, b in itertools.pairwise(indptr[row.start : row.stop + 1].tolist())
    ]
    costs = np.broadcast_to(problem.join_costs[row] - np.array(gains), entries.shape)
    usable: Bools = entries >= 0
    return entries[usable].astype(np.int64), costs[usable].astype(np.float64)


def best_path(value: ValueToGo, start: int = -1) -> Path:
    """The optimum itself: the path of highest score, without any rule of variety.

    With ``start``, a virtual frame just joined, the best that goes on from it.
    """
    problem, total = value.problem, value.total
    _, _, rows = value.stretch(0)
    f, t = (int(np.argmax(rows[0])), 0) if start < 0 else (start, 0)
    times, entries = [0], [f]
    if start >= 0:
        t = min(problem.hold, total)
        f = start + t
    while t < total:
        begin, _, rows = value.stretch(t)
        on = float(NEVER)
        if problem.frames.left[f] > 0 or t + 1 == total:
            following = float(rows[t + 1 - begin, f + 1]) if t + 1 < total else 0.0
            on = float(reward_along(problem, t, np.array([f]), 1)[0]) + following
        if float(rows[t - begin, f]) <= on + 1e-4:
            t, f = t + 1, f + 1
            continue
        span = min(problem.hold, total - t)
        goals, costs = joins_from(problem, f, t)
        after = rows[t + span - begin, goals + span] if t + span < total else 0.0
        f = int(goals[np.argmax(reward_along(problem, t, goals, span) + after - costs)])
        times.append(t)
        entries.append(f)
        t, f = t + span, f + span
    return Path(np.array(times), np.array(entries), score_path(problem, times, entries))


def score_path(problem: Problem, times: list[int] | Ints, entries: list[int] | Ints) -> float:
    """The score of a path: rewards of all frames less the costs of its joins.

    Raises
    ------
    ValueError
        If the path is none: a join that the graph does not have, one too soon after another, or a clip that ends.
    """
    frames, music = problem.frames, problem.music
    ends = [*list(times)[1:], music.frames]
    total, at = 0.0, -1
    for t, f, end in zip(times, entries, ends, strict=True):
        if t:
            goals, costs = joins_from(problem, at, int(t))
            if f not in goals:
                raise ValueError(f"no join from frame {at} to {f}")
            total -= float(costs[goals == f].min())
        span = int(end) - int(t)
        if span < (problem.hold if t else 1) and end != music.frames:
            raise ValueError(f"joins at song frames {t} and {end}: at least {problem.hold} must be danced between them")
        if frames.left[f] < span - (end == music.frames):
            raise ValueError(f"the clip ends before {span} frames after frame {f}")
        total += float(reward_along(problem, int(t), np.array([f]), span)[0])
        at = int(f) + span
    return total
