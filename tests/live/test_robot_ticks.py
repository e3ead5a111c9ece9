"""A reference that grows with the poses."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.live.protocol import RATE
from onbeat.live.robot.ticks import AHEAD, EACH, Ticks
from onbeat.robots.state import configurations
from prepared_robots import prepared


def danced(frames: int) -> np.ndarray:
    robot, _, dance = prepared()
    return configurations(robot, dance.motion.resampled(RATE)[:frames])


def test_how_many_poses_come_at_once_does_not_matter():
    robot, _, _ = prepared()
    poses = danced(60)
    found = []
    for lump in (1, 7, 60):
        ticks = Ticks(robot, poses[0], 400)
        ready = sum(ticks.add(poses[k : k + lump]) for k in range(0, 60, lump))
        assert ready == 60 - AHEAD
        found.append([part[-ready * EACH :] for part in ticks.reference])
    for one in found[1:]:
        for part, same in zip(one, found[0], strict=True):
            assert np.array_equal(part, same)


def test_postures_speeds_and_the_floor_are_those_of_the_motion():
    robot, _, _ = prepared()
    poses = np.tile(danced(1), (80, 1))
    times = np.arange(80) / RATE
    poses[:, -1] = 0.3 * np.sin(2 * np.pi * times)
    ticks = Ticks(robot, poses[0], 500)
    ready = ticks.add(poses)
    told = ticks.reference
    at = np.arange(ready * EACH) / (RATE * EACH)
    middle = slice(100, ready * EACH)
    assert told.qpos[-len(at) :, -1][middle] == pytest.approx(0.3 * np.sin(2 * np.pi * at[middle]), abs=1e-4)
    speed = 0.6 * np.pi * np.cos(2 * np.pi * at[middle])
    assert told.qvel[-len(at) :, -1][middle] == pytest.approx(speed, abs=5e-3)
    assert told.force[:200, 2] == pytest.approx(robot.mass * 9.81, rel=1e-9)
    assert told.touching.all()
