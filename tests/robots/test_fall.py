"""Standing robots stand, and each way of falling has its name."""

from __future__ import annotations

import mujoco
import numpy as np

from onbeat.robots.model import robot_named
from onbeat.robots.simulation.fall import Ground, fallen

UP, NONE = np.array([0, 0, 1.0]), np.zeros(0, np.bool_)


def test_crouching_is_not_falling_where_it_is_meant():
    assert fallen(np.array([0, 0, 0.35]), UP, np.array([0, 0, 0.4]), UP, NONE) is None
    assert "0.35 m" in str(fallen(np.array([0, 0, 0.35]), UP, np.array([0, 0, 0.75]), UP, NONE))


def test_leaning_is_not_falling_where_it_is_meant():
    lean = np.array([np.sin(1.0), 0, np.cos(1.0)])
    at = np.array([0, 0, 0.7])
    assert fallen(at, lean, at, lean, NONE) is None
    assert "tipped over by 57°" in str(fallen(at, lean, at, UP, NONE))


def test_lying_on_the_floor_is_seen_and_standing_is_not():
    robot = robot_named("g1")
    ground, data = Ground(robot), mujoco.MjData(robot.model)
    data.qpos[2] -= 0.001
    mujoco.mj_forward(robot.model, data)
    assert data.ncon > 0
    assert not ground.touched(data).any()
    data.qpos[2:7] = 0.05, *np.array([1, 0, 1, 0]) / np.sqrt(2)
    mujoco.mj_forward(robot.model, data)
    assert ground.touched(data).any()
    at = np.array([0, 0, 0.7])
    assert fallen(at, UP, at, UP, ground.touched(data)) == "more than its feet was on the floor"
