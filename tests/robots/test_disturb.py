"""Masses, floors and pushes that go wrong, as told and by their seed."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.robots.model import robot_named
from onbeat.robots.simulation import disturb


def model():
    return mujoco.MjModel.from_xml_string(robot_named("g1").mjcf)


def test_all_bodies_get_heavier_together():
    heavy, plain = model(), model()
    disturb.loaded(heavy, 1.1, 0.0, np.random.default_rng(0))
    assert np.allclose(heavy.body_mass, 1.1 * plain.body_mass)
    assert np.allclose(heavy.body_inertia, 1.1 * plain.body_inertia)


def test_a_spread_stays_within_its_part_and_comes_from_the_seed():
    one, same, other, plain = model(), model(), model(), model()
    for each, seed in ((one, 1), (same, 1), (other, 2)):
        disturb.loaded(each, 1.0, 0.1, np.random.default_rng(seed))
    ratio = one.body_mass[1:] / plain.body_mass[1:]
    assert (np.abs(ratio - 1) <= 0.1).all()
    assert np.ptp(ratio) > 0.05
    assert np.array_equal(one.body_mass, same.body_mass)
    assert not np.array_equal(one.body_mass, other.body_mass)


def test_a_push_acts_on_the_trunk_while_it_lasts():
    robot = robot_named("g1")
    data, trunk = mujoco.MjData(robot.model), disturb.trunk_of(robot)
    assert robot.model.body(trunk).name == "torso_link"
    given = [disturb.Push(1.0, (10.0, 0, 0), 0.2), disturb.Push(1.1, (0, 5.0, 0), 0.2)]
    for now, force in ((0.9, (0, 0, 0)), (1.05, (10, 0, 0)), (1.15, (10, 5, 0)), (1.25, (0, 5, 0)), (1.4, (0, 0, 0))):
        disturb.push(data, trunk, given, now)
        assert tuple(data.xfrc_applied[trunk, :3]) == force


def test_pushes_have_the_strength_that_was_asked_for():
    for each in disturb.pushes(5, 40.0, 10.0, np.random.default_rng(0)):
        assert np.linalg.norm(each.force) == pytest.approx(40.0)
        assert 0 <= each.at <= 10


@pytest.mark.parametrize("push", [(np.nan, (0, 0, 0), 0.1), (0, (np.inf, 0, 0), 0.1), (0, (1, 0, 0), 0)])
def test_a_push_that_cannot_be_is_said(push: tuple):
    with pytest.raises(BodyError, match="cannot be"):
        disturb.Push(*push)


@pytest.mark.parametrize("friction", [0, np.nan, np.inf])
def test_a_floor_that_cannot_be_is_said(friction: float):
    with pytest.raises(BodyError, match="friction"):
        disturb.slippery(model(), friction)
