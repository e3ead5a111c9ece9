"""Legs of a robot's own: planted and stepping."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.motion.contacts import runs
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.legs.contacts import sole_corners
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.own import planted, stepping
from onbeat.robots.model import robot_named
from onbeat.robots.state import configurations
from robot_dances import SQUAT, STEPS, made_dance

ROBOT, DANCE = made_dance()
LEGS = Legs.of(ROBOT)
BEFORE = configurations(ROBOT, DANCE)
OTHERS = np.setdiff1d(np.arange(len(G1.names)), np.concatenate([leg.hinges for leg in LEGS.both]))


def test_planted_feet_lie_flat_and_still_all_the_time():
    danced = planted(DANCE, ROBOT)
    corners = sole_corners(LEGS, configurations(ROBOT, danced.motion))
    assert danced.standing.all()
    assert np.ptp(corners, axis=0).max() < 1e-5
    np.testing.assert_allclose(corners[..., 2], 0, atol=1e-5)


@pytest.mark.parametrize("make", [planted, stepping])
def test_the_upper_body_is_kept_and_the_legs_stay_inside_their_limits(make):
    qpos = configurations(ROBOT, make(DANCE, ROBOT).motion)
    np.testing.assert_allclose(qpos[:, 7 + OTHERS], BEFORE[:, 7 + OTHERS], atol=1e-9)
    assert (qpos[:, 7:] >= ROBOT.body.low - 1e-9).all()
    assert (qpos[:, 7:] <= ROBOT.body.high + 1e-9).all()
    assert (np.abs(np.diff(qpos[:, 7:], axis=0)) * 60 < ROBOT.body.speed).all()


def test_planted_hips_squat_where_the_dancer_does():
    heights = configurations(ROBOT, planted(DANCE, ROBOT).motion)[:, 2]
    assert abs(np.argmin(heights) / 60 - SQUAT) < 0.1
    assert 0.07 < np.median(heights) - heights.min() < 0.14


def test_steps_are_kept_and_standing_feet_do_not_slide():
    danced = stepping(DANCE, ROBOT)
    corners = sole_corners(LEGS, configurations(ROBOT, danced.motion))
    lifted = sorted((first / 60, side) for side in (0, 1) for first, _ in runs(~danced.standing[:, side]))
    assert [side for _, side in lifted] == [side for side, _ in STEPS]
    np.testing.assert_allclose([start for start, _ in lifted], [start for _, start in STEPS], atol=0.12)
    assert danced.standing.any(axis=1).all()
    for side in (0, 1):
        for first, after in runs(danced.standing[:, side]):
            assert np.ptp(corners[first:after, side], axis=0).max() < 1e-5
        for first, after in runs(~danced.standing[:, side]):
            swing = corners[first:after, side, :, 2]
            assert swing.max() > 0.03
            assert np.ptp(swing, axis=1).max() < 1e-5  # flat all the way


def test_another_robot_s_dance_is_refused():
    with pytest.raises(BodyError):
        planted(DANCE, robot_named("hrp4c"))


def test_the_rate_does_not_matter():
    robot, fine = made_dance(120.0)
    a = configurations(ROBOT, planted(DANCE, ROBOT).motion)
    b = configurations(robot, planted(fine, robot).motion)[::2]
    np.testing.assert_allclose(a[30:-30, :3], b[30:-30, :3], atol=4e-3)
