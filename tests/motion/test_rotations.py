import numpy as np
import pytest

from onbeat.motion import rotations as rot

Z90 = np.array([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])


def test_multiply_turns_by_the_right_one_first():
    x90 = rot.about(np.array([1.0, 0, 0]), np.pi / 2)
    both = rot.rotate(rot.multiply(Z90, x90), np.array([0, 1.0, 0]))
    np.testing.assert_allclose(both, [0, 0, 1], atol=1e-12)  # about X: y to z; about Z: z stays


def test_rotate_and_matrix_agree():
    q = rot.normalise(np.random.default_rng(0).normal(size=(7, 4)))
    v = np.array([0.3, -2.0, 0.7])
    np.testing.assert_allclose(rot.rotate(q, v), rot.to_matrix(q) @ v, atol=1e-12)
    assert rot.angle_between(rot.from_matrix(rot.to_matrix(q)), q).max() < 1e-7


def test_normalise_makes_the_identity_of_nothing():
    np.testing.assert_array_equal(rot.normalise(np.array([[0.0, 0, 0, 0], [0, 0, 2, 0]])), [[1, 0, 0, 0], [0, 0, 1, 0]])


def test_continuous_flips_signs_only():
    q = rot.yaw(np.linspace(0, 7, 50))
    signs = np.where(np.random.default_rng(0).random(50) < 0.5, -1.0, 1.0)
    signs[0] = 1
    np.testing.assert_allclose(rot.continuous(q * signs[:, None]), q, atol=1e-12)


def test_slerp_takes_the_shorter_way_at_a_steady_rate():
    half = rot.slerp(rot.IDENTITY, -Z90, 0.5)
    assert rot.angle_between(half, rot.yaw(np.pi / 4)) < 1e-9
    ends = rot.slerp(np.stack((rot.IDENTITY, rot.IDENTITY)), Z90, np.array([0.0, 1.0]))
    assert rot.angle_between(ends, np.stack((rot.IDENTITY, Z90))).max() < 1e-9
    near = rot.slerp(rot.IDENTITY, rot.yaw(1e-9), 0.5)
    assert np.isfinite(near).all()


@pytest.mark.parametrize("b", [[0, 0, 2.0], [0, 3.0, 0], [-1.0, 0, 0], [1.0, 0, 0], [0.2, -0.5, 0.1]])
def test_between_takes_one_direction_to_the_other(b):
    turned = rot.rotate(rot.between(np.array([1.0, 0, 0]), np.array(b)), np.array([1.0, 0, 0]))
    np.testing.assert_allclose(turned, np.array(b) / np.linalg.norm(b), atol=1e-9)


def test_between_of_nothing_is_the_identity():
    np.testing.assert_allclose(rot.between(np.zeros(3), np.array([1.0, 0, 0])), rot.IDENTITY)


def test_about_and_yaw():
    np.testing.assert_allclose(rot.about(np.array([0, 0, 1.0]), 0.7), rot.yaw(0.7))
    assert rot.about(np.eye(3), np.array([0.1, 0.2, 0.3])).shape == (3, 4)


@pytest.mark.parametrize("order", ["XYZ", "ZXY", "YZX", "ZXZ"])
def test_euler_angles_turn_about_moving_axes(order):
    angles = np.array([0.3, 0.5, -0.9])
    by_hand = rot.IDENTITY
    for axis, angle in zip(order, angles, strict=True):
        by_hand = rot.multiply(by_hand, rot.about(np.eye(3)["XYZ".index(axis)], angle))
    assert rot.angle_between(rot.from_euler(order, angles), by_hand) < 1e-9
