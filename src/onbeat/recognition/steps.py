"""Steps: what a stretch of a dance is cut into at its keyposes, and which step of the dance each piece is.

Nobody has to type times: a dance that is known as a whole (a task, by a person) becomes segments of so many keyposes,
each known by the beat on which it begins, counted from the stretch's first keypose. A keypose that is missed then
costs the segments it is in, and does not shift the names of all that follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from onbeat.keyposes.extract import Keyposes
from onbeat.keyposes.segments import segments

_EDGE = 1e-6  # seconds
_UNUSUAL = 1.25  # times longer or shorter than others of the name: a keypose was missed, or found where none is


class Step(NamedTuple):
    """A piece of a stretch: seconds, the beat it begins on from 1, and the how manieth time of it this is, from 0."""

    start: float
    end: float
    number: int
    repetition: int


def steps(
    found: Keyposes, start: float, end: float, span: int, *, cycle: int | None = None, every: bool = True
) -> list[Step]:
    """The pieces of ``span`` keyposes between two seconds.

    Parameters
    ----------
    found : keyposes of the motion.
    start, end : seconds of the stretch.
    span : from a keypose to the one so many later.
    cycle : beats after which the dance repeats: the same beat of each cycle has one number; None does not count so.
    every : whether a piece begins at every keypose, else each where the one before ends.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> from onbeat.keyposes.extract import find_keyposes
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    >>> cut = steps(find_keyposes(clip.motion, clip.beats), 0, 1e9, 2, cycle=FOLK_DANCE.beats, every=False)
    >>> [(one.number, one.repetition) for one in cut]
    [(1, 0), (3, 0), (6, 0), (9, 0), (1, 1), (3, 1), (6, 1), (9, 1)]
    """
    inside = [p for p in segments(found, span) if p.start >= start - _EDGE and p.end <= end + _EDGE]
    if not every:
        inside = inside[::span]
    made: list[Step] = []
    for part in inside:
        beat = part.first_beat - inside[0].first_beat
        repetition, place = divmod(beat, cycle) if cycle else (0, beat)
        made.append(Step(part.start, part.end, place + 1, repetition))
    return made


def usual(names: Sequence[str], durations: Sequence[float]) -> list[int]:
    """The pieces (their indices) that last about as long as most of their name do; those without a name all stay.

    Examples
    --------
    >>> usual(["bow/1", "bow/1", "bow/1", "", "bow/1"], [2.0, 2.1, 1.9, 9.0, 4.0])
    [0, 1, 2, 3]
    """
    by_name: dict[str, list[float]] = {}
    for name, seconds in zip(names, durations, strict=True):
        by_name.setdefault(name, []).append(seconds)
    middle = {name: float(np.median(seconds)) for name, seconds in by_name.items()}
    return [
        at
        for at, (name, seconds) in enumerate(zip(names, durations, strict=True))
        if not name or middle[name] / _UNUSUAL <= seconds <= middle[name] * _UNUSUAL
    ]
