"""A made-up dance on the G1: it waves its arms, sways, squats once and steps to the side and back."""

from __future__ import annotations

from functools import cache

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.legs.hips import feet_below, hips_apart
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot, robot_named
from onbeat.robots.state import motion_of

STEPS = ((0, 1.5), (1, 2.3), (1, 3.6), (0, 4.4))
"""Which foot is lifted, from which second on, for 0.4 s: the left to the left, the right after it, and back."""
SQUAT = 5.5
"""Second of the squat's deepest point."""
WAY = 0.06
"""Metres of each step."""
SECONDS = 7.0


def ramp(times: np.ndarray, start: float) -> np.ndarray:
    part = np.clip((times - start) / 0.4, 0, 1)
    return part**2 * (3 - 2 * part)


@cache
def made_dance(fps: float = 60.0, arms: float = 1.0) -> tuple[Robot, Motion]:
    """The robot and its dance; ``arms`` scales how wildly the arms wave."""
    robot = robot_named("g1")
    legs, times = Legs.of(robot), np.arange(round(SECONDS * fps)) / fps
    places, turns = feet_below(legs, hips_apart(legs), 0.0)
    places = np.tile(places, (len(times), 1, 1))
    for n, (side, start) in enumerate(STEPS):
        places[:, side, 1] += (WAY if n < 2 else -WAY) * ramp(times, start)
        places[:, side, 2] += 0.08 * np.sin(np.pi * np.clip((times - start) / 0.4, 0, 1)) ** 2
    qpos = np.zeros((len(times), 7 + len(robot.body.names)))
    qpos[:, 1] = places[:, :, 1].mean(axis=1) + 0.02 * np.sin(2 * np.pi * times)
    qpos[:, 2] = 0.74 - 0.12 * np.exp(-(((times - SQUAT) / 0.35) ** 2))
    qpos[:, 3:7] = rot.yaw(0.1 * np.sin(np.pi * times))
    for name, size in (("left_shoulder_roll_joint", 0.7), ("right_shoulder_pitch_joint", -0.9)):
        where = 7 + robot.body.names.index(name)
        qpos[:, where] = arms * size * np.sin(2 * np.pi * 1.5 * times)
    qpos = legs.standing(qpos, places, np.tile(turns, (len(times), 1, 1)))[0]
    return robot, motion_of(robot, qpos, fps, "made")
