"""What a dancer asks of a robot."""

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.robots.ik.directions import APART, TILT, aims_of, flatter
from onbeat.robots.model import robot_named

pytest.importorskip("mujoco")


@pytest.fixture(scope="module")
def aims(swinger):
    return aims_of(swinger, robot_named("g1"), np.array([2.0]))


def test_directions_are_the_dancers_bones(swinger, aims):
    source, target = Body.of(swinger.skeleton), Body.of(robot_named("g1").body.skeleton)
    (upper,) = [t for t in np.flatnonzero(aims.unit > 0) if aims.ends[t] == target["left_elbow"]]
    bone = np.diff(swinger.positions[:, source.indices("left_shoulder", "left_elbow")], axis=1)[:, 0]
    np.testing.assert_allclose(aims.vectors[:, upper], bone / np.linalg.norm(bone, axis=-1, keepdims=True), atol=1e-12)


def test_keyposes_weigh_more_and_only_they(aims):
    assert aims.importance[120] == pytest.approx(3.0)
    assert aims.importance[0] == pytest.approx(1.0)


def test_feet_do_not_cross(aims):
    body = Body.of(robot_named("g1").body.skeleton)
    left, right = (
        aims.vectors[:, int(np.flatnonzero((aims.starts < 0) & (aims.ends == body[f"{side}_ankle"]))[0])]
        for side in ("left", "right")
    )
    hips = np.linalg.norm(np.diff(body.skeleton.rest_positions[body.indices("left_hip", "right_hip")], axis=0))
    assert np.linalg.norm((left - right)[:, :2], axis=-1).min() > 0.95 * APART * hips


def test_feet_on_tiptoe_are_tilted_little():
    pose = rot.multiply(rot.yaw(0.7), rot.about(np.array([1.0, 0, 0]), np.array([0.1, 1.3])))
    found = rot.to_matrix(flatter(pose))
    tilts = np.arccos(found[:, 2, 2])
    assert tilts[0] == pytest.approx(0.1, abs=0.003)
    assert 0.9 * TILT < tilts[1] <= TILT


def test_some_frames_can_be_cut_out(aims):
    part = aims.cut(slice(10, 30, 4))
    assert len(part.vectors) == len(part.turns) == len(part.importance) == 5
    np.testing.assert_array_equal(part.vectors[1], aims.vectors[14])
