"""A live session in one call, and what it would dance to a sound that is there already."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import soxr

from onbeat._shapes import Float32, Times, frozen
from onbeat.errors import OnbeatError
from onbeat.keyposes.own import own_time
from onbeat.live.beat.pulse import Pulse
from onbeat.live.bodies.dancers import Character, Dancer, Machine
from onbeat.live.cast import Cast, Known, following, improvising
from onbeat.live.protocol import RATE, BeatSaid, Pose, Status
from onbeat.live.session import Session
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.motion import Motion
from onbeat.moves.library import MoveLibrary

HEARD = 44_100
"""Samples a second that a session hears."""
NAME = "danced live"
Who = MoveLibrary | Cast | Motion | Sequence[Motion]
"""Who dances: moves to make a dance up from, a cast, or choreographies, whose beats and keyposes are found."""


def live_session(who: Who, *, latency: float = 0.0) -> Session:
    """A session that hears and dances: :meth:`onbeat.live.session.Session.step` takes sound, a hundredth at a time.

    Parameters
    ----------
    who : a library, one or more choreographies, or a cast, which dances in one session only.
    latency : seconds from a sound to the pose that is on it being seen.

    Raises
    ------
    PlanError
        If there is no choreography, or one keeps no pulse.
    BodyError
        If a body's roles are not found.

    Examples
    --------
    >>> from onbeat.examples.troupe import dance_library
    >>> session = live_session(dance_library()[0].motion)
    >>> step = session.step(np.zeros(441, np.float32))
    >>> len(step.poses), session.time
    (40, 0.01)
    """
    cast = who if isinstance(who, Cast) else _cast(who)
    return Session(Pulse(), cast.conductor, cast.dancer, latency, cast.tried)


def _cast(who: MoveLibrary | Motion | Sequence[Motion]) -> Cast:
    if isinstance(who, MoveLibrary):
        return improvising(who)
    motions = [who] if isinstance(who, Motion) else who
    return following([Known(motion, *own_time(motion)) for motion in motions])


@dataclass(frozen=True, eq=False)
class Rehearsed:
    """What a session made of a sound.

    Parameters
    ----------
    motion : as it was danced, as long as the sound.
    beats : (B,) seconds at which beats were said to be.
    said : what it told of itself, twenty times a second.
    """

    motion: Motion
    beats: Times
    said: tuple[Status, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "beats", frozen(self.beats))


def dance_live(samples: Float32, rate: int, who: Who) -> Rehearsed:
    """What a live session dances to a sound, which it hears tick by tick as if it were played now; without a clock.

    Parameters
    ----------
    samples : (N,) or (N, channels) in -1…1.
    rate : samples a second.
    who : as of :func:`live_session`.

    Raises
    ------
    OnbeatError
        If the samples are no sound; else as :func:`live_session`.

    Examples
    --------
    >>> from onbeat.examples import embedded_song
    >>> from onbeat.examples.troupe import dance_library
    >>> song, samples, rate = embedded_song(seconds=5.0)
    >>> danced = dance_live(samples, rate, dance_library()[0].motion)
    >>> danced.motion.duration, len(danced.beats) > 1
    (5.0, True)
    """
    sound = _heard(samples, rate)
    cast = who if isinstance(who, Cast) else _cast(who)
    session = live_session(cast)
    tick = HEARD // RATE
    steps = [session.step(sound[at : at + tick]) for at in range(0, len(sound) - tick + 1, tick)]
    events = [event for step in steps for event in step.events]
    poses = [pose for step in steps for pose in step.poses][: len(steps)]
    beats = [event.time for event in events if isinstance(event, BeatSaid)]
    said = tuple(event for event in events if isinstance(event, Status))
    return Rehearsed(_motion(cast.dancer, poses), np.array(beats, np.float64), said)


def _heard(samples: Float32, rate: int) -> Float32:
    sound = np.asarray(samples, np.float32)
    sound = sound.mean(axis=1) if sound.ndim == 2 and sound.shape[1] else sound
    if sound.ndim != 1 or rate <= 0 or len(sound) * RATE < rate or not np.isfinite(sound).all():
        raise OnbeatError(
            f"samples of shape {np.shape(samples)} at {rate} a second are no sound; (N,) or (N, channels) finite "
            "numbers of a hundredth of a second or more are needed"
        )
    return sound if rate == HEARD else soxr.resample(sound, rate, HEARD)


def _motion(dancer: Dancer, poses: Sequence[Pose]) -> Motion:
    rotations, roots = np.stack([pose.rotations for pose in poses]), np.stack([pose.root for pose in poses])
    if isinstance(dancer, Machine):
        angles = np.stack([pose.angles for pose in poses])
        return hinge_motion(dancer.body, roots, rotations[:, 0], angles, RATE, NAME)
    if not isinstance(dancer, Character):
        raise OnbeatError(f"what a {type(dancer).__name__} does is no motion; a character or a robot is needed")
    return Motion(dancer.skeleton, rotations, roots, RATE, NAME)
