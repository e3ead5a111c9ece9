"""Plans a few seconds ahead: limits are kept whatever is wished, and wishes are met where they can be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.retime.bspline import Spline
from onbeat.retime.horizon import Horizon

FREE = np.array([np.inf])


def danced(horizon: Horizon, wish, blocks: int, changed: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities, a thousand a second, of some blocks of a tenth of a second."""
    places, speeds = [], []
    for _ in range(blocks):
        horizon.plan(wish, changed=changed)
        times = horizon.knots.start + np.arange(100) / 1000
        curve = Spline(horizon.knots, horizon.controls)
        places.append(curve(times))
        speeds.append(curve(times, 1))
        horizon.advance(5)
    return np.concatenate(places), np.concatenate(speeds)


def test_a_wish_that_keeps_the_limits_is_danced_as_it_is():
    def wish(times):
        return 0.5 * np.sin(2 * times)[:, None] ** 3

    arm = Horizon(-FREE, FREE, np.array([5.0]), np.array([50.0]), FREE, np.zeros(1))
    places, _ = danced(arm, wish, 30)
    assert np.abs(places - wish(np.arange(3000) / 1000)).max() < 1e-3


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_limits_are_kept_whatever_is_wished_and_however_it_jumps(seed):
    rng = np.random.default_rng(seed)
    low, high = -rng.uniform(0.1, 2, 3), rng.uniform(0.1, 2, 3)
    speed, acceleration = rng.uniform(0.2, 8, 3), rng.uniform(2, 60, 3)
    body = Horizon(low, high, speed, acceleration, np.full(3, np.inf), np.zeros(3))
    last = np.zeros(3)
    for _ in range(6):
        to, slope = rng.normal(0, 2, 3), rng.normal(0, 10, 3)
        places, speeds = danced(body, lambda t: to + slope * np.sin(9 * t)[:, None], 4)  # noqa: B023
        assert (places >= low - 1e-6).all()
        assert (places <= high + 1e-6).all()
        assert (np.abs(speeds) <= speed + 1e-6).all()
        assert (np.abs(np.diff(speeds, axis=0)) * 1000 <= acceleration * (1 + 1e-4)).all()
        assert np.abs(places[0] - last).max() <= speed.max() / 1000 + 1e-9
        last = places[-1]


def test_a_wish_at_full_speed_towards_the_end_of_the_range_is_braked_in_time():
    arm = Horizon(np.array([-1.0]), np.array([1.0]), np.array([3.0]), np.array([5.0]), FREE, np.zeros(1))
    places, _ = danced(arm, lambda t: 3 * t[:, None], 20)
    assert places.max() <= 1 + 1e-9
    assert places[-1, 0] == pytest.approx(1.0, abs=1e-2)


def test_keyposes_are_met_where_the_rest_is_not():
    def wish(times):
        return np.sin(8 * times)[:, None]

    key = np.pi / 16 + np.pi / 4 * 2
    arm = Horizon(-FREE, FREE, np.array([4.0]), np.array([80.0]), FREE, np.zeros(1))
    arm.plan(wish, np.array([key]))
    assert abs(float(arm.values(np.array([key]))[0, 0] - wish(np.array([key]))[0, 0])) < 0.01


def test_an_unchanged_wish_is_not_solved_again_at_once():
    arm = Horizon(-FREE, FREE, np.array([1.0]), np.array([20.0]), FREE, np.zeros(1))

    def far(times):
        return np.full((len(times), 1), 5.0)

    assert arm.plan(far).all()
    arm.advance(5)
    assert not arm.plan(far, changed=False).any()
    assert arm.plan(far, changed=True).all()
