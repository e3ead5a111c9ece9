"""Whether a robot dances on the beat: by how much its poses come later than planned."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot

MET = 0.05
"""Seconds within which a pose of a beat has to be danced for the beat to be met."""
REACH, AROUND = 0.25, 0.15
"""Seconds by which a pose is looked for, and about a beat over which it is compared."""


def lateness(robot: Robot, plan: Motion, done: Motion, beats: Times) -> Array:
    """(B,) seconds by which a robot's poses at beats of a plan come later in what it did; infinite past its end.

    It is the shift at which the hinges about the beat are nearest to the plan.

    Parameters
    ----------
    robot : the model.
    plan, done : motions of it at one rate, from the same moment on.
    beats : (B,) seconds from there.

    Examples
    --------
    >>> from onbeat.motion import rotations as rot
    >>> from onbeat.motion.hinges import hinge_motion
    >>> from onbeat.robots.model import robot_named
    >>> g1, count = robot_named("g1"), 100
    >>> turn = np.sin(np.arange(count) / 50 * 6)[:, None] * np.ones(29) / 9
    >>> plan = hinge_motion(g1.body, np.zeros((count, 3)), np.tile(rot.IDENTITY, (count, 1)), turn, 50)
    >>> lateness(g1, plan, plan.at(plan.times - 0.1), np.array([1.0])).round(6).tolist()
    [0.1]
    """
    meant, danced = (hinge_angles(robot.body, motion) for motion in (plan, done))
    fps, count = plan.fps, min(len(meant), len(danced))
    reach, wide = max(round(REACH * fps), 1), max(round(AROUND * fps), 1)
    out = np.full(len(beats), np.inf)
    for k, beat in enumerate(np.round(beats * fps).astype(np.int64).tolist()):
        around = np.arange(max(beat - wide, 0), min(beat + wide + 1, count))
        if not len(around):
            continue
        costs = [
            float(np.square(danced[np.clip(around + shift, 0, count - 1)] - meant[around]).mean())
            for shift in range(-reach, reach + 1)
        ]
        out[k] = (int(np.argmin(costs)) - reach) / fps
    return out
