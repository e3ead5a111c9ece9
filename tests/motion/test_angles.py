import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.errors import FormatError
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.angles import ORDERS, euler_angles, from_euler_angles, rotation_vectors
from persons import person, swinging

TOP = Skeleton(("top",), [-1], [[0, 0, 0]])


def spinning(axis, degrees) -> Motion:
    q = rot.about(np.array(axis, float) / np.linalg.norm(axis), np.radians(degrees))[:, None]
    return Motion(TOP, q, np.zeros((len(q), 3)), 30)


@settings(max_examples=30)
@given(st.sampled_from(ORDERS), st.integers(0, 99), st.floats(0.1, 3))
def test_there_and_back(order, seed, angle):
    motion = swinging(person(), 20, 30, seed, angle)
    angles = euler_angles(motion, order)
    again = from_euler_angles(motion.skeleton, angles, motion.root_positions, 30, order)
    assert rot.angle_between(again.rotations, motion.rotations).max() < 1e-9
    assert rot.angle_between(rot.exp(rotation_vectors(motion)), motion.rotations).max() < 1e-9


@pytest.mark.parametrize("order", ORDERS)
def test_angles_run_on_through_the_middle_axis(order):
    axis = np.eye(3)["XYZ".index(order[1])]
    degrees = np.arange(0, 800, 10.0)
    angles = np.degrees(euler_angles(spinning(axis, degrees), order))[:, 0]
    assert np.abs(np.diff(angles, axis=0)).max() < 10 + 1e-6
    np.testing.assert_allclose(angles[:, 1], degrees, atol=1e-6)


def test_vectors_run_on_past_a_half_and_a_whole_turn():
    degrees = np.arange(0, 800, 25.0)
    vectors = np.degrees(rotation_vectors(spinning([1, 2, 2], degrees)))[:, 0]
    np.testing.assert_allclose(vectors @ np.array([1, 2, 2]) / 3, degrees, atol=1e-6)
    back = np.degrees(rotation_vectors(spinning([1, 2, 2], -degrees)))[:, 0]
    np.testing.assert_allclose(back @ np.array([1, 2, 2]) / 3, -degrees, atol=1e-6)


def test_a_whole_turn_exactly_keeps_its_axis():
    vectors = rotation_vectors(spinning([0, 0, 1], np.array([0, 120, 240, 360, 480.0])))
    np.testing.assert_allclose(np.degrees(vectors[:, 0, 2]), [0, 120, 240, 360, 480], atol=1e-6)


def test_an_unknown_order_is_refused():
    with pytest.raises(FormatError, match="'ZXZ' is not one of XYZ"):
        euler_angles(swinging(person(), 2), "ZXZ")
