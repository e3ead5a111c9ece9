"""A robot that waits for music: it stands with its arms low, and breathes."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.examples.body import Build
from onbeat.live.robot.dance import FPS, RobotDance, prepare
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot

BREATH, BREATHS = 4.0, 3
"""Seconds of a breath, and how many there are before all begins again."""
EARLY = 1
"""Breaths before the first and after the last that are made and not kept: at its ends a solution is not periodic."""
LOW, BENT = 1.25, 0.45
"""Radians by which upper arms hang from the horizontal, and elbows are bent."""
DEPTH = 0.02
"""Radians by which the chest and the arms rise."""


def resting(robot: Robot) -> RobotDance:
    """The robot at ease: it breathes for twelve seconds, at whose end it is as at their beginning.

    Raises
    ------
    BodyError
        If the robot cannot stand, or its limbs are not known.
    """
    made = prepare(_breathing(), robot, np.zeros(0), np.zeros(0))
    kept = slice(round(EARLY * BREATH * FPS), round((EARLY + BREATHS) * BREATH * FPS) + 1)
    return RobotDance(made.motion[kept].replace(name="rest"), made.angles[kept], np.zeros(0), np.zeros(0))


def _breathing() -> Motion:
    """Somebody of the troupe's build who stands and breathes."""
    body = Build(1.7).skeleton
    times = np.arange(round((BREATHS + 2 * EARLY) * BREATH * FPS) + 1) / FPS
    breath = 0.5 - 0.5 * np.cos(2 * np.pi * times / BREATH)
    rotations = np.tile(rot.IDENTITY, (len(times), len(body), 1))
    rotations[:, body.index("Chest")] = _about((1, 0, 0), -DEPTH * breath)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        rotations[:, body.index(f"{side}Arm")] = _about((0, -1, 0), sign * (LOW - DEPTH * breath))
        rotations[:, body.index(f"{side}ForeArm")] = _about((0, 0, -1), sign * np.full(len(times), BENT))
    return Motion(body, rotations, np.zeros((len(times), 3)), FPS, "rest")


def _about(axis: tuple[float, float, float], angles: Array) -> Array:
    return rot.about(np.array(axis, np.float64), angles)
