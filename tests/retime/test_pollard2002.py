import numpy as np
import pytest

from demands import curves, demand, swing
from onbeat.retime.measures import measure
from onbeat.retime.pollard2002 import follow, scaled_into_range


def test_a_slow_dance_is_followed():
    asked = demand(swing(8, hertz=0.3), speed=10.0)
    assert float(measure(asked, follow(asked).trajectory).rms[0]) < 0.01


@pytest.mark.parametrize("stiffness", [50.0, 800.0])
def test_it_is_the_equation_as_written_forward_and_backward(stiffness: float):
    asked = demand(curves(1, 40), speed=2.0)
    wanted, step = asked.wish.samples[:, 0], 1 / 60

    def way(theta: np.ndarray) -> np.ndarray:
        rates, place = np.gradient(theta, step), theta[0]
        v, out = np.clip(rates[0], -2, 2), []
        for k in range(len(theta)):
            out.append(place)
            damping = min(2 * stiffness**0.5 * step, 1)
            v = np.clip(v + damping * (rates[k] - v) + step * stiffness * (theta[k] - place), -2, 2)
            place = place + step * v
        return np.array(out)

    mean = (way(wanted) + way(wanted[::-1])[::-1]) / 2
    np.testing.assert_allclose(follow(asked, stiffness=stiffness).trajectory.samples[:, 0], mean, atol=1e-12)


def test_steps_are_no_faster_than_allowed():
    asked = demand(curves(2, 300, 2), speed=(1.0, 2.0))
    steps = np.abs(np.diff(follow(asked).trajectory.samples, axis=0)) * 60
    assert (steps <= np.array([1.0, 2.0]) + 1e-9).all()
    assert (steps > 0.99 * np.array([1.0, 2.0])).any(axis=0).all()


def test_it_does_not_lag():
    asked = demand(swing(8), speed=4.0)
    found = follow(asked).trajectory.samples[60:-60, 0]
    late = [np.square(found - np.roll(swing(8), lag)[60:-60]).sum() for lag in range(-6, 7)]
    assert int(np.argmin(late)) == 6


def test_backward_in_time_it_is_the_same():
    wish = curves(4, 200)
    a, b = (follow(demand(w, speed=2.0)).trajectory.samples for w in (wish, wish[::-1]))
    np.testing.assert_allclose(a, b[::-1], atol=1e-9)


def test_what_is_too_wide_is_shrunk_and_what_is_outside_is_shifted():
    values = np.stack((np.linspace(0, 4, 9), np.linspace(5, 6, 9), np.linspace(-0.5, 0.5, 9)), axis=1)
    out = scaled_into_range(values, np.full(3, -1.0), np.full(3, 1.0))
    assert out.min(axis=0).tolist() == pytest.approx([-1, 0, -0.5])
    assert out.max(axis=0).tolist() == pytest.approx([1, 1, 0.5])


def test_without_bounds_or_extent_nothing_is_scaled():
    values = np.array([[3.0, 1.0], [3.0, -1.0]])
    free = np.full(2, np.inf)
    np.testing.assert_array_equal(scaled_into_range(values, -free, free), values)
    np.testing.assert_array_equal(scaled_into_range(values, np.full(2, 2.0), free)[:, 0], [3, 3])
    np.testing.assert_array_equal(scaled_into_range(values, np.zeros(2), np.zeros(2)), np.zeros((2, 2)))


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_a_few_frames_are_enough(frames: int):
    asked = demand(np.linspace(0, 3, frames), -1.0, 1.0, 2.0)
    assert np.isfinite(follow(asked).trajectory.samples).all()
