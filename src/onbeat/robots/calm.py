"""A robot's dance without a capture's trembling.

Above some 8 Hz nothing in a dance is meant: it is the noise of a capture, fractions of a degree, and yet most of what
the zero-moment point does, for accelerations grow with the square of the frequency.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.motion.motion import Motion
from onbeat.robots.gentle import Bounds, gentle
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations, motion_of

INSIDE = 0.002
"""Radians that hinges keep from their limits, for what is between frames."""
ACCELERATION = 80.0
"""rad/s² of a hinge at most."""


def calmed(motion: Motion, robot: Robot, acceleration: float = ACCELERATION) -> Motion:
    """The same motion with every hinge's angle smooth, inside its limits and under an acceleration in rad/s².

    A hinge that swings at 3 Hz keeps 98 % of its swing, one at 4 Hz 92 %, one at 10 Hz 4 %. The root is left as it is.

    Raises
    ------
    BodyError
        If the motion is not the robot's.
    """
    qpos = configurations(robot, motion)
    return motion_of(robot, _calm(robot, qpos, motion.fps, acceleration), motion.fps, motion.name)


def _calm(robot: Robot, qpos: Array, fps: float, acceleration: float) -> Array:
    out, body = qpos.copy(), robot.body
    for n, (low, high, speed) in enumerate(zip(body.low, body.high, body.speed, strict=True)):
        out[:, 7 + n] = gentle(qpos[:, 7 + n], fps, Bounds(low + INSIDE, high - INSIDE, speed, acceleration))
    return np.asarray(out)
