"""Whether a dancer stands up: a robot stands all along, whatever the dancer does on the floor."""

from __future__ import annotations

import warnings

import numpy as np

from onbeat._shapes import Array, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames
from onbeat.motion.motion import Motion

LYING = 60.0
"""Degrees from upright from which on a trunk is told of: dancers bow, but seldom so deep and not for long."""
SHARE = 0.05
"""Part of the time for which it has to be, to be told."""


class LyingWarning(UserWarning):
    """A robot is to dance, standing, what somebody dances who does not stand."""


def trunk_tilt(dancer: Motion) -> Array:
    """Degrees (F,) by which a dancer's trunk, from the waist to between the shoulders, is away from upright.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> body = Build(1.7).skeleton
    >>> turns = np.tile(rot.IDENTITY, (2, len(body), 1))
    >>> turns[1, 0] = rot.about(np.array([1.0, 0.0, 0.0]), np.array(np.pi / 2))
    >>> (trunk_tilt(Motion(body, turns, np.zeros((2, 3)), fps=30)) > LYING).tolist()
    [False, True]
    """
    return _tilt(body_frames(dancer)[0])


def root_tilt(robot_dance: Motion) -> Array:
    """Degrees (F,) by which a robot's root is away from how it is where the robot stands."""
    return _tilt(robot_dance.world_rotations[:, 0])


def _tilt(turns: Rotations) -> Array:
    up = rot.rotate(turns, np.array([0.0, 0.0, 1.0]))
    return np.degrees(np.arccos(np.clip(up[:, 2], -1, 1)))


def warn_of_lying(tilt: Array, fps: float) -> None:
    """Warn where the trunk is far from upright for a part of the time: how long, and when it begins.

    Parameters
    ----------
    tilt : (F,) degrees from upright.
    fps : frames a second.
    """
    lying = tilt > LYING
    share = float(lying.mean())
    if share >= SHARE:
        first = int(np.argmax(lying)) / fps
        warnings.warn(
            f"the dancer's trunk is over {LYING:.0f}° from upright {share:.0%} of the time (first at {first:.1f} s): "
            "the robot stands all along, so what is danced lying, on all fours or upside down it does standing",
            LyingWarning,
            stacklevel=3,
        )
