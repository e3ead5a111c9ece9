"""Dances that are prepared for a robot, and its rest."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.live.robot.dance import STANCE, prepare
from onbeat.motion.hinges import hinge_angles
from onbeat.robots.legs.ik import Legs
from onbeat.robots.state import configurations
from prepared_robots import prepared


def test_feet_are_in_the_one_stance_all_the_time():
    robot, rest, dance = prepared()
    places, turns = STANCE.feet(Legs.of(robot))
    for one in (rest, dance):
        found, turned = Legs.of(robot).feet(configurations(robot, one.motion))
        assert np.abs(found - places).max() < 1e-4
        assert (1 - np.abs(np.sum(turned * turns, axis=-1))).max() < 1e-6


def test_it_goes_at_its_own_tempo_and_faces_forward():
    robot, _, dance = prepared()
    assert dance.duration == pytest.approx(7.0, abs=0.05)
    assert dance.beats == pytest.approx(np.arange(0.5, 7.0, 0.5))
    assert np.array_equal(dance.angles, hinge_angles(robot.body, dance.motion))
    qpos = configurations(robot, dance.motion)
    assert np.median(qpos[:, 3]) == pytest.approx(np.cos(np.pi / 4), abs=0.05)
    assert np.abs(qpos[:, :2]).max() < 0.15


def test_one_that_is_too_short_is_refused():
    robot, _, dance = prepared()
    with pytest.raises(PlanError, match="too short"):
        prepare(dance.motion[:30], robot, np.zeros(0), np.zeros(0))


def test_rest_begins_again_where_it_ends_and_moves_but_little():
    robot, rest, _ = prepared()
    assert rest.duration == pytest.approx(12.0)
    assert rest.angles[-1] == pytest.approx(rest.angles[0], abs=1e-6)
    assert 0.005 < np.ptp(rest.angles, axis=0).max() < 0.1
    joints = rest.motion.positions[0]
    names = rest.motion.skeleton.names
    height = joints[names.index(robot.roles["chest"]), 2]
    assert all(joints[names.index(robot.roles[f"{side}_hand"]), 2] < height for side in ("left", "right"))
