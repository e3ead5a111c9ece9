"""Where soles press and how they share a force."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.robots.model import robot_named
from onbeat.robots.simulation.feedback import inset, law_of, loads, pressed
from onbeat.robots.simulation.reference import reference
from onbeat.robots.state import motion_of

SOLES = np.array([[x, y, 0.0] for side in (1, -1) for y in (0.15 * side, 0.1 * side) for x in (0.12, -0.05)])
ALL = np.ones(8, np.bool_)


@pytest.mark.parametrize("seed", range(20))
def test_loads_press_where_they_are_asked_to_and_none_pulls(seed: int):
    rng = np.random.default_rng(seed)
    mix = rng.dirichlet(np.ones(8) * 0.5)
    x, y = mix @ SOLES[:, :2]
    share = loads(SOLES, ALL, x, y)
    assert (share >= 0).all()
    assert share.sum() == pytest.approx(1)
    assert share @ SOLES[:, :2] == pytest.approx([x, y], abs=2e-3)


def test_a_foot_in_the_air_carries_nothing():
    left = np.array([True] * 4 + [False] * 4)
    share = loads(SOLES, left, 0.03, 0.125)
    assert (share[4:] == 0).all()
    assert share @ SOLES[:, :2] == pytest.approx([0.03, 0.125], abs=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_a_point_outside_comes_to_the_nearest_point_of_the_hull(seed: int):
    x, y = np.random.default_rng(seed).uniform(-0.4, 0.4, 2)
    held, px, py = pressed(SOLES, ALL, x, y)
    # The hull of these corners is a rectangle.
    assert (px, py) == pytest.approx((np.clip(x, -0.05, 0.12), np.clip(y, -0.15, 0.15)))
    assert held == (not (-0.05 <= x <= 0.12 and -0.15 <= y <= 0.15))


def test_corners_move_inwards_on_both_sides():
    sole = robot_named("g1").feet["left"].corners[None]
    inner = inset(sole, 0.01)
    assert np.abs(np.ptp(sole[0], axis=0) - np.ptp(inner[0], axis=0)) == pytest.approx([0.02, 0.02, 0], abs=1e-9)


def test_gains_come_from_the_height_alone():
    robot = robot_named("g1")
    qpos = np.array([[0, 0, robot.model.qpos0[2], 1, 0, 0, 0, *np.zeros(29)]])
    told = reference(robot, motion_of(robot, qpos, 60), 500, 0.0)
    law = law_of(robot, told, np.ones(3))
    height = told.centre[0, 2] - told.corners[0, ..., 2].min()
    stiffness, damping = law.centre[0]
    roots = np.roots([1, damping, stiffness])
    assert max(roots.real) == pytest.approx(-np.sqrt(9.81 / height), rel=1e-6)
    assert np.abs(roots.imag).max() == 0
