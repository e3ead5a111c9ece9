"""A robot's sensors, and what is made of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.robots.model import robot_named
from onbeat.robots.simulation.estimator import Estimate, Noise, State, Truth, brought_on
from onbeat.robots.simulation.reference import Reference, reference
from onbeat.robots.state import motion_of

RATE = 500.0
NO_NOISE = Noise(0, 0, 0, 0, 1e-9, 200)


@pytest.fixture(scope="module")
def still() -> Reference:
    robot = robot_named("g1")
    qpos = np.array([[0, 0, robot.model.qpos0[2], 1, 0, 0, 0, *np.zeros(29)]])
    return reference(robot, motion_of(robot, qpos, 60), RATE, 10.0)


def body(pitch: float, rate: float, angle: float = 0.0) -> SimpleNamespace:
    """A robot tilted by ``pitch`` that turns with ``rate`` about its y axis, every hinge at ``angle``."""
    turn = rot.about(np.array([0, 1.0, 0]), pitch)
    qpos = np.concatenate((np.zeros(3), turn, np.full(29, angle)))
    return SimpleNamespace(qpos=qpos, qvel=np.concatenate((np.zeros(3), [0, rate, 0], np.zeros(29))), qacc=np.zeros(35))


def tilt(state: State) -> float:
    return float(2 * np.arctan2(state.qpos[5], state.qpos[3]))


def test_turning_is_followed_at_once(still: Reference):
    estimate = Estimate(still, RATE, 0, NO_NOISE, np.random.default_rng(0))
    for tick in range(250):
        state = estimate.state(body(0.4 * (tick + 1) / RATE, 0.4), tick)
    assert tilt(state) == pytest.approx(0.2, abs=0.003)
    assert state.qvel[4] == pytest.approx(0.4, abs=0.01)


def test_a_wrong_tilt_is_forgotten_by_and_by(still: Reference):
    estimate = Estimate(still, RATE, 0, NO_NOISE, np.random.default_rng(0))
    found = [tilt(estimate.state(body(0.1, 0.0), tick)) for tick in range(4500)]
    assert found[50] < 0.01
    assert found[-1] == pytest.approx(0.1, abs=0.02)


def test_the_bias_of_a_gyroscope_does_not_tip_the_estimate(still: Reference):
    noise = Noise(0, 0.02, 0, 0, 1e-9, 200)
    estimate = Estimate(still, RATE, 0, noise, np.random.default_rng(2))
    worst = max(abs(tilt(estimate.state(body(0.0, 0.0), tick))) for tick in range(4500))
    assert worst < 0.06


def test_angles_come_in_steps_and_late(still: Reference):
    estimate = Estimate(still, RATE, 5, Noise(0, 0, 0, 0, 0.01, 200), np.random.default_rng(0))
    seen = [estimate.state(body(0, 0, 0.0143 if tick >= 10 else 0.0), tick).qpos[7] for tick in range(20)]
    assert seen[14] == pytest.approx(0.0)
    assert seen[15] == pytest.approx(0.01)


def test_the_truth_is_late_by_as_many_ticks_as_told(still: Reference):
    truth = Truth(still, 3)
    seen = [truth.state(body(0, 0, float(tick)), tick).qpos[7] for tick in range(10)]
    assert seen[9] == 6


def test_a_late_state_moves_on_as_the_dance_does(still: Reference):
    told = still._replace(qpos=still.qpos.copy(), qvel=still.qvel.copy())
    told.qpos[1, 3:7] = rot.about(np.array([0, 0, 1.0]), 0.3)
    told.qvel[1, 6] = 2.0
    state = brought_on(State(told.qpos[0] + 0.0, told.qvel[0] + 0.5), told, 0, 1)
    assert state.qpos[3:7] == pytest.approx(told.qpos[1, 3:7])
    assert state.qvel[6] == pytest.approx(2.5)


@pytest.mark.parametrize("wrong", [{"gyro": -1.0}, {"step": np.nan}, {"smoothing": 0.0}])
def test_sensors_that_cannot_be_are_said(wrong: dict):
    with pytest.raises(BodyError):
        Noise(**wrong)
