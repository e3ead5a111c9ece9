"""What ``onbeat observe`` reads: takes of one dance with their beats and speeds, and its keyposes where known."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.cli.keypose_input import MARKS, SOUNDS, BeatFlags, read_dance
from onbeat.errors import MetricError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import DANCES, perform_dance
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.troupe import SPEEDS
from onbeat.formats.read import fitted
from onbeat.keyposes.document import KeyposesDocument
from onbeat.keyposes.marks import LARGEST, read_marks
from onbeat.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.retime.speeds import speeds_from
from onbeat.retime.takes import Take, rhythm_of
from onbeat.retime.upper_body import named_joints, upper_body

TAKES = 5
"""Of the embedded troupe at each speed, as 2007 recorded."""
MERGED = 0.25
"""Beats within which keyposes of several cycles are one."""
EDGE = 0.1
"""Beats by which a keypose may be outside of a repetition and still be at its end."""


@dataclass(frozen=True, eq=False)
class Dance:
    """Takes of a dance.

    Parameters
    ----------
    title : what it is called.
    takes : of it.
    keyposes : (K,) their beats, counted as the takes' are, or None where they are not known.
    cycle : beats after which it repeats, or None where a take is whole.
    """

    title: str
    takes: list[Take]
    keyposes: Array | None
    cycle: int | None = None


def embedded(dance: str = "folk dance", seed: int = 0, takes: int = TAKES, dancer: int = 0) -> Dance:
    """A dancer of the troupe who rehearses a dance so often at each speed: early and late, the capture noisy."""
    out: list[Take] = []
    beats = sum(figure.beats for figure in DANCES[dance])
    keyposes = np.zeros(0)
    for speed in SPEEDS:
        for number in range(takes):
            rng = np.random.default_rng([seed, round(100 * speed), number])
            clip = perform_dance(DANCERS[dancer], dance, speed, 1, rng)
            period = clip.beats[1] - clip.beats[0]
            # The dance begins with its first keypose; the way there from rest is no part of it.
            out.append(Take(rehearse(clip, rng).motion, clip.keyposes[0] + period * np.arange(beats + 1), speed))
            keyposes = (clip.keyposes - clip.keyposes[0]) / period
    return Dance(f"{DANCERS[dancer].name}, {dance}", out, keyposes, beats)


def read_takes(
    paths: Sequence[Path], flags: BeatFlags, speeds: str | None, keyposes: Path | None, told: Callable[[int], None]
) -> Dance:
    """Motion files of one dance, each with its beats.

    Parameters
    ----------
    paths : of the files.
    flags : where the beats come from; without, from NAME.beats or a song beside each motion, else the motion itself.
    speeds : as ``--speeds`` says them, or None to take them from the tempi.
    keyposes : a file of them on the clock of the first motion; without, NAME.keyposes.csv beside that.
    told : which file is read now.
    """
    if len(set(paths)) < len(paths):
        raise MetricError("a motion is given twice; it would count as two takes that are the same")
    read: list[tuple[Motion, Times]] = []
    given = [flags if flags.music or flags.beats else beside(path, flags) for path in paths]
    for number, (path, used) in enumerate(zip(paths, given, strict=True)):
        told(number)
        source, beats, _ = read_dance(path, used)
        motion = source if isinstance(source, Motion) else fitted(source, path).motion
        if len(beats) < 2:
            raise MetricError(f"{path} has {len(beats)} beats; two or more are needed")
        read.append((motion.replace(name=path.name), beats))
    if len(paths) > 1 and not all(used.music or used.beats for used in given):
        print(  # noqa: T201
            "beats of the motions themselves may begin at different places of the dance: write NAME.beats beside each",
            file=sys.stderr,
        )
    tempi = np.array([60.0 / float(np.median(np.diff(beats))) for _, beats in read])
    at = speeds_from(tempi) if speeds is None else given_speeds(speeds, tempi)
    takes = [Take(motion, beats, float(speed)) for (motion, beats), speed in zip(read, at, strict=True)]
    _say(tempi, at)
    marks = keyposes if keyposes is not None else paths[0].with_name(paths[0].stem + MARKS)
    known = keypose_beats(marks, takes[0]) if keyposes is not None or marks.is_file() else None
    return Dance(f"{paths[0].stem} and {len(paths) - 1} more" if len(paths) > 1 else paths[0].stem, takes, known)


def _say(tempi: Array, speeds: Array) -> None:
    for speed in np.unique(speeds).tolist():
        own = tempi[speeds == speed]
        count = f"{len(own)} {'take' if len(own) == 1 else 'takes'}"
        print(f"speed {speed:g}: {count} at {float(np.median(own)):.0f} beats a minute", file=sys.stderr)  # noqa: T201


def beside(path: Path, flags: BeatFlags) -> BeatFlags:
    """The flags with the beats, or else the song, that lie beside a motion, where there are any."""
    beats = path.with_suffix(".beats")
    if beats.is_file():
        return replace(flags, beats=beats)
    song = next((found for ending in SOUNDS if (found := path.with_suffix(ending)).is_file()), None)
    return replace(flags, music=song)


def given_speeds(text: str, tempi: Array) -> Array:
    """Speeds of takes as somebody says them: one for each take, or one for each tempo, slowest first.

    Raises
    ------
    MetricError
        If one is not a number above 0, or there are neither as many as takes nor as many as tempi.

    Examples
    --------
    >>> given_speeds("1,1.3", np.array([100.0, 131.0, 101.0])).tolist()
    [1.0, 1.3, 1.0]
    """
    try:
        speeds = np.array([float(word) for word in text.split(",")])
    except ValueError:
        raise MetricError(f"--speeds {text[:60]}: numbers with commas between are needed, like 1.0,1.2,1.5") from None
    if not (np.isfinite(speeds).all() and (speeds > 0).all()):
        raise MetricError(f"--speeds {text[:60]}: speeds above 0 are needed, 1 for the original")
    if len(speeds) == len(tempi):
        return speeds
    found = speeds_from(tempi)
    groups = np.unique(found)
    if len(speeds) != len(groups):
        raise MetricError(
            f"--speeds {text[:60]}: {len(speeds)} speeds for {len(tempi)} takes of {len(groups)} tempi; give one for "
            "each take, or one for each tempo, slowest first"
        )
    return np.sort(speeds)[np.searchsorted(groups, found)]


def keypose_beats(path: Path, take: Take) -> Array:
    """The beats (K,) of keyposes that a file tells: seconds a line, or ``keyposes.json``; on the clock of a take."""
    last = (len(take.motion) - 1) / take.motion.fps
    if path.suffix.lower() == ".json":
        try:
            if path.stat().st_size > LARGEST:
                raise MetricError(f"{path} has {path.stat().st_size} bytes; give what `onbeat keyposes -o` wrote")
            document = KeyposesDocument.from_json(path.read_bytes(), str(path))
        except OSError as error:
            raise MetricError(f"cannot read {path}: {error.strerror}; give what `onbeat keyposes -o` wrote") from None
        times = np.array([keypose.time for keypose in document.keyposes])
        if not len(times) or not all(math.isfinite(time) and 0 <= time <= last for time in times.tolist()):
            raise MetricError(f"{path} has {len(times)} keyposes, not all from 0 to {last:.2f} s as {take.label} is")
    else:
        times = read_marks(path, last)
    return rhythm_of(take)(times)


def in_repetition(keyposes: Array, first: int, length: float, period: float) -> Array:
    """The keyposes of a repetition, from its first beat; those of several cycles that fall together are one.

    Examples
    --------
    >>> in_repetition(np.array([1.0, 2.5, 9.1, 10.4, 30.0]), 1, 8.0, 8.0).round(2).tolist()
    [0.05, 1.45, 5.0]
    """
    beats = keyposes - first
    if not period:
        return np.clip(beats[(beats >= -EDGE) & (beats <= length + EDGE)], 0.0, length)
    beats = np.sort((beats + MERGED) % period - MERGED)
    groups = np.split(beats, np.flatnonzero(np.diff(beats) > MERGED) + 1)
    return np.array([float(group.mean()) for group in groups]) % period


def chosen_joints(skeleton: Skeleton, text: str | None, drawn: str | None) -> tuple[list[str], str]:
    """The joints that are looked at and the one that is drawn, by names of the skeleton.

    Without ``text`` these are the upper body's, and the left shoulder's where it is among them.
    """
    given = None if text is None else [name.strip() for name in text.split(",") if name.strip()]
    joints = upper_body(skeleton) if given is None else named_joints(skeleton, given)
    if not joints:
        raise MetricError(f"--joints {text}: give names of joints, commas between: {', '.join(skeleton.names[:60])}")
    wanted = named_joints(skeleton, [drawn or "left_shoulder"])[0] if text is None or drawn else joints[0]
    if wanted not in joints and drawn:
        raise MetricError(f"--draw {drawn[:60]} is not among the joints that are looked at: {', '.join(joints[:60])}")
    return joints, wanted if wanted in joints else joints[0]
