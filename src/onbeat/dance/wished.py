"""Wishes as the search sees them: worths of clips, frames that must be shown, frames that must not."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Bools, Float32, Ints
from onbeat.dance.document import DanceDocument
from onbeat.dance.earlier import Earlier, read_earlier
from onbeat.dance.optimal import Problem, joins_from
from onbeat.dance.part import Part
from onbeat.dance.plan import DancePlan
from onbeat.dance.warp import Held
from onbeat.dance.windows import LONGEST
from onbeat.dance.wishes import FAVOURED, Kept, Marks, Wishes
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID, STRETCH
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

MARGIN = LONGEST / 2
"""Seconds before and after a kept stretch that are kept, too, so that no blend reaches into it."""
TASTE, TASTED = 0.25, 1.0
"""Standard deviation of what a seed likes better or worse a second, and the seconds of a clip that it likes alike."""
PAPER = 0.15
"""What a wish counts in the search of 2006, as a part of what it counts in ours."""
SAME_BEAT = 0.07
"""Seconds by which a beat of an earlier dance may be off to be the same."""
WAY_IN, WAY_OUT, WAYS = 3.0, 3.0, 60
"""Seconds of a part of a library before and after what is kept, and of so many ways that join to it and from it."""


class OtherBeatsWarning(UserWarning):
    """A stretch is kept of a dance whose beats are others."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A kept stretch, read back.

    Parameters
    ----------
    kept : as it was wished.
    earlier : the dance it is of.
    begin, end : seconds of the song between which all is as it was, ``MARGIN`` more than wished where there is room.
    """

    kept: Kept
    earlier: Earlier
    begin: float
    end: float

    @property
    def frames(self) -> tuple[int, int]:
        """The first song frame whose place in the plan is kept, and the one after the last."""
        first, last = self.earlier.warp(np.array([self.begin, self.end])).tolist()
        return int(np.floor(first * GRID + 1e-6)), int(np.ceil(last * GRID - 1e-6)) + 1


@dataclass(frozen=True, eq=False)
class Wished:
    """Wishes for one library and one song.

    Parameters
    ----------
    marks : of the library's clips.
    stretches : that are kept.
    favour, taste : (N,) what each frame of the library's graph earns besides, as a favourite and by the seed.
    """

    marks: Marks
    stretches: tuple[Stretch, ...]
    favour: Float32
    taste: Float32

    @classmethod
    def of(cls, wishes: Wishes, library: MoveLibrary, song: Song, seed: int = 0) -> Wished:
        """Read the earlier dances back and look up the clips.

        With a stretch kept and a ``seed`` other than 0, every second of a clip is liked a little better or worse, by
        chance, so that each seed dances the rest otherwise.

        Raises
        ------
        PlanError
            If there is no clip of a name, nothing is left to dance with, or a kept stretch cannot be danced again.
        """
        marks = wishes.marks(library)
        stretches = _stretches(wishes, library, song)
        _check(stretches, marks, library)
        clip_of = np.asarray(library.graph.clip_of)
        favour = marks.favourites[clip_of] * np.float32(FAVOURED / GRID)
        taste = _taste(library, seed if stretches else 0)
        return cls(marks, stretches, favour.astype(np.float32), taste)

    def allowed(self, library: MoveLibrary) -> Bools:
        """(N,) true for the frames of the library's graph that are not forbidden."""
        return ~self.marks.forbidden[np.asarray(library.graph.clip_of)]

    def wanted(self, problem: Problem, part: Part | None = None) -> Problem:
        """A problem, over the library or a part of it, with the wishes in it."""
        extra = self.favour + self.taste
        extra = extra if part is None else extra[part.frames]
        laid = replace(problem.frames, idle=problem.frames.idle - extra[problem.frames.base])
        return replace(problem, frames=laid, kept=self._kept(problem) if self.stretches else None)

    def liked(self, part: Part | None) -> Float32:
        """(n,) what frames count besides in Eq. 11 of the search of 2006, whose sums are smaller and not below 0."""
        liked = (self.favour + np.maximum(self.taste, 0)) * np.float32(PAPER)
        return liked if part is None else liked[part.frames]

    def held(self) -> tuple[Held, ...]:
        """What the time warp has to keep."""
        return tuple(Held(stretch.begin, stretch.end, stretch.earlier.warp) for stretch in self.stretches)

    def spans(self, plan: DancePlan) -> Array:
        """(joins,) seconds that blends inside kept stretches last; NaN for all others."""
        spans = np.full(len(plan.moves) - 1, np.nan)
        frames = np.round(plan.join_times * GRID).astype(np.int64)
        for stretch in self.stretches:
            first, end = stretch.frames
            then = np.round(stretch.earlier.plan.join_times * GRID).astype(np.int64)
            inside = (then > first) & (then < end)
            for frame, span in zip(then[inside].tolist(), stretch.earlier.spans[inside].tolist(), strict=True):
                spans[frames == frame] = span
        return spans

    def told(self, plan: DancePlan, library: MoveLibrary) -> dict[str, float | None]:
        """For ``dance.json``: seconds kept and of favourites, and what these and the seed earned of the objective."""
        times = (np.arange(round(plan.duration * GRID), dtype=np.float64) + 0.5) / GRID
        which, seconds = plan.clip_times(times)
        clips = np.array([move.clip for move in plan.moves])[which]
        last = np.diff(library.starts)[clips] - 1
        shown = library.starts[clips] + np.clip(np.round(seconds * GRID - 0.5).astype(np.int64), 0, last)
        kept = math.fsum(stretch.kept.to_s - stretch.kept.from_s for stretch in self.stretches)
        return {
            "kept_s": round(kept, 4),
            "forbidden_clips": float(self.marks.forbidden.sum()),
            "favourites_s": round(float(self.marks.favourites[clips].sum()) / GRID, 4),
            "favourites_earned": round(float(self.favour[shown].sum()), 5),
            "seed_earned": round(float(self.taste[shown].sum()), 5),
        }

    def around(self, library: MoveLibrary) -> Bools:
        """(N,) true for frames that a part of the library needs for the kept stretches, and for ways in and out."""
        near = np.zeros(len(library.graph), bool)
        for stretch in self.stretches:
            _mark_around(near, stretch, library)
        return near & self.allowed(library)

    def _kept(self, problem: Problem) -> NDArray[np.int32]:
        """(T,) the virtual frame to show at each song frame, −1 where any may be."""
        kept = np.full(problem.music.frames, -1, np.int32)
        for stretch in self.stretches:
            first, shown = _virtual(problem, stretch)
            place = kept[first : first + len(shown)]
            shown = shown[: len(place)]
            if np.any((place >= 0) & (place != shown)):
                raise PlanError(
                    f"cannot keep {stretch.kept}: another stretch is kept there, too, which shows other clips; "
                    "keep each second of the song once"
                )
            place[:] = shown
        _check_joins(problem, kept)
        return kept


def _stretches(wishes: Wishes, library: MoveLibrary, song: Song) -> tuple[Stretch, ...]:
    read: list[tuple[DanceDocument, Earlier]] = []
    stretches: list[Stretch] = []
    for kept in sorted(wishes.kept, key=lambda kept: kept.from_s):
        if kept.to_s > song.duration + 1e-3:
            raise PlanError(f"cannot keep {kept}: the song lasts {song.duration:.2f} s; keep a stretch of it")
        known = [earlier for dance, earlier in read if dance == kept.dance]
        earlier = known[0] if known else read_earlier(kept.dance, library, song.beats, song.duration)
        read.append((kept.dance, earlier))
        _tell_other_beats(kept, song)
        end = min(kept.to_s + MARGIN, song.duration, earlier.plan.duration)
        stretches.append(Stretch(kept, earlier, max(kept.from_s - MARGIN, 0.0), end))
    return _apart(stretches)


def _tell_other_beats(kept: Kept, song: Song) -> None:
    """Warn where the beats of a kept stretch are not those of the song: it may be of a dance to another."""
    then = np.array([beat for beat in kept.dance.beats if kept.from_s <= beat <= kept.to_s])
    near = np.abs(then[:, None] - song.beats).min(axis=1, initial=np.inf) < SAME_BEAT
    if len(then) and near.mean() < 0.5:
        warnings.warn(
            f"{kept} is kept of a dance to other beats: {near.sum()} of its {len(then)} beats there are beats now; "
            "the dance is to another song, or its beats were corrected",
            OtherBeatsWarning,
            stacklevel=2,
        )


def _apart(stretches: list[Stretch]) -> tuple[Stretch, ...]:
    """The stretches without their margins where that of another dance begins too soon after one."""
    out = list(stretches)
    for k, (before, after) in enumerate(itertools.pairwise(stretches)):
        if before.earlier is not after.earlier and before.end > after.begin:
            out[k] = replace(out[k], end=before.kept.to_s)
            out[k + 1] = replace(out[k + 1], begin=after.kept.from_s)
    return tuple(out)


def _check(stretches: Sequence[Stretch], marks: Marks, library: MoveLibrary) -> None:
    """Refuse to keep clips that are not there or are forbidden."""
    for stretch in stretches:
        first, end = stretch.frames
        for name, move, lasts in zip(
            stretch.earlier.names, stretch.earlier.plan.moves, [*stretch.earlier.plan.join_times, np.inf], strict=True
        ):
            if move.at_s * GRID >= end or lasts * GRID <= first:
                continue
            where = f"cannot keep {stretch.kept}: it shows clip {name!r}"
            if move.clip < 0:
                raise PlanError(f"{where}, which the library does not have; dance with the moves it was made with")
            if marks.forbidden[move.clip]:
                raise PlanError(f"{where}, which is forbidden; keep another stretch, or allow the clip")


def _virtual(problem: Problem, stretch: Stretch) -> tuple[int, Ints]:
    """The first kept song frame, and the virtual frames shown from there on."""
    plan, laid = stretch.earlier.plan, problem.frames
    first, end = stretch.frames
    which, seconds = plan.clip_times(np.arange(first, min(end, round(plan.duration * GRID))) / GRID)
    shown = np.empty(len(which), np.int64)
    clips = np.asarray(problem.graph.clip_of)[laid.base]
    for number in np.unique(which).tolist():
        move, here = plan.moves[number], np.flatnonzero(which == number)
        row = np.flatnonzero((clips == move.clip) & (np.abs(laid.rate - move.rate) < 1e-9))
        place = np.clip(np.searchsorted(laid.second[row], seconds[here] - 1e-4), 0, len(row) - 1) if len(row) else row
        if not len(row) or np.abs(laid.second[row][place] - seconds[here]).max() > 1e-4:
            raise PlanError(
                f"cannot keep {stretch.kept}: clip {stretch.earlier.names[number]!r} has no {move.from_s:.2f} to "
                f"{move.to_s:.2f} s; dance with the moves it was made with"
            )
        shown[here] = row[place]
    return first, shown


def _check_joins(problem: Problem, kept: NDArray[np.int32]) -> None:
    """Refuse kept joins that the graph does not have."""
    for t in (np.flatnonzero((kept[:-1] >= 0) & (kept[1:] >= 0) & (np.diff(kept) != 1)) + 1).tolist():
        leaves = int(kept[t - 1]) + 1
        if problem.frames.left[kept[t - 1]] < 1 or kept[t] not in joins_from(problem, leaves, t)[0]:
            raise PlanError(
                f"cannot keep the join at {t / GRID:.2f} s of the song: this library does not join these clips there; "
                "dance with the moves that the stretch was made with, or keep the stretches before and after it"
            )


def _taste(library: MoveLibrary, seed: int) -> Float32:
    """(N,) what a seed likes: each ``TASTED`` seconds of a clip alike."""
    if seed == 0:
        return np.zeros(len(library.graph), np.float32)
    clip_of = np.asarray(library.graph.clip_of)
    within = ((np.arange(len(clip_of)) - library.starts[clip_of]) / GRID / TASTED).astype(np.int64)
    most = int(within.max()) + 1
    liked = np.random.default_rng(seed).normal(0.0, TASTE / GRID, (len(library.clips), most))
    return liked[clip_of, within].astype(np.float32)


def _mark_around(near: Bools, stretch: Stretch, library: MoveLibrary) -> None:
    """Mark what a stretch shows, the seconds before and after it, and the smoothest ways to these and from these."""
    plan, graph = stretch.earlier.plan, library.graph
    first, end = stretch.frames
    which, seconds = plan.clip_times(np.arange(first, min(end, round(plan.duration * GRID))) / GRID)
    clips = np.array([move.clip for move in plan.moves])[which]
    shown = library.starts[clips] + np.minimum(
        np.round(seconds * GRID).astype(np.int64), np.diff(library.starts)[clips] - 1
    )
    for run in np.split(shown, np.flatnonzero(np.diff(which)) + 1):  # with room for the joins at their ends
        near[_run(library, int(run[0]), -2, max(len(run), round(STRETCH * GRID)) * 5 // 4 + 4)] = True
    before = _run(library, int(shown[0]), -round(WAY_IN * GRID), 2)
    after = _run(library, int(shown[-1]), 0, round(WAY_OUT * GRID))
    near[before] = near[after] = True
    leading = np.flatnonzero(np.isin(graph.targets, before))
    leading = leading[np.argsort(graph.costs[leading], kind="stable")[:WAYS]]
    for source in (np.searchsorted(graph.indptr, leading, side="right") - 1).tolist():
        near[_run(library, source, -round(WAY_IN * GRID), 2)] = True
    rows = [np.arange(int(graph.indptr[i]), int(graph.indptr[i + 1])) for i in after.tolist()]
    leaving = np.concatenate([*rows, np.zeros(0, np.int64)]).astype(np.int64)
    leaving = leaving[np.argsort(graph.costs[leaving], kind="stable")[:WAYS]]
    for target in graph.targets[leaving].tolist():
        near[_run(library, target, 0, round(WAY_OUT * GRID))] = True


def _run(library: MoveLibrary, frame: int, low: int, high: int) -> Ints:
    """Graph frames from ``low`` up to ``high`` after a frame, within its clip."""
    clip = int(library.graph.clip_of[frame])
    begin, end = int(library.starts[clip]), int(library.starts[clip + 1])
    return np.arange(max(frame + low, begin), min(frame + high, end), dtype=np.int64)
