from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.legs import STRAIGHT, bend_leg, hinge_axes, place_foot
from onbeat.motion.skeleton import Skeleton

UPPER = ("chest", "shoulder", "elbow", "wrist")
HINGE = np.array([[-1.0, 0.0, 0.0]])  # to the left of a body that faces +Y


def leg(thigh: float, shin: float, bend: float, swing: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Hip, knee and ankle (1, 3) of a leg bent by ``bend`` radians, turned as a whole by the rotation vector swing."""
    turn = rot.exp(swing)
    knee = np.array([0.0, 0.0, -thigh])
    ankle = knee + rot.rotate(rot.about(HINGE[0], bend), np.array([0.0, 0.0, -shin]))
    hip = np.array([0.3, -0.2, 1.0])
    return hip[None], (hip + rot.rotate(turn, knee))[None], (hip + rot.rotate(turn, ankle))[None]


def solved(hip, knee, ankle, target, hinge):
    turns = bend_leg(hip, knee, ankle, target, hinge)
    new_knee = hip + rot.rotate(turns.thigh, knee - hip)
    return new_knee, new_knee + rot.rotate(turns.shin, ankle - knee)


lengths = st.floats(0.25, 0.6)
vectors = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3).map(np.array)


@settings(max_examples=150, deadline=None)
@given(lengths, lengths, st.floats(0.0, 2.5), vectors, vectors, st.floats(0.05, 0.99))
def test_a_target_within_reach_is_reached_and_the_knee_bends_as_before(thigh, shin, bend, swing, way, part):
    hip, knee, ankle = leg(thigh, shin, bend, swing)
    hinge = rot.rotate(rot.exp(swing), HINGE)
    way = way / np.linalg.norm(way) if np.linalg.norm(way) > 0.1 else np.array([0.0, 0.0, -1.0])
    shortest, longest = 1.03 * abs(thigh - shin) + 0.01, STRAIGHT * (thigh + shin)
    target = hip + way * (shortest + part * (longest - shortest))
    if np.dot((ankle - hip)[0], way) < -0.9 * np.linalg.norm(ankle - hip):
        return  # straight through the hip: which side it swings round is open
    new_knee, new_ankle = solved(hip, knee, ankle, target, hinge)
    assert np.allclose(new_ankle, target, atol=1e-7)
    assert np.isclose(np.linalg.norm(new_knee - hip), thigh)
    assert np.isclose(np.linalg.norm(new_ankle - new_knee), shin)
    swung = rot.rotate(rot.between(ankle - hip, target - hip), hinge)
    assert np.sum(np.cross(new_knee - hip, new_ankle - new_knee) * swung) >= -1e-9


@settings(max_examples=60, deadline=None)
@given(lengths, lengths, st.floats(-0.2, 2.5), vectors)
def test_a_leg_that_is_where_it_should_be_stays(thigh, shin, bend, swing):
    hip, knee, ankle = leg(thigh, shin, bend, swing)
    turns = bend_leg(hip, knee, ankle, ankle, rot.rotate(rot.exp(swing), HINGE))
    for turn in (turns.thigh, turns.shin):
        assert rot.angle_between(turn, rot.IDENTITY).max() < 1e-6


def test_a_target_out_of_reach_is_pointed_at_with_an_unbroken_leg():
    hip, knee, ankle = leg(0.45, 0.4, 0.5, np.zeros(3))
    target = hip + np.array([[0.0, 1.0, -1.0]])
    new_knee, new_ankle = solved(hip, knee, ankle, target, HINGE)
    assert np.isclose(np.linalg.norm(new_ankle - hip), STRAIGHT * 0.85)
    assert np.linalg.norm(np.cross(new_ankle - hip, target - hip)) < 1e-9
    assert np.isclose(np.linalg.norm(new_ankle - new_knee), 0.4)


def test_a_small_move_of_the_target_moves_the_knee_little_even_near_straight():
    hip, knee, ankle = leg(0.45, 0.45, 0.3, np.zeros(3))
    targets = ankle + np.linspace(0, 0.02, 50)[:, None] * np.array([0.3, 0.5, 0.4])
    many = [np.repeat(v, 50, axis=0) for v in (hip, knee, ankle)]
    knees, _ = solved(*many, targets, np.repeat(HINGE, 50, axis=0))
    assert np.linalg.norm(np.diff(knees, axis=0), axis=1).max() < 0.003


@pytest.fixture
def body() -> Body:
    sides = ("left", "right")
    names = [
        "hips",
        "chest",
        *(s + n for s in sides for n in ("arm", "forearm", "wrist", "upleg", "leg", "foot", "toe")),
    ]
    parents = [-1, 0, 1, 2, 3, 0, 5, 6, 7, 1, 9, 10, 0, 12, 13, 14]
    offsets = np.zeros((16, 3))
    for first, x in ((2, -0.2), (9, 0.2)):
        offsets[first : first + 7] = [
            [x, 0, 0.1],
            [x, 0, 0],
            [x, 0, 0],
            [x / 2, 0, -0.05],
            [0, 0.02, -0.42],
            [0, -0.02, -0.4],
            [0, 0.15, -0.04],
        ]
    offsets[1] = [0, 0, 0.4]
    return Body.of(Skeleton(names, parents, offsets))


def test_place_foot_puts_ankle_and_sole_where_asked_and_moves_nothing_else(body):
    rng = np.random.default_rng(0)
    rotations = rot.exp(rng.normal(0, 0.15, (20, 16, 3)))
    roots = np.tile([0.1, 0.2, 0.8], (20, 1))
    world = forward_kinematics(body.skeleton, rotations, roots)
    ankles = world[1][:, body["left_hip"]] + [0.05, 0.1, -0.7] + rng.normal(0, 0.03, (20, 3))
    soles = rot.yaw(rng.normal(0, 0.3, 20))
    out = place_foot(body, "left", rotations, world, ankles, soles)
    turned, placed = forward_kinematics(body.skeleton, out, roots)
    ankle = body["left_ankle"]
    assert np.allclose(placed[:, ankle], ankles, atol=1e-9)
    assert rot.angle_between(turned[:, ankle], soles).max() < 1e-7
    legs = body.indices("left_hip", "left_knee", "left_ankle")
    others = np.setdiff1d(np.arange(16), legs)
    assert np.array_equal(out[:, others], rotations[:, others])


def test_hinge_points_to_the_left_of_the_rest_pose(body):
    world = np.tile(rot.IDENTITY, (1, 16, 1))
    assert np.allclose(hinge_axes(body, "right", world), [[-1, 0, 0]])
