import numpy as np
import pytest

from onbeat.limits.turning import RATE, angular_velocities, lasting_speeds, without_glitches
from onbeat.motion import rotations as rot

Z = np.array([0, 0, 1.0])


def swing(fps: float, hertz: float = 2.0, seconds: float = 4.0, amplitude: float = 0.8) -> np.ndarray:
    """A joint that swings about z, and one that swings half as far about a slanted axis; (F, 2, 4)."""
    times = np.arange(int(seconds * fps) + 1) / fps
    angle = amplitude * np.sin(2 * np.pi * hertz * times)
    return np.stack((rot.about(Z, angle), rot.about(np.array([0.6, 0.8, 0]), angle / 2)), axis=1)


def fastest(q: np.ndarray, fps: float) -> np.ndarray:
    return np.linalg.norm(angular_velocities(q, fps), axis=-1).max(axis=0)


PEAK = 0.8 * 2 * np.pi * 2


@pytest.mark.parametrize("fps", [30, 59.94, 120, 200])
def test_a_swings_peak_at_any_rate(fps: float):
    np.testing.assert_allclose(fastest(swing(fps), fps), [PEAK, PEAK / 2], rtol=0.015)


@pytest.mark.parametrize("hertz", [1, 3, 4])
def test_fast_swings_are_not_taken_for_glitches(hertz: float):
    expected = 0.8 * 2 * np.pi * hertz
    assert fastest(swing(30, hertz), 30)[0] == pytest.approx(expected, rel=0.1)
    assert fastest(swing(120, hertz), 120)[0] == pytest.approx(expected, rel=0.01)


def test_velocities_have_their_direction_and_time():
    q = swing(60)
    velocity = angular_velocities(q, 60)
    times = np.arange(len(velocity)) / RATE
    inner = slice(12, -12)
    expected = PEAK * np.cos(2 * np.pi * 2 * times)
    np.testing.assert_allclose(velocity[inner, 0], (expected[:, None] * Z)[inner], atol=0.02 * PEAK)
    np.testing.assert_allclose(velocity[inner, 1], (expected[:, None] / 2 * [0.6, 0.8, 0])[inner], atol=0.02 * PEAK)


def test_signs_of_quaternions_do_not_matter():
    q = swing(60)
    flipped = q * np.where(np.arange(len(q)) % 3 == 0, -1.0, 1.0)[:, None, None]
    np.testing.assert_allclose(angular_velocities(flipped, 60), angular_velocities(q, 60), atol=1e-12)


def test_turning_past_half_a_turn_is_steady():
    q = rot.about(Z, np.arange(240) / 60 * 3)[:, None]
    np.testing.assert_allclose(np.linalg.norm(angular_velocities(q, 60), axis=-1), 3, rtol=1e-6)


@pytest.mark.parametrize("fps", [30, 60, 120])
@pytest.mark.parametrize("at", [[40], [40, 90, 100]])
def test_single_bad_frames_do_not_count(fps: float, at: list[int]):
    q = swing(fps)
    q[at] = rot.multiply(q[at], rot.about(np.array([1.0, 0, 0]), 0.9))
    np.testing.assert_allclose(fastest(q, fps), [PEAK, PEAK / 2], rtol=0.02)


@pytest.mark.parametrize("fps", [24, 30, 60, 120])
def test_a_jump_does_not_count(fps: float):
    q = swing(fps, hertz=0.5)
    q[50:] = rot.multiply(q[50:], rot.about(np.array([1.0, 0, 0]), 1.2))
    assert (fastest(q, fps) < 1.6 * PEAK / 4).all()


def test_a_good_frame_stays_as_it_is():
    q = swing(30, hertz=3)
    np.testing.assert_array_equal(without_glitches(q), q)


def test_a_bad_frame_is_put_right_and_no_other():
    q = swing(60)
    bad = q.copy()
    bad[70, 1] = rot.multiply(bad[70, 1], rot.about(Z, 0.5))
    put = without_glitches(bad)
    assert rot.angle_between(put[70, 1], q[70, 1]) < 0.01
    bad[70, 1] = put[70, 1]
    np.testing.assert_array_equal(put, bad)


@pytest.mark.parametrize("frames", [2, 3, 4, 6, 7])
def test_a_few_frames_are_enough(frames: int):
    q = rot.about(Z, np.arange(frames) / 30 * 2)[:, None]
    velocity = angular_velocities(q, 30)
    assert velocity.shape == (4 * (frames - 1) + 1, 1, 3)
    np.testing.assert_allclose(velocity[..., 2], 2, rtol=1e-3)


def test_a_speed_that_lasts_is_kept():
    q = rot.about(Z, np.clip(np.arange(60) / RATE - 0.1, 0, 0.2) * 10)[:, None]
    assert lasting_speeds(q, RATE).max() == pytest.approx(10)
