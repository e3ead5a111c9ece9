import numpy as np
import pytest

from demands import FREE, curves, demand, swing
from onbeat.errors import OnbeatError, PlanError
from onbeat.retime.bspline import Knots, Spline
from onbeat.retime.demand import Demand, silent
from onbeat.retime.lock import TimeMap


def test_one_bound_of_the_speed_is_that_of_all_times():
    asked = demand(curves(0, 30, 2), speed=(3.0, 4.0))
    assert asked.speed.shape == (len(asked.wish.controls) - 1, 2)
    assert (asked.speed == [3.0, 4.0]).all()


def test_a_bound_of_the_speed_may_change_over_time():
    each = np.linspace(1, 2, 31)[:, None]
    assert (demand(swing(0.5)[:30], speed=each).speed == each).all()


def test_the_target_is_the_wish_brought_inside():
    asked = demand(swing(), low=-0.5, high=0.7)
    np.testing.assert_allclose(asked.target[:, 0], np.clip(swing(), -0.5, 0.7), atol=1e-12)


def test_keyposes_are_in_order_and_each_once():
    assert demand(swing(), keyposes=[2.0, 0.5, 2.0, 1.0]).keyposes.tolist() == [0.5, 1.0, 2.0]


def test_a_beat_lasts_as_long_as_the_rhythm_says():
    assert demand(swing(), beats=2.5).beat == pytest.approx(0.4)


def test_what_keeps_the_bounds_violates_nothing():
    asked = demand(swing(), -1.01, 1.01, 6.4, 40.0, 260.0)
    assert not asked.violated(asked.wish.controls).any()


@pytest.mark.parametrize(
    ("bound", "value", "at"),
    [
        ("low", -0.9, [0.75, 1.75]),
        ("high", 0.9, [0.25, 1.25]),
        ("speed", 6.2, [0.5, 1.0, 1.5]),
        ("acceleration", 39.0, [0.25, 0.75, 1.25, 1.75]),
        ("jerk", 245.0, [0.5, 1.0, 1.5]),
    ],
)
def test_what_is_past_a_bound_is_found_where_it_is_and_nowhere_else(bound: str, value: float, at: list[float]):
    asked = demand(swing(2), **{bound: value})
    seconds = (np.flatnonzero(asked.violated(asked.wish.controls)[:, 0]) - 1) / 60
    inner = seconds[(seconds > 0.1) & (seconds < 1.9)]
    assert np.abs(inner[:, None] - at).min(axis=1).max() < 0.1
    assert all(np.abs(seconds - one).min() < 0.02 for one in at)


def test_bounds_of_higher_derivatives_can_be_left_out():
    asked = demand(swing(), acceleration=1.0, jerk=1.0)
    assert asked.violated(asked.wish.controls).any()
    assert not asked.violated(asked.wish.controls, derivatives=False).any()


def test_what_is_past_a_bound_between_frames_only_is_found():
    """A joint that turns back between two frames: both are inside, the spline between them is not."""
    samples = np.array([0, 0, 0.0, 1.0, 1.0, 0.0, 0, 0])
    asked = demand(samples, high=1.01)
    assert (asked.wish.samples <= 1.01).all()
    assert asked.wish(np.array([3.5 / 60]))[0, 0] > 1.01
    assert asked.violated(asked.wish.controls)[3:6].any()


def test_rounding_alone_is_no_violation():
    samples = np.full(40, 0.1 + 0.2)
    asked = demand(samples, low=0.3, high=0.3)
    assert not asked.violated(asked.wish.controls).any()


@pytest.mark.parametrize(
    ("bounds", "said"),
    [
        ({"low": 1.0, "high": 0.0}, "channel 0 has its lower bound"),
        ({"low": FREE, "high": FREE}, "channel 0"),
        ({"low": -FREE, "high": -FREE}, "channel 0"),
        ({"low": np.nan}, "low holds nan; numbers are needed"),
        ({"high": np.nan}, "high holds nan"),
        ({"speed": 0.0}, "speed holds 0.0; bounds above 0"),
        ({"speed": -1.0}, "speed holds -1.0"),
        ({"speed": np.nan}, "speed holds nan"),
        ({"speed": np.ones((5, 1))}, r"speed has shape \(5, 1\)"),
        ({"speed": np.ones(2)}, r"speed has shape \(2,\)"),
        ({"acceleration": 0.0}, "acceleration holds 0.0"),
        ({"jerk": -FREE}, "jerk holds -inf"),
        ({"keyposes": [0.5, np.nan]}, "keypose 1"),
        ({"keyposes": [FREE]}, "keypose 0"),
    ],
)
def test_bounds_that_cannot_be_are_said_so(bounds: dict, said: str):
    with pytest.raises(PlanError, match=said):
        demand(swing(), **bounds)


def test_the_channel_is_named():
    with pytest.raises(PlanError, match=r"channel 2 has its lower bound, 5\.0, above"):
        demand(curves(0, 30, 3), low=(0.0, 0, 5), high=(1.0, 1, 1))


@pytest.mark.parametrize("controls", [np.full((6, 1), np.nan), np.full((6, 1), np.inf), np.zeros((6, 0))])
def test_a_wish_of_no_numbers_is_said_so(controls: np.ndarray):
    n = controls.shape[1]
    free = np.full(n, FREE)
    with pytest.raises(OnbeatError, match="wish"):
        Demand(Spline(Knots(0, 1 / 60, 3), controls), -free, free, free, free, free, np.zeros(0), TimeMap.steady(2.0))


def test_silence_is_silent(capsys: pytest.CaptureFixture[str]):
    silent(0.5)
    assert capsys.readouterr() == ("", "")
