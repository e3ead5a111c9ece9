import numpy as np
import pytest

from demands import curves, demand, swing
from onbeat.retime.bspline import Spline
from onbeat.retime.measures import PLATEAU, measure


def test_what_keeps_all_limits_has_no_excess():
    asked = demand(swing(), -1.01, 1.01, 6.4, keyposes=[0.25, 0.75])
    found = measure(asked, asked.wish)
    assert found.violations == (0, 0)
    assert found.position_excess[0] == found.velocity_excess[0] == found.rms[0] == 0
    assert found.worst_keypose == 0


def test_excesses_are_the_largest_and_shares_those_of_the_time():
    asked = demand(swing(), -0.5, 2.0, np.pi)
    found = measure(asked, asked.wish)
    assert found.violations == (1, 1)
    assert found.position_excess[0] == pytest.approx(0.5, abs=1e-3)
    assert found.velocity_excess[0] == pytest.approx(np.pi, rel=1e-2)
    assert found.position_share[0] == pytest.approx(1 / 3, abs=0.01), "a sine is under −½ for a third of its time"
    assert found.velocity_share[0] == pytest.approx(2 / 3, abs=0.01), "a cosine is over ½ for two thirds"


def test_what_is_past_between_frames_only_is_seen():
    samples = np.array([0, 0, 0.0, 1.0, 1.0, 0.0, 0, 0])
    asked = demand(samples, high=1.01)
    assert (asked.wish.samples <= 1.01).all()
    assert measure(asked, asked.wish).position_excess[0] > 0.05


def test_a_limit_is_past_by_less_than_the_tolerance_is_kept():
    asked = demand(np.full(60, 1.0), high=1.0 - 5e-7)
    assert measure(asked, asked.wish).violations == (0, 0)
    asked = demand(np.full(60, 1.0), high=1.0 - 2e-6)
    assert measure(asked, asked.wish).violations == (1, 0)


def test_channels_are_counted():
    wish = curves(0, 100, 3)
    asked = demand(wish, high=(100.0, -100.0, -100.0), speed=(1e-3, 1e-3, 1e-3))
    assert measure(asked, asked.wish).violations == (2, 3)


def test_the_error_is_the_root_of_the_mean_square_at_the_frames():
    asked = demand(swing())
    other = Spline.through(swing()[:, None] + 0.3, 60.0)
    assert measure(asked, other).rms[0] == pytest.approx(0.3)


def test_the_peak_acceleration_is_that_of_the_spline():
    asked = demand(swing())
    times = np.linspace(0, 4, 20_001)
    found = measure(asked, asked.wish).peak_acceleration[0]
    assert found == pytest.approx(np.abs(asked.wish(times, 2)).max(), rel=1e-6)
    assert found == pytest.approx((2 * np.pi) ** 2, rel=0.01)


def test_plateaus_are_the_share_of_the_time_at_full_speed():
    line = np.interp(np.arange(241) / 60, [0, 1, 3, 4], [0, 0, 2, 2])
    assert measure(demand(line, speed=1.0), demand(line).wish).plateaus[0] == pytest.approx(0.5, abs=0.03)
    assert measure(demand(line, speed=1.01 / PLATEAU), demand(line).wish).plateaus[0] < 0.05
    assert measure(demand(line), demand(line).wish).plateaus[0] == 0


def test_keypose_errors_are_from_the_wish_or_the_bound():
    asked = demand(swing(), -2, 0.5, keyposes=[0.25, 0.75, 2.0])
    other = Spline.through(swing()[:, None] + 0.1, 60.0)
    found = measure(asked, other)
    assert found.keyposes.tolist() == [0.25, 0.75, 2.0]
    np.testing.assert_allclose(found.keypose_errors[:, 0], [0.6, 0.1, 0.1], atol=1e-4)
    assert found.feasible[:, 0].tolist() == [False, True, True]
    assert found.worst_keypose == pytest.approx(0.1, abs=1e-4)


def test_without_a_feasible_keypose_the_worst_is_none():
    asked = demand(swing(), high=-2.0, keyposes=[0.25])
    assert measure(asked, asked.wish).worst_keypose == 0
    assert measure(demand(swing()), demand(swing()).wish).worst_keypose == 0


def test_a_speed_that_changes_is_looked_at_in_its_own_time():
    speed = np.where(np.arange(242) < 121, 10.0, 1.0)[:, None]
    asked = demand(swing(), speed=speed)
    assert measure(asked, asked.wish).velocity_share[0] == pytest.approx(0.45, abs=0.03)
    turned = demand(swing(), speed=speed[::-1])
    assert measure(turned, turned.wish).velocity_excess[0] == pytest.approx(2 * np.pi - 1, rel=0.01)


@pytest.mark.parametrize("turned", [1, -1])
def test_an_interval_is_bounded_by_the_pairs_that_it_lies_under_and_no_others(turned: int):
    line, speed = np.arange(241) / 60, np.full((242, 1), 0.5)
    speed[:3] = 2.0
    asked = demand(line, speed=speed[::turned])
    assert measure(asked, asked.wish).velocity_share[0] == pytest.approx(1 - 3 / 240, abs=5e-4)


def test_the_first_and_the_last_interval_are_looked_at():
    for samples in ([1.0, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 1.0]):
        asked = demand(np.array(samples), speed=30.0)
        assert measure(asked, asked.wish).velocity_excess[0] > 25


def test_a_later_clock_changes_no_figure():
    wish = curves(1, 200, 2)
    first, later = (demand(wish, -0.5, 0.5, 1.0, keyposes=[s + 1.0], start=s) for s in (0.0, 777.0))
    a, b = measure(first, first.wish), measure(later, later.wish)
    for name in ("position_excess", "velocity_excess", "rms", "peak_acceleration", "keypose_errors"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=1e-5)


@pytest.mark.parametrize(("frames", "fps"), [(1, 60.0), (2, 60.0), (2, 4000.0)])
def test_a_few_frames_are_enough(frames: int, fps: float):
    asked = demand(np.zeros(frames), -1, 1, 1.0, fps=fps)
    assert measure(asked, asked.wish).violations == (0, 0)


def test_figures_cannot_be_changed():
    found = measure(demand(swing()), demand(swing()).wish)
    with pytest.raises(ValueError, match="read-only"):
        found.rms[0] = 1.0
