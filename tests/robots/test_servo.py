"""Servos: as stiff as asked, within their motors' limits."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.robots.model import robot_named
from onbeat.robots.simulation.servo import Gains, servos

POSE = np.array([0, 0, 0.78, 1, 0, 0, 0, *np.zeros(29)])


def test_a_wrist_swings_at_the_frequency_asked_for():
    robot = robot_named("g1")
    found = servos(robot, POSE, Gains(hz=3), standing=False)
    data, inertia = mujoco.MjData(robot.model), np.zeros((35, 35))
    data.qpos[:] = POSE
    mujoco.mj_forward(robot.model, data)
    mujoco.mj_fullM(robot.model, data, inertia)
    omega = np.sqrt(found.stiffness / np.diag(inertia)[6:])
    assert omega == pytest.approx(2 * np.pi * 3)
    assert found.damping == pytest.approx(2 * found.stiffness / omega)


def test_legs_that_carry_are_stiffer_and_arms_are_not():
    robot = robot_named("g1")
    free, carrying = (servos(robot, POSE, Gains(), standing=standing).stiffness for standing in (False, True))
    ankle = robot.body.names.index("left_ankle_pitch_joint")
    assert carrying[ankle] > 10 * free[ankle]
    assert np.array_equal(carrying[12:], free[12:])
    # Two such ankles hold the robot up as a pendulum.
    assert 2 * carrying[ankle] > robot.mass * 9.81 * 0.7


def test_a_fitted_model_pulls_towards_its_command_within_its_torque():
    robot = robot_named("g1")
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    found = servos(robot, POSE, Gains(), standing=True)
    found.fitted(model)
    data = mujoco.MjData(model)
    data.qpos[:] = POSE
    data.ctrl[:] = found.command(np.full(29, 0.001), np.full(29, 0.01), np.full(29, 0.1))
    mujoco.mj_forward(model, data)
    assert data.actuator_force == pytest.approx(found.stiffness * 0.001 + found.damping * 0.01 + 0.1)
    data.ctrl[:] = found.command(np.full(29, 50.0), np.zeros(29), np.zeros(29))
    mujoco.mj_forward(model, data)
    assert data.actuator_force == pytest.approx(robot.torque)


@pytest.mark.parametrize("wrong", [{"hz": 0.0}, {"ratio": -1.0}, {"standing_hz": np.nan}])
def test_servos_that_cannot_be_are_said(wrong: dict):
    with pytest.raises(BodyError, match="cannot be"):
        Gains(**wrong)
