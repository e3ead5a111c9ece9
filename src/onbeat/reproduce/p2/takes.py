"""Takes of one dance at several speeds: of the embedded troupe, or real ones from files.

The troupe is made: its ornaments fade and its moves shrink in faster music because its motor model says so
(``examples.performer``). What is merely *played* faster is made beside it as a control: the same takes, as early and as
late, at one amount of detail.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import MetricError, OnbeatError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import DANCES, perform_dance
from onbeat.examples.performer import Performance
from onbeat.examples.rehearsal import rehearse
from onbeat.formats.read import read_motion
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.marks import read_marks
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion import Motion
from onbeat.music.beat_files import read_beats
from onbeat.retime.speeds import speeds_from
from onbeat.retime.takes import Take, rhythm_of

DANCE = "folk dance"
"""Of the troupe: eight keyposes in a cycle, as the dance of the paper has."""
TAKES, FEW = 5, 3
"""At each speed, as the paper recorded; and for a first look."""
BEATS, MARKS = ".beats", ".keyposes.csv"
"""What lies beside a real take: its beats' seconds, and those of its keyposes."""
LONGEST = 30.0
"""Seconds of a real dance that a robot dances at most."""


@dataclass(frozen=True, eq=False)
class Takes:
    """Takes of one dance.

    Parameters
    ----------
    title : who dances what.
    takes : on beats that are the same places of the dance in each.
    keyposes : (K,) beats, or None where nobody told them.
    cycle : beats after which the dance repeats, or None where a take is whole.
    """

    title: str
    takes: tuple[Take, ...]
    keyposes: Array | None
    cycle: int | None = None

    @property
    def dancer(self) -> str:
        """Who dances, as far as the title says so."""
        return self.title.partition(",")[0]

    @property
    def speeds(self) -> list[float]:
        """All that there are, slowest first."""
        return sorted({take.speed for take in self.takes})

    def at(self, speed: float) -> list[Take]:
        """The takes of a speed."""
        return [take for take in self.takes if take.speed == speed]


@dataclass(frozen=True, eq=False)
class Solo:
    """One dance for a robot to dance: the motion, and the seconds of its beats and its keyposes."""

    motion: Motion
    beats: Times
    keyposes: Times


def troupe_takes(
    dancer: int, speeds: Sequence[float], count: int, seed: int = 0, *, dance: str = DANCE, played: bool = False
) -> Takes:
    """A dancer of the troupe who rehearses a dance ``count`` times at each speed: early and late, the capture noisy.

    Parameters
    ----------
    dancer : place in ``DANCERS``.
    speeds : 1 for the original.
    count, seed : of takes at each speed, and of chance.
    dance : a name of ``DANCES``.
    played : the control: performances at speed 1 that are merely played faster.

    Examples
    --------
    >>> found = troupe_takes(0, (1.0, 1.2), 2)
    >>> found.title, len(found.takes), found.speeds, found.cycle, found.keyposes.round(2).tolist()
    ('Aiko, folk dance', 4, [1.0, 1.2], 12, [0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 8.0, 10.0])
    """
    beats = sum(figure.beats for figure in DANCES[dance])
    takes, keyposes = list[Take](), np.zeros(0)
    for speed in speeds:
        for number in range(count):
            rng = np.random.default_rng([seed, round(100 * speed), number])
            clip = perform_dance(DANCERS[dancer], dance, 1.0 if played else speed, 1, rng)
            clip = _played(clip, speed) if played else clip
            period = float(clip.beats[1] - clip.beats[0])
            # The dance begins with its first keypose; the way there from rest is no part of it.
            on = clip.keyposes[0] + period * np.arange(beats + 1)
            takes.append(Take(rehearse(clip, rng).motion, on, speed))
            keyposes = (clip.keyposes - clip.keyposes[0]) / period
    return Takes(f"{DANCERS[dancer].name}, {dance}", tuple(takes), keyposes, beats)


def _played(clip: Performance, speed: float) -> Performance:
    """A performance as it is, only faster."""
    motion = clip.motion
    shown = np.arange(int(motion.times[-1] / speed * motion.fps) + 1) / motion.fps * speed
    frames = np.minimum(np.round(shown * motion.fps).astype(np.int64), len(motion) - 1)
    return replace(
        clip,
        motion=motion.at(shown),
        keyposes=clip.keyposes / speed,
        beats=clip.beats / speed,
        contacts=clip.contacts[frames],
    )


def troupe_solo(dancer: int, seed: int = 0, cycles: int = 2, dance: str = DANCE) -> Solo:
    """A dance of the troupe as it is meant, neither early nor noisy: what a robot is to dance."""
    clip = perform_dance(DANCERS[dancer], dance, 1.0, cycles, np.random.default_rng([seed, dancer]))
    return Solo(clip.motion, clip.beats, clip.keyposes)


def real_takes(paths: Sequence[Path], fps: float | None = None) -> Takes:
    """Takes in files, each with ``NAME.beats`` beside it; the first beat of each is the same place of the dance.

    Speeds are those of the tempi, 1 for the slowest; keyposes lie in ``NAME.keyposes.csv`` beside the first. ``fps`` is
    the rate of files that store none.

    Raises
    ------
    MetricError
        If there are less than two, or one has no beats.
    """
    if len(paths) < 2:
        raise MetricError(f"{len(paths)} motion is no two takes of a dance; give takes at several speeds")
    without = [path for path in paths if not path.with_suffix(BEATS).is_file()]
    if without:
        raise MetricError(f"no beats beside {without[0].name}: write {without[0].stem}{BEATS}, a second a line")
    motions = [read_motion(path, fps=fps).replace(name=path.name) for path in paths]
    beats = [read_beats(path.with_suffix(BEATS)).times for path in paths]
    tempi = np.array([60.0 / float(np.median(np.diff(own))) for own in beats])
    takes = [Take(*one) for one in zip(motions, beats, speeds_from(tempi).tolist(), strict=True)]
    marks = paths[0].with_name(paths[0].stem + MARKS)
    known = None
    if marks.is_file():
        known = rhythm_of(takes[0])(read_marks(marks, (len(motions[0]) - 1) / motions[0].fps))
    return Takes(f"{paths[0].stem} and {len(paths) - 1} more", tuple(takes), known)


def real_solo(path: Path, fps: float | None = None) -> Solo:
    """A real dance for a robot, its first ``LONGEST`` seconds: beats and keyposes beside it, else its own.

    ``fps`` is the rate of a file that stores none.

    Raises
    ------
    OnbeatError
        If it cannot be read, or has no pulse of its own.
    """
    whole = read_motion(path, fps=fps)
    motion = whole[: max(round(LONGEST * whole.fps), 2)].replace(name=path.stem)
    beside, marks = path.with_suffix(BEATS), path.with_name(path.stem + MARKS)
    beats = read_beats(beside).times if beside.is_file() else motion_beats(motion)
    last = (len(motion) - 1) / motion.fps
    beats = beats[beats <= last]
    if len(beats) < 2:
        raise OnbeatError(f"{path.name}: {len(beats)} beats in its first {last:.1f} s; two or more are needed")
    if marks.is_file():
        keyposes = read_marks(marks)
        return Solo(motion, beats, keyposes[keyposes <= last])
    return Solo(motion, beats, np.asarray(find_keyposes(motion, beats).times))
