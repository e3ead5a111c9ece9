import numpy as np
import pytest

from demands import curves, demand, swing
from onbeat.retime.clamp import clamp


def test_a_dance_inside_its_limits_stays_as_it_is():
    np.testing.assert_allclose(clamp(demand(swing(), -2, 2, 7.0)).trajectory.samples[:, 0], swing(), atol=1e-9)


def test_positions_are_clipped():
    samples = clamp(demand(swing(), -0.4, 0.7)).trajectory.samples[:, 0]
    np.testing.assert_allclose(samples, np.clip(swing(), -0.4, 0.7), atol=1e-9)


def test_steps_are_no_larger_than_allowed():
    samples = clamp(demand(curves(0, 300, 2), speed=(1.0, 2.0))).trajectory.samples
    steps = np.abs(np.diff(samples, axis=0)) * 60
    assert (steps <= np.array([1.0, 2.0]) + 1e-9).all()
    np.testing.assert_allclose(steps.max(axis=0), [1.0, 2.0], rtol=1e-6)


def test_a_jump_becomes_a_slope_with_its_middle_where_the_jump_was():
    jump = np.where(np.arange(121) < 60, -1.0, 1.0)
    samples = clamp(demand(jump, speed=2.0)).trajectory.samples[:, 0]
    assert np.interp(0, samples, np.arange(121)) == pytest.approx(59.5, abs=0.1)
    assert samples[0] == pytest.approx(-1.0)
    assert samples[-1] == pytest.approx(1.0)


def test_forward_and_backward_in_time_are_the_same():
    wish = curves(1, 200)
    a, b = (clamp(demand(w, speed=1.5)).trajectory.samples for w in (wish, wish[::-1]))
    np.testing.assert_allclose(a, b[::-1], atol=1e-9)


def test_forward_and_backward_are_the_same_with_a_speed_that_changes():
    wish, speed = curves(1, 200), np.random.default_rng(0).uniform(0.5, 3, (201, 1))
    a, b = (clamp(demand(w, speed=s)).trajectory.samples for w, s in ((wish, speed), (wish[::-1], speed[::-1])))
    np.testing.assert_allclose(a, b[::-1], atol=1e-9)


def test_a_speed_that_changes_is_kept_at_its_own_time():
    speed = np.where(np.arange(242) < 121, 0.5, 2.0)[:, None]
    steps = np.abs(np.diff(clamp(demand(swing(), speed=speed)).trajectory.samples[:, 0])) * 60
    assert steps[:115].max() <= 0.5 + 1e-9
    assert steps[125:].max() == pytest.approx(2.0)


@pytest.mark.parametrize("frames", [1, 2, 3, 4])
def test_a_few_frames_are_enough(frames: int):
    samples = clamp(demand(np.linspace(0, 3, frames), -1.0, 1.0, 2.0)).trajectory.samples
    assert len(samples) == max(frames, 2)
    assert np.abs(samples).max() <= 1
    assert np.abs(np.diff(samples, axis=0)).max() <= 2 / 60 + 1e-9
