"""Shapes as points and capsules."""

from __future__ import annotations

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.robots.description.shapes import bone, box, cloud, cylinder, sphere


def test_capsules_are_about_as_large_as_the_shapes():
    np.testing.assert_allclose(sphere(0.1).capsule, [0, 0, 0, 0, 0, 0, 0.1])
    np.testing.assert_allclose(cylinder(0.05, 0.5).capsule, [0, 0, -0.2, 0, 0, 0.2, 0.05])
    np.testing.assert_allclose(box(np.array([0.04, 0.3, 0.06])).capsule, [0, -0.25, 0, 0, 0.25, 0, 0.05])


def test_a_mesh_that_is_turned_has_a_capsule_that_is_turned():
    turn, at = rot.exp(np.array([0.4, -1, 0.7])), np.array([1.0, 2, 3])
    stick = box(np.array([0.02, 0.03, 0.3])).points
    fitted = cloud(rot.rotate(turn, stick) + at).capsule
    ends = rot.rotate(rot.inverse(turn), fitted[:6].reshape(2, 3) - at)
    np.testing.assert_allclose(np.sort(ends[:, 2]), [-0.275, 0.275], atol=1e-9)
    np.testing.assert_allclose(ends[:, :2], 0, atol=1e-9)
    assert abs(fitted[6] - 0.025) < 1e-9


def test_a_shape_moves_as_a_whole():
    turn, at = rot.about(np.array([0, 0, 1.0]), np.pi / 2), np.array([0.0, 0, 1])
    moved = box(np.array([0.3, 0.05, 0.05])).moved(turn, at)
    np.testing.assert_allclose(moved.capsule, [0, -0.25, 1, 0, 0.25, 1, 0.05], atol=1e-12)
    assert np.ptp(moved.points[:, 1]) > 0.59


def test_a_link_without_a_shape_is_as_thick_as_its_inertia_says():
    radius, mass = 0.05, 3.0
    inertia = np.diag([0.03, 0.03, mass * radius**2 / 2])
    [capsule] = bone(np.array([[0, 0, -0.4]]), mass, np.array([0, 0, -0.2]), inertia)
    np.testing.assert_allclose(capsule, [0, 0, -0.04, 0, 0, -0.36, 0.04], atol=1e-12)
    assert len(bone(np.zeros((0, 3)), mass, np.array([0, 0, -0.2]), inertia)) == 1
