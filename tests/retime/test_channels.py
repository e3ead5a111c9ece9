from itertools import pairwise

import numpy as np
import pytest

from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.retime.channels import Turning, unwrapped

Z = np.array([0.0, 0, 1])
SLANT = np.array([0.48, 0.6, 0.64])


def motion(rotations: np.ndarray, fps: float = 60.0) -> Motion:
    """A chain of joints, each with one column of rotations (F, J, 4)."""
    joints = rotations.shape[1]
    skeleton = Skeleton([f"j{k}" for k in range(joints)], range(-1, joints - 1), np.tile(Z, (joints, 1)))
    return Motion(skeleton, rotations, np.zeros((len(rotations), 3)), fps)


def wander(seed: int, frames: int = 300, joints: int = 4, size: float = 1.0) -> np.ndarray:
    """Smooth rotations (F, J, 4) in all directions."""
    rng = np.random.default_rng(seed)
    times = np.arange(frames)[:, None, None] / 60
    waves = [s * np.sin(h * times + p) for s, h, p in rng.uniform(0.5, 2, (3, 3, joints, 3))]
    return rot.multiply(rot.about(SLANT, rng.uniform(-3, 3, joints)), rot.exp(size * sum(waves) / 3))


def apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(rot.angle_between(a, b).max(initial=0.0))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("size", [0.3, 1.0, 2.5])
def test_the_rotations_come_back(seed: int, size: float):
    dance = motion(wander(seed, size=size))
    turning = Turning.of(dance, range(4))
    assert turning.vectors.shape == (300, 4, 3)
    assert apart(turning.rotations(turning.vectors), dance.rotations) < 1e-7


def test_signs_of_quaternions_do_not_matter():
    q = wander(5)
    flipped = q * np.where(np.random.default_rng(0).random((300, 4, 1)) < 0.5, -1.0, 1.0)
    a, b = Turning.of(motion(q), range(4)), Turning.of(motion(flipped), range(4))
    back = b.rotations(a.vectors)
    assert apart(back, q) < 1e-7
    np.testing.assert_allclose(a.vectors, b.vectors, atol=1e-9)


@pytest.mark.parametrize("turns", [0.4, 1.0, 3.0, -2.5])
@pytest.mark.parametrize("frames", [40, 41, 200])
def test_a_joint_that_spins_goes_on_through_all_turns(turns: float, frames: int):
    angle = np.linspace(0, 2 * np.pi * turns, frames)
    turning = Turning.of(motion(rot.about(SLANT, angle)[:, None]), [0])
    along = turning.vectors[:, 0] @ SLANT
    np.testing.assert_allclose(along - along[0], angle, atol=1e-7)
    np.testing.assert_allclose(np.cross(turning.vectors[:, 0], SLANT), 0, atol=1e-6)


def test_a_frame_that_is_exactly_a_whole_turn_is_not_none():
    """Its logarithm is 0 and has no axis: the vector must not fall back to 0."""
    angle = np.linspace(0, 4 * np.pi, 33)
    vectors = rot.log(rot.about(Z, angle))
    assert np.linalg.norm(vectors[16]) < 1e-9
    np.testing.assert_allclose(unwrapped(vectors)[:, 2], angle, atol=1e-9)


def test_there_and_back_through_half_a_turn_ends_where_it_began():
    angle = 3.0 + 1.0 * np.sin(np.linspace(0, 2 * np.pi, 101))
    vectors = unwrapped(rot.log(rot.about(SLANT, angle)))
    np.testing.assert_allclose(vectors @ SLANT, angle, atol=1e-9)


def test_a_fast_jump_through_half_a_turn_is_gone_the_short_way():
    """At a low rate no vector need ever be near π before it is past it."""
    angle = np.array([-1.2, 0.0, 1.2, 2.4, 3.6, 4.8, 3.6, 2.4, 1.2, 0.0, -1.2])
    turning = Turning.of(motion(rot.about(Z, angle)[:, None], 8.0), [0])
    assert np.abs(np.diff(turning.vectors[:, 0, 2])).max() < 1.21


def test_every_vector_is_the_nearest_of_its_rotation():
    vectors = unwrapped(rot.log(wander(3, size=2.5)[:, 0]))
    for last, now in pairwise(vectors):
        axis = now / np.linalg.norm(now)
        others = [now + 2 * np.pi * k * axis for k in (-2, -1, 1, 2)]
        assert all(np.linalg.norm(now - last) <= np.linalg.norm(other - last) + 1e-9 for other in others)


def test_one_joint_that_spins_changes_no_other():
    q = wander(1, size=0.8)
    spun = np.concatenate((q, rot.about(Z, np.linspace(0, 20, 300))[:, None]), axis=1)
    a, b = Turning.of(motion(q), range(4)).vectors, Turning.of(motion(spun), range(5)).vectors
    np.testing.assert_array_equal(a, b[:, :4])


def test_about_the_mean_vectors_are_small_and_sum_to_little():
    vectors = Turning.of(motion(wander(2, size=0.5)), range(4)).vectors
    assert np.linalg.norm(vectors, axis=-1).max() < 1.2
    assert np.abs(vectors.mean(axis=0)).max() < 0.05


def test_the_order_of_joints_is_that_asked_for():
    dance = motion(wander(4))
    a, b = Turning.of(dance, [0, 1, 2, 3]), Turning.of(dance, [2, 0])
    np.testing.assert_allclose(b.vectors, a.vectors[:, [2, 0]], atol=1e-12)


def test_a_vectors_speed_is_no_less_than_the_joints():
    """So that bounds on vectors bound joints: the Jacobian of the exponential map never lengthens."""
    rng = np.random.default_rng(0)
    vectors, steps = 3 * rng.normal(size=(2000, 3)), 1e-5 * rng.normal(size=(2000, 3))
    turned = rot.angle_between(rot.exp(vectors), rot.exp(vectors + steps))
    assert (turned <= np.linalg.norm(steps, axis=1) * (1 + 1e-3) + 1e-7).all()


@pytest.mark.parametrize("frames", [1, 2])
def test_a_frame_or_two_are_enough(frames: int):
    q = wander(0, frames)
    turning = Turning.of(motion(q), range(4))
    assert apart(turning.rotations(turning.vectors), q) < 1e-7


def test_no_joints_are_no_vectors():
    assert Turning.of(motion(wander(0)), []).vectors.shape == (300, 0, 3)
