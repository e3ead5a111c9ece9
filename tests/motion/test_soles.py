"""Feet that do not sink into the floor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat._shapes import Rotations
from onbeat.examples.body import Build
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.soles import DEEPEST, FREE, on_soles, pressed

SKELETON = Build(1.7).skeleton
BODY = Body.of(SKELETON)
FLOOR = -float(SKELETON.rest_positions[:, 2].min())
FEET = ("LeftFoot", "LeftToeBase", "LeftToeEnd", "RightFoot", "RightToeBase", "RightToeEnd")


def posed(**angles: float) -> Rotations:
    """One pose, some joints turned about the axis to the right (radians); those of the toes point them down."""
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (1, len(SKELETON), 1))
    for name, angle in angles.items():
        rotations[0, SKELETON.names.index(name)] = rot.about(np.array([1.0, 0.0, 0.0]), angle)
    return rotations


def heights(rotations: Rotations, height: float) -> dict[str, float]:
    """Where the joints of the feet are above the floor, the hips that much above where they stand."""
    places = forward_kinematics(SKELETON, rotations, np.array([[0.0, 0.0, FLOOR + height]]))[1][0]
    return {name: float(places[SKELETON.names.index(name), 2]) for name in FEET}


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_depths_keep_their_order_and_never_reach_the_deepest(one: float, two: float):
    low, high = sorted((one, two))
    a, b = pressed(np.array([low, high]))
    assert -DEEPEST <= a <= b
    assert a >= low
    assert (a == low) == (low >= -FREE)


def test_depths_are_pressed_without_a_kink():
    near = pressed(-FREE + np.array([-1e-5, 0.0, 1e-5]))
    assert np.diff(near) == pytest.approx([1e-5, 1e-5], rel=2e-3)


def test_poses_above_the_floor_stay_the_same_to_the_bit():
    rotations = posed(LeftLeg=-0.6, LeftUpLeg=0.5)
    assert on_soles(BODY, rotations, np.array([[0.0, 0.0, FLOOR - FREE / 2]])) is rotations


def test_toes_that_point_into_the_floor_are_bent_up_about_their_ball():
    before = posed(LeftToeBase=-0.9)
    after = on_soles(BODY, before, np.array([[0.0, 0.0, FLOOR]]))
    was, now = heights(before, 0.0), heights(after, 0.0)
    assert was["LeftToeEnd"] < -0.04
    assert -DEEPEST <= now["LeftToeEnd"] < -FREE
    assert {name: now[name] for name in FEET if name != "LeftToeEnd"} == pytest.approx(
        {name: was[name] for name in FEET if name != "LeftToeEnd"}
    )
    assert np.flatnonzero((after != before).any(axis=(0, 2))).tolist() == [SKELETON.names.index("LeftToeBase")]


def test_a_foot_that_is_too_deep_as_a_whole_is_lifted_and_its_leg_bends():
    before = posed(LeftUpLeg=0.2, LeftLeg=-0.3, LeftFoot=0.1)
    height = -0.06
    after = on_soles(BODY, before, np.array([[0.0, 0.0, FLOOR + height]]))
    was, now = heights(before, height), heights(after, height)
    assert min(was.values()) < -0.04
    assert min(now.values()) >= -DEEPEST
    turned = [forward_kinematics(SKELETON, pose, np.zeros((1, 3)))[0][0] for pose in (before, after)]
    foot = SKELETON.names.index("LeftFoot")
    assert turned[1][foot] == pytest.approx(turned[0][foot], abs=1e-9)


def test_feet_move_smoothly_through_the_floor():
    turns = np.linspace(0.0, 1.2, 200)
    poses = np.concatenate([posed(LeftToeBase=-angle) for angle in turns])
    roots = np.tile([0.0, 0.0, FLOOR], (200, 1))
    tip = SKELETON.names.index("LeftToeEnd")
    path = forward_kinematics(SKELETON, on_soles(BODY, poses, roots), roots)[1][:, tip]
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    free = np.linalg.norm(np.diff(forward_kinematics(SKELETON, poses, roots)[1][:, tip], axis=0), axis=1)
    assert steps.max() <= 3.0 * free.max()  # towards straight down the foot is lifted instead
    assert np.abs(np.diff(steps)).max() < 0.1 * free.max()


def test_toes_that_pass_straight_down_do_not_flip():
    turns = np.linspace(1.2, 1.95, 400)
    poses = np.concatenate([posed(LeftToeBase=-angle) for angle in turns])
    roots = np.tile([0.0, 0.0, FLOOR], (400, 1))
    out = on_soles(BODY, poses, roots)
    world, places = forward_kinematics(SKELETON, out, roots)
    toes, tip = (SKELETON.names.index(name) for name in ("LeftToeBase", "LeftToeEnd"))
    steps = 2.0 * np.arccos(np.clip(np.abs(np.sum(world[1:, toes] * world[:-1, toes], axis=1)), 0.0, 1.0))
    assert steps.max() < 8.0 * np.diff(turns).max()
    assert places[:, tip, 2].min() >= -DEEPEST


@pytest.mark.parametrize("angle", [-1.35, -1.5707963267948966, -1.8])
def test_toes_that_point_straight_down_come_out_of_the_floor(angle: float):
    pose = posed(LeftToeBase=angle)
    out = on_soles(BODY, pose, np.array([[0.0, 0.0, FLOOR - 0.03]]))
    assert np.linalg.norm(out, axis=-1) == pytest.approx(np.ones(out.shape[:2]))
    assert min(heights(out, -0.03).values()) >= -DEEPEST - 1e-9


def test_toes_without_length_stay_as_they_are():
    offsets = SKELETON.offsets.copy()
    offsets[SKELETON.names.index("LeftToeEnd")] = 0.0
    body = Body.of(Skeleton(SKELETON.names, SKELETON.parents, offsets))
    out = on_soles(body, posed(), np.array([[0.0, 0.0, FLOOR - 0.1]]))
    assert np.linalg.norm(out, axis=-1) == pytest.approx(np.ones(out.shape[:2]))
