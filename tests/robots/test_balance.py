"""The zero-moment point over the feet."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.robots.balance import BOUND, balanced
from onbeat.robots.legs.contacts import sole_corners, support
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.own import planted, stepping
from onbeat.robots.state import configurations, derivatives
from onbeat.robots.zmp import zmp
from robot_dances import made_dance

ROBOT, WILD = made_dance(arms=1.6)
LEGS = Legs.of(ROBOT)


def margins(motion, standing) -> np.ndarray:
    qpos = configurations(ROBOT, motion)
    return support(LEGS, qpos, standing).margins(zmp(ROBOT, qpos, *derivatives(ROBOT, qpos, motion.fps)))


@pytest.mark.parametrize("make", [planted, stepping])
def test_what_was_outside_is_inside(make):
    danced = make(WILD, ROBOT)
    before, found = margins(danced.motion, danced.standing), balanced(danced.motion, ROBOT, danced.standing)
    after = margins(found.motion, danced.standing)
    assert before.min() < -0.01
    assert after.min() > 0
    np.testing.assert_array_less(found.margin, after + 1e-9)  # its own polygons are no larger


def test_feet_and_upper_body_stay_and_the_shift_is_bounded():
    danced = planted(WILD, ROBOT)
    found = balanced(danced.motion, ROBOT, danced.standing)
    a, b = configurations(ROBOT, danced.motion), configurations(ROBOT, found.motion)
    np.testing.assert_allclose(sole_corners(LEGS, a), sole_corners(LEGS, b), atol=2e-5)
    np.testing.assert_allclose(a[:, 19:], b[:, 19:], atol=1e-9)
    np.testing.assert_allclose(b[:, :2] - a[:, :2], found.shift, atol=1e-9)
    assert 0.001 < np.abs(found.shift).max() <= BOUND
    assert not found.softened.any()


def test_a_dance_in_balance_is_left_alone():
    robot, quiet = made_dance(arms=0.0)
    danced = planted(quiet, robot)
    once = balanced(danced.motion, robot, danced.standing)
    twice = balanced(once.motion, robot, danced.standing)
    assert twice.iterations <= 1
    assert np.abs(twice.shift).max() < 0.01


def test_no_bound_is_broken_even_where_there_is_no_balance():
    danced = planted(WILD, ROBOT)
    found = balanced(danced.motion, ROBOT, danced.standing, bound=0.002, soften=False)
    assert np.abs(found.shift).max() <= 0.002 + 1e-9
    assert found.margin.min() < 0


def test_what_no_shift_can_hold_is_softened_and_told():
    danced = planted(WILD, ROBOT)
    hard = balanced(danced.motion, ROBOT, danced.standing, bound=0.001, soften=False)
    soft = balanced(danced.motion, ROBOT, danced.standing, bound=0.001)
    assert soft.softened.max() > 0.5
    assert np.minimum(soft.margin, 0).sum() > np.minimum(hard.margin, 0).sum()


@pytest.mark.parametrize(("shape", "says"), [((3, 2), "shape"), (None, "no foot stands")])
def test_labels_that_no_foot_can_have_are_told(shape, says: str):
    standing = np.zeros(shape or (len(WILD), 2), np.bool_)
    with pytest.raises(BodyError, match=says):
        balanced(WILD, ROBOT, standing)
