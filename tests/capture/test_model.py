from __future__ import annotations

import numpy as np
import pytest

from onbeat.capture.body import template
from onbeat.capture.model import Model, Pose
from onbeat.capture.sites import SITES
from onbeat.motion import rotations as rot


@pytest.fixture
def model() -> Model:
    skeleton = template().skeleton
    sites = [site for name, site in SITES.items() if name.startswith("left_") or name in ("c7", "sacrum", "head_top")]
    segments, anchors = ([skeleton.index(getattr(s, part)) for s in sites] for part in ("segment", "anchor"))
    return Model(skeleton, np.array(segments), np.array(anchors), np.array([site.place for site in sites]))


@pytest.fixture
def pose(model: Model) -> Pose:
    rng = np.random.default_rng(1)
    rotations = rot.exp(rng.normal(scale=0.5, size=(3, len(model.skeleton), 3)))
    rotations[:, model.skeleton.end_sites] = rot.IDENTITY
    return Pose(rotations, rng.normal(size=(3, 3)))


def test_the_jacobian_is_the_markers_change(model: Model, pose: Pose):
    placed = model.placed(pose)
    jacobian, step = model.jacobian(placed), 1e-6
    for column in range(jacobian.shape[2]):
        move = np.zeros((3, jacobian.shape[2]))
        move[:, column] = step
        there = model.placed(model.turned(pose, placed, move)).markers
        back = model.placed(model.turned(pose, placed, -move)).markers
        change = (there - back).reshape(3, -1) / (2 * step)
        assert np.allclose(change, jacobian[:, :, column], atol=1e-7), column


def test_the_gradient_of_habits_is_their_change(model: Model, pose: Pose):
    placed, step = model.placed(pose), 1e-6
    rest = np.tile(rot.IDENTITY, (3, len(model.skeleton), 1))
    reference = Pose(rest, np.zeros((3, 3)))
    gradient = model.habits(pose, placed, reference)[1]
    for column in range(gradient.shape[1]):
        move = np.zeros_like(gradient)
        move[:, column] = step
        costs = []
        for sign in (1, -1):
            there = model.turned(pose, placed, sign * move)
            costs.append(model.habits(there, model.placed(there), reference)[0])
        assert np.allclose((costs[0] - costs[1]) / (2 * step), gradient[:, column], rtol=1e-4, atol=1e-3), column


def test_a_knee_or_elbow_that_bends_backwards_costs(model: Model):
    rest = np.tile(rot.IDENTITY, (1, len(model.skeleton), 1))
    reference = Pose(rest, np.zeros((1, 3)))
    for joint, axis in (("LeftLeg", [1.0, 0, 0]), ("RightForeArm", [0, 0, -1.0]), ("LeftForeArm", [0, 0, 1.0])):
        costs = []
        for sign in (1, -1):
            rotations = rest.copy()
            rotations[:, model.skeleton.index(joint)] = rot.about(np.array(axis), sign * 0.5)
            pose = Pose(rotations, np.zeros((1, 3)))
            costs.append(float(model.habits(pose, model.placed(pose), reference)[0][0]))
        assert costs[0] > 5 * costs[1], joint
