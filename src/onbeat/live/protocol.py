"""What leaves a live session: who dances, poses a hundred times a second, beats, and how things are.

Every mouth (:mod:`onbeat.live.mouths.outputs`) gets these and says them its own way. Times are seconds on the session's
clock, that of the sound: second 0 is the first sample heard. Metres, radians, Z up, quaternions wxyz.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import msgspec
import numpy as np

from onbeat._shapes import Array, Float32

VERSION = 1
RATE = 100
"""Poses a second; a tick is one of them."""

Hearing = Literal["music", "held", "nothing"]
"""Music is heard; the tempo is held through a break; there is none, and the dancer rests."""


@dataclass(frozen=True)
class Who:
    """Who dances, told once to each who listens.

    Parameters
    ----------
    name : of the body.
    kind : "character": joints turn freely, or "robot": they are hinges.
    joints : (J,) names; a pose's rotations are of these.
    parents : (J,) places of their parents, −1 of the root.
    hinges : (n,) names of a robot's hinges; a pose's angles are of these.
    points : (P,) names of the joints whose places a pose tells, for who draws.
    latency : seconds between a sound and the pose that is on it, as far as it is made up for.
    started : when second 0 was, in seconds since 1970 (UTC).
    """

    name: str
    kind: Literal["character", "robot"]
    joints: tuple[str, ...]
    parents: tuple[int, ...]
    hinges: tuple[str, ...]
    points: tuple[str, ...]
    latency: float = 0.0
    started: float = 0.0


@dataclass(frozen=True, eq=False)
class Pose:
    """One pose.

    Parameters
    ----------
    number : of the tick, from 0.
    time : seconds at which it is due: ``number / RATE``.
    root : (3,) metres.
    rotations : (J, 4) of the joints in their parents; of a robot (1, 4), its root's alone.
    angles : (n,) radians of a robot's hinges; none of a character's.
    points : (P, 3) metres.
    """

    number: int
    time: float
    root: Array
    rotations: Array
    angles: Array
    points: Float32


class BeatSaid(msgspec.Struct, frozen=True, tag="beat"):
    """A beat as it is heard: when it is, its place in the bar from 1, how likely it is right, and when it was said."""

    time: float
    position: int
    confidence: float
    said: float


class Status(msgspec.Struct, frozen=True, tag="status"):
    """How things are, twenty times a second.

    ``next_beats`` are those foretold, the first of them at place ``next_position`` of a bar of ``meter`` beats;
    ``tempo`` in beats per minute; 0, and no beats, where nothing is heard. ``level`` are the loudest samples (0…1) of
    each of the last ticks. ``dancing`` is the name of what is danced. ``clock`` is how fast the dance goes now, 1 as it
    was made.
    """

    time: float
    hearing: Hearing
    tempo: float
    confidence: float
    meter: int
    next_position: int
    next_beats: list[float]
    level: list[float]
    dancing: str
    clock: float
    simulated: bool = False


class Note(msgspec.Struct, frozen=True, tag="note"):
    """Something that people should know, said once: the input is lost, it is back, it clips."""

    time: float
    text: str


class Command(msgspec.Struct, frozen=True, tag="command"):
    """What somebody wants: "next" or "play" with the name of what to dance, "rest", "dance", "tap" (a beat, now)."""

    do: Literal["next", "play", "rest", "dance", "tap"]
    value: str = ""


class Clocked(msgspec.Struct, frozen=True, tag="clocked"):
    """A beat, or a part of one, of another machine's clock: ``beat`` counts up, by 1/24 of MIDI clock."""

    time: float
    beat: float


Event = BeatSaid | Status | Note
"""What is said beside poses."""


@dataclass(frozen=True, eq=False)
class Step:
    """What came of one tick of sound: poses that are ready (none, or some in a row), and what is to be said."""

    poses: Sequence[Pose] = ()
    events: Sequence[Event] = field(default_factory=tuple[Event, ...])


def no_angles() -> Array:
    """The angles of who has no hinges."""
    return np.zeros(0)
