"""What to dance next, from the motion graph: the best way over the beats to come, of which the beginning is danced.

Each time the exact value to go (:mod:`onbeat.live.choice.worth`) is found over the next seconds of predicted beats,
with the music's intensity as it is now, on the objective of :mod:`onbeat.dance.score` and at playback rate 1: the time
map does the rest. What was shown lately costs (:mod:`onbeat.live.choice.recent`). Nothing is chosen that leads to a
dead end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Float32, Times, frozen
from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import NEVER, Problem
from onbeat.dance.score import FINE, INTENSITY, Music
from onbeat.dance.seams import CHANGED, find_seams
from onbeat.dance.search import ALIKE, JOIN, ROUGH
from onbeat.errors import PlanError
from onbeat.live.choice.foretold import REACH, beat_worths, checked_beats
from onbeat.live.choice.ground import Ground
from onbeat.live.choice.recent import PRICE, Recent
from onbeat.live.choice.worth import Steps, Worth, joined, room
from onbeat.moves.graph import GRID, MARGIN
from onbeat.moves.library import MoveLibrary

TASTE = 0.05
"""Spread of what a second of one clip is worth beside another to one who dances by another seed."""
LOUDEST = 2.5
"""Standard deviations of intensity beyond which music is not called louder."""
AFTER = 1.5
"""Seconds that are looked ahead at least beyond what is chosen."""
CLEAR = 0.15
"""Seconds from the next beat, at least, at which what is chosen ends, if it can."""
NEAR, EVERY = 3.0, 3
"""Later than these seconds from now, joins are looked at in every so many frames only."""
CALM = 1.5
"""What it costs to begin with hands that move as much as this library's do on average."""


@dataclass(frozen=True)
class Stretch:
    """A stretch of a clip, from ``from_s`` up to ``to_s`` seconds of it."""

    clip: int
    from_s: float
    to_s: float


@dataclass(frozen=True, eq=False)
class Chosen:
    """What is danced next.

    Parameters
    ----------
    stretches : in order, without a gap; a join lies between two of them.
    stops : seconds from the beginning of the first at which the hands come to rest in them.
    worth : what they earn, less what joins and what was shown lately cost, in units of a stop on its beat.
    optimum : what the best way of all earns over all the seconds looked ahead; these stretches are its beginning.
    """

    stretches: tuple[Stretch, ...]
    stops: Times
    worth: float
    optimum: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "stops", frozen(self.stops))

    @property
    def lasts(self) -> float:
        """Seconds that it lasts."""
        return sum(part.to_s - part.from_s for part in self.stretches)


class Improviser:
    """Chooses what to dance next.

    Parameters
    ----------
    library : the moves.
    seed : 0 likes all clips the same, another has a taste of its own.
    price : of what was shown a moment ago, for a second of it; 0 for a dance that may loop.

    Raises
    ------
    PlanError
        If no dance over the library's joins can go on for ever.
    """

    def __init__(self, library: MoveLibrary, seed: int = 0, *, price: float = PRICE) -> None:
        laid = lay_frames(library, (1.0,))
        costs = (JOIN + ROUGH * (library.graph.costs / ALIKE) ** 2).astype(np.float32)
        nothing = Music(np.zeros(1, np.float32), np.zeros(0, np.float32), 0)
        problem = Problem(library.graph, laid, nothing, costs, find_seams(library))
        self._library, self._ground = library, Ground.of(problem)
        self._recent = Recent(library, price)
        self._taste = _taste(library, seed) - laid.idle * np.float32(GRID)
        self._moved = laid.intensity
        self._rows = np.empty(0, np.float32)
        self.choose(None, 0.0, np.arange(0.5, 2.0, 0.5), None, 0.0, 1.0)  # compiles
        self._recent = Recent(library, price)

    def choose(
        self,
        at: tuple[int, float] | None,
        danced_since_join: float,
        beats: Times,
        weights: Array | None = None,
        intensity: float = 0.0,
        seconds: float = 2.0,
        ahead: float = 6.0,
    ) -> Chosen:
        """The best stretches for ``seconds`` or a little longer.

        Parameters
        ----------
        at : the clip that is danced, and the second of it that comes next; None begins anywhere.
        danced_since_join : seconds since the last join.
        beats : (B,) seconds from now of predicted beats, rising; those just before now count at joins.
        weights : (B,) 0…1, what a stop on each is worth; 1 if not given.
        intensity : of the music, in standard deviations from what it is on average.
        seconds : to be chosen.
        ahead : seconds to be looked ahead, at least ``seconds`` + ``AFTER``.

        Raises
        ------
        PlanError
            If an argument cannot be, or there is no such second of a clip.
        """
        self._check(at, danced_since_join, seconds, ahead)
        beats, weights = checked_beats(beats, weights)
        if at is None:
            return self.starts(beats, weights, intensity, seconds, ahead, calm=0.0)
        frame, late = self._frame(at)
        self._recent.take_back(frame)
        held = max(self._ground.hold - int(max(danced_since_join, 0.0) * GRID + 1e-6), 0)
        # A join may not change stops that were chosen before, unless there is no other way on.
        for every, wait in ((EVERY, max(_frames(CHANGED), held)), (1, held)):
            worth = self._worth(beats - late, weights, intensity, seconds, ahead, every, wait + self._ground.hold)
            steps = worth.walk(frame, wait)
            if steps.worth > NEVER / 2:
                return self._choice(worth, frame, late, steps, beats, seconds)
        raise PlanError(
            f"from second {at[1]:.2f} of {self._library.clips[at[0]].name!r} on no dance goes on for ever; "
            "begin with starts() or choose(None, …)"
        )

    def starts(
        self,
        beats: Times,
        weights: Array | None = None,
        intensity: float = 0.0,
        seconds: float = 2.0,
        ahead: float = 6.0,
        *,
        pose: Float32 | None = None,
        calm: float = CALM,
    ) -> Chosen:
        """The best stretches to begin with.

        Parameters
        ----------
        beats, weights, intensity, seconds, ahead : as in :meth:`choose`.
        pose : (D,) pose vector (:mod:`onbeat.moves.poses`) from which the dance sets out: near ones are preferred.
        calm : what it costs to begin with hands that move; 0 if they may.

        Raises
        ------
        PlanError
            If an argument cannot be, or the library has no beginning.
        """
        self._check(None, 0.0, seconds, ahead)
        beats, weights = checked_beats(beats, weights)
        entering, hold = self._entering(pose, calm), self._ground.hold
        for every in (EVERY, 1):
            worth = self._worth(beats, weights, intensity, seconds, ahead, every, hold)
            frame = int(np.argmax(worth.entered() - entering))
            steps = worth.walk(frame, hold)
            if steps.worth > NEVER / 2:
                return self._choice(worth, frame, 0.0, steps, beats, seconds)
        raise PlanError("the library has no second with which to begin: its clips are too short; add longer ones")

    def _check(self, at: tuple[int, float] | None, danced: float, seconds: float, ahead: float) -> None:
        for name, value in (("seconds", seconds), ("ahead", ahead)):
            if not 0 < value <= REACH:
                raise PlanError(f"{name} is {value}; expected more than 0 and at most {REACH:g}")
        if np.isnan(danced):
            raise PlanError("danced_since_join is not a number")
        clips = self._library.clips
        if at is not None and not (0 <= at[0] < len(clips) and 0 <= at[1] * GRID <= len(clips[at[0]].poses) - 1):
            raise PlanError(f"the library has no second {at[1]:g} of a clip {at[0]}; it has {len(clips)} clips")

    def _frame(self, at: tuple[int, float]) -> tuple[int, float]:
        """The frame of the graph that comes next, and in how many seconds."""
        within = int(np.ceil(at[1] * GRID - 1e-6))
        return int(self._library.starts[at[0]]) + within, within / GRID - at[1]

    def _worth(
        self, beats: Times, weights: Array, intensity: float, seconds: float, ahead: float, every: int, first: int
    ) -> Worth:
        total = _frames(min(max(ahead, seconds + AFTER), REACH + AFTER))
        z = float(np.clip(np.nan_to_num(intensity), -LOUDEST, LOUDEST)) * INTENSITY
        shown = (self._moved * z + self._taste) / GRID - self._recent.prices()
        if len(self._rows) < room(len(self._ground), total):
            self._rows = np.empty(room(len(self._ground), total), np.float32)
        return Worth(self._ground, shown, beat_worths(beats, weights, total), _frames(NEAR), every, first, self._rows)

    def _entering(self, pose: Float32 | None, calm: float) -> Array:
        """(N,) what it costs to begin with each frame."""
        library = self._library
        intensity = library.intensity
        cost = calm * intensity / max(float(intensity.mean()), 1e-6)
        if pose is not None:
            poses = np.concatenate([clip.poses for clip in library.clips])
            cost = cost + ROUGH * np.sum((poses - pose) ** 2, axis=1) / ALIKE**2
        room_before = np.concatenate([np.arange(len(clip.poses)) for clip in library.clips])
        return np.where(room_before < _frames(MARGIN), -NEVER, cost)

    def _choice(self, worth: Worth, frame: int, late: float, steps: Steps, beats: Times, seconds: float) -> Chosen:
        end = _end(steps, beats - late, _frames(seconds - late), worth.total)
        runs = joined(frame, steps, end)
        frames = np.concatenate([f + np.arange(n) for _, f, n in runs])
        earned = worth.earned(frames, steps)
        self._recent.show(frames)
        parts = [self._stretch(f, n) for _, f, n in runs]
        parts[0] = Stretch(parts[0].clip, parts[0].from_s - late, parts[0].to_s)
        return Chosen(tuple(parts), self._stops(runs, steps, end) + late, earned, steps.worth)

    def _stretch(self, frame: int, frames: int) -> Stretch:
        clip = int(np.searchsorted(self._library.starts, frame, side="right")) - 1
        begin = frame - int(self._library.starts[clip])
        return Stretch(clip, begin / GRID, (begin + frames) / GRID)

    def _stops(self, runs: list[tuple[int, int, int]], steps: Steps, end: int) -> Times:
        """Seconds of the stops in stretches, with those that joins make and without those that they unmake."""
        ground, stops = self._ground, list[int]()
        for t, f, n in runs:
            at = np.flatnonzero(ground.stop_worth[f : f + n] > 0)
            stops += ((t + at) * FINE + ground.stop_shift[f + at]).tolist()
        for t, e in zip(steps.times.tolist(), steps.joins.tolist(), strict=True):
            for k in range(int(ground.seam_ptr[e]), int(ground.seam_ptr[e + 1]) if t < end else 0):
                instant = t * FINE + int(ground.seam_at[k])
                if ground.seam_sign[k] > 0:
                    stops.append(instant)
                elif near := [other for other in stops if abs(other - instant) <= 2]:
                    stops.remove(near[0])
        found = np.unique(np.array(stops, np.int64))
        return found[(found >= 0) & (found < end * FINE)] / (GRID * FINE)


def _end(steps: Steps, beats: Times, least: int, total: int) -> int:
    """The frame at which to end, ``least`` or later: clear of beats, and of joins that could change stops."""
    after = np.arange(least, max(total - _frames(CHANGED), least + 1))
    ahead = steps.times[:, None] - after
    good = np.all((ahead <= -_frames(CHANGED)) | (ahead >= _frames(CHANGED)), axis=0)
    clear = np.all(np.abs(beats[:, None] - after / GRID) >= CLEAR, axis=0)
    best = good & clear & (after < least + _frames(0.5))
    return int(after[np.argmax(best if best.any() else good)]) if good.any() else least


def _frames(seconds: float) -> int:
    return int(np.ceil(seconds * GRID - 1e-6))


def _taste(library: MoveLibrary, seed: int) -> Float32:
    """(N,) what a second of each frame's clip is worth by taste."""
    liking = np.random.default_rng(seed).normal(0.0, TASTE, len(library.clips)) * (seed != 0)
    return np.repeat(liking, [len(clip.poses) for clip in library.clips]).astype(np.float32)
