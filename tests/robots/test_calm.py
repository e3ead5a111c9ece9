"""A capture's trembling."""

from __future__ import annotations

import numpy as np

from onbeat.robots.calm import ACCELERATION, calmed
from onbeat.robots.state import configurations, motion_of
from robot_dances import made_dance


def test_trembling_goes_and_the_dance_stays():
    robot, dance = made_dance(arms=0.5)
    qpos = configurations(robot, dance)
    shaken = qpos.copy()
    shaken[:, 7:] += np.random.default_rng(2).normal(0, 0.004, shaken[:, 7:].shape)
    calm = configurations(robot, calmed(motion_of(robot, shaken, 60), robot))
    away, shake = np.abs(calm - qpos)[20:-20, 19:], np.abs(shaken - qpos)[20:-20, 19:]
    assert away.mean() < shake.mean()
    still = 19 + np.flatnonzero(np.ptp(qpos[:, 19:], axis=0) == 0)
    assert np.diff(calm[:, still], 2, axis=0).std() < 0.1 * np.diff(shaken[:, still], 2, axis=0).std()


def test_limits_are_kept():
    robot, dance = made_dance()
    qpos = configurations(robot, dance).copy()
    qpos[:, 7:] = np.clip(qpos[:, 7:] * 4, robot.body.low - 0.3, robot.body.high + 0.3)
    calm = configurations(robot, calmed(motion_of(robot, qpos, 60), robot))[:, 7:]
    assert (calm >= robot.body.low).all()
    assert (calm <= robot.body.high).all()
    assert (np.abs(np.diff(calm, axis=0)) * 60 <= robot.body.speed + 1e-3).all()
    assert np.abs(np.diff(calm, 2, axis=0)).max() * 3600 <= ACCELERATION * 1.001
