import numpy as np
import pytest

from demands import curves, demand, swing
from onbeat.retime.uniform import slow_down


def test_a_dance_inside_its_limits_stays_as_it_is():
    np.testing.assert_allclose(slow_down(demand(swing(), -2, 2, 7.0)).trajectory.samples[:, 0], swing(), atol=1e-9)


def test_all_of_it_is_slower_by_one_factor_and_no_more_than_needed():
    asked = demand(swing(), speed=np.pi)
    samples = slow_down(asked).trajectory.samples[:, 0]
    np.testing.assert_allclose(samples, np.sin(np.pi * np.arange(241) / 60), atol=2e-3)
    assert np.abs(np.diff(samples)).max() * 60 == pytest.approx(np.pi, rel=2e-3)


def test_the_slowest_joint_slows_all():
    both = np.stack((swing(), swing()), axis=1)
    samples = slow_down(demand(both, speed=(np.pi, 100.0))).trajectory.samples
    np.testing.assert_allclose(samples[:, 0], samples[:, 1], atol=1e-12)


def test_positions_are_clipped():
    samples = slow_down(demand(curves(0, 100), -0.1, 0.1, 1.0)).trajectory.samples
    assert np.abs(samples).max() <= 0.1 + 1e-12


def test_it_begins_where_the_dance_begins_whenever_that_is():
    wish = curves(2, 100)
    a, b = (slow_down(demand(wish, speed=0.5, start=start)).trajectory for start in (0.0, 5.0))
    np.testing.assert_allclose(a.samples, b.samples, atol=1e-9)
    np.testing.assert_allclose(a.samples[0], wish[0], atol=1e-9)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_a_few_frames_are_enough(frames: int):
    assert np.isfinite(slow_down(demand(np.linspace(0, 3, frames), speed=1e-6)).trajectory.samples).all()
