"""A prepared dance as a curve that can be read at any time: past its ends it comes to rest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.live.robot.dance import RobotDance
from onbeat.motion import rotations as rot
from onbeat.retime.bspline import Spline
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations

PAST = 1.5
"""Seconds before the first frame and behind the last for which there is a curve."""
RESTING = 0.15
"""Seconds in which the speed at an end falls to a third."""


@dataclass(frozen=True, eq=False)
class Path:
    """The configurations of a dance over its own seconds.

    Parameters
    ----------
    dance : what is danced.
    robot : who dances it.
    """

    dance: RobotDance
    robot: Robot

    @cached_property
    def _curve(self) -> Spline:
        fps = self.dance.motion.fps
        qpos = configurations(self.robot, self.dance.motion)
        qpos[:, 3:7] = rot.continuous(qpos[:, 3:7])
        past = np.arange(1, round(PAST * fps) + 1) / fps
        after = _coming_to_rest(qpos[-1], (qpos[-1] - qpos[-2]) * fps, past)
        before = _coming_to_rest(qpos[0], (qpos[0] - qpos[1]) * fps, past)[::-1]
        body = self.robot.body
        for part in (before, after):
            part[:, 7:] = np.clip(part[:, 7:], body.low, body.high)
        return Spline.through(np.concatenate((before, qpos, after)), fps, -len(past) / fps)

    def __call__(self, times: Times) -> Array:
        """(N, 7 + n) configurations at the dance's own seconds (N,); farther out than :data:`PAST` it stands still."""
        curve = self._curve
        out = curve(np.clip(times, curve.knots.start, curve.knots.end))
        out[:, 3:7] = rot.normalise(out[:, 3:7])
        return out


def _coming_to_rest(value: Array, speed: Array, past: Times) -> Array:
    return value + speed * RESTING * -np.expm1(-past / RESTING)[:, None]
