"""The legs' inverse kinematics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.robots.legs.ik import STRAIGHTEST, Leg, Legs
from onbeat.robots.model import robot_named
from onbeat.robots.state import motion_of

G1 = robot_named("g1")


def poses(leg: Leg, count: int = 200) -> np.ndarray:
    """Angles of a leg near a bent stand, all inside the limits."""
    spread = np.random.default_rng(1).uniform(-0.25, 0.25, (count, len(leg.low)))
    return np.clip(leg.start + spread, leg.low + 0.01, leg.high - 0.01)


@pytest.mark.parametrize("name", ["g1", "hrp4c", "talos"])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_pose_that_the_leg_reaches_is_found(name: str, side: str):
    leg = Leg.of(robot_named(name), side)
    angles = poses(leg)
    solved = leg.solve(*leg.pose(angles))
    assert solved.away.max() < 1e-8
    np.testing.assert_allclose(solved.angles, angles, atol=1e-6)


@pytest.mark.parametrize("side", ["left", "right"])
def test_forward_kinematics_are_those_of_the_body(side: str):
    leg = Leg.of(G1, side)
    qpos = np.zeros((5, 36))
    qpos[:, 3] = 1
    qpos[:, 7 + leg.hinges] = poses(leg, 5)
    motion = motion_of(G1, qpos, 60)
    ankle = motion.skeleton.names.index(f"{side}_ankle_roll_joint")
    np.testing.assert_allclose(leg.pose(qpos[:, 7 + leg.hinges])[0], motion.positions[:, ankle], atol=1e-5)


def test_what_is_out_of_reach_is_approached_inside_the_limits_and_told():
    leg = Leg.of(G1, "left")
    solved = leg.solve(np.array([[0.0, 0.1, -1.2], [0.0, 0.9, -0.6]]), np.tile(rot.IDENTITY, (2, 1)))
    assert (solved.away > 0.1).all()
    assert (solved.angles >= leg.low).all()
    assert (solved.angles <= leg.high).all()


def test_knees_stay_a_little_bent():
    for leg in Legs.of(G1).both:
        assert leg.low[leg.knee] == STRAIGHTEST


def test_both_feet_stay_where_they_are_told_while_the_root_moves():
    legs = Legs.of(G1)
    qpos = np.zeros((30, 36))
    qpos[:, 2], qpos[:, 3] = 0.72, 1
    for leg in legs.both:
        qpos[:, 7 + leg.hinges] = leg.start
    places, turns = legs.feet(qpos)
    qpos[:, 1] += np.linspace(-0.04, 0.04, 30)
    moved, away = legs.standing(qpos, places, turns)
    assert away.max() < 1e-8
    np.testing.assert_allclose(legs.feet(moved)[0], places, atol=1e-8)
    np.testing.assert_array_equal(moved[:, 19:], qpos[:, 19:])
    assert np.abs(np.diff(moved, axis=0)).max() < 0.02


def test_a_robot_without_that_foot_is_told():
    with pytest.raises(BodyError, match="no left foot"):
        Leg.of(replace(G1, feet={}), "left")


def test_a_foot_with_too_few_hinges_is_told():
    stump = replace(G1.feet["left"], link="left_knee_link")
    with pytest.raises(BodyError, match="hinges lead to left_knee_link"):
        Leg.of(replace(G1, feet={"left": stump}), "left")


def test_hinges_that_both_legs_hang_on_are_told():
    both = replace(
        G1,
        feet=dict.fromkeys(("left", "right"), G1.feet["left"]),
        roles={**G1.roles, "right_knee": G1.roles["left_knee"]},
    )
    with pytest.raises(BodyError, match="left_ankle_roll_joint are between its root, pelvis, and both its legs"):
        Legs.of(both)


def test_a_leg_whose_knee_is_not_known_is_told_with_what_to_do():
    roles = {role: joint for role, joint in G1.roles.items() if role != "left_knee"}
    with pytest.raises(BodyError, match=r'left knee is not known.*g1\.roles\.toml.*left_knee = "left_knee_joint"'):
        Leg.of(replace(G1, roles=roles), "left")
