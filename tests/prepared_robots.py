"""The G1 at rest and its made-up dance, prepared once for all tests of live robots."""

from __future__ import annotations

from functools import cache

import numpy as np

from onbeat.live.robot.dance import RobotDance, prepare
from onbeat.live.robot.rest import resting
from onbeat.robots.model import Robot
from robot_dances import made_dance


@cache
def prepared() -> tuple[Robot, RobotDance, RobotDance]:
    """The robot, its rest and its dance."""
    robot, motion = made_dance()
    return robot, resting(robot), prepare(motion, robot, np.arange(0.5, 7.0, 0.5), np.array([1.0, 2.0]))
