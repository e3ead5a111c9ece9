import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.limits import Limits

ARM = Limits(
    "arm", ("shoulder", "elbow", "wrist"), [-2, 0, -np.inf], [2, 2.5, np.inf], [3, 4, np.inf], source="made up"
)


def test_what_is_not_known_is_infinite():
    assert np.isinf(ARM.acceleration).all()
    assert np.isinf(ARM.jerk).all()
    assert len(ARM) == 3


def test_one_number_is_every_joints():
    both = Limits("both", ("a", "b"), -1, 1, 2, 30, 400)
    assert both.speed.tolist() == [2, 2]
    assert both.jerk.tolist() == [400, 400]


def test_arrays_are_kept_from_change():
    speed = np.array([1.0])
    limits = Limits("one", ("a",), -np.ones(1), np.ones(1), speed)
    speed[0] = 7
    assert limits.speed.tolist() == [1]
    with pytest.raises(ValueError, match="read-only"):
        limits.speed[0] = 5


def test_joints_are_picked_in_the_order_asked_for():
    picked = ARM.of(["wrist", "shoulder"])
    assert picked.joints == ("wrist", "shoulder")
    assert picked.low.tolist() == [-np.inf, -2]
    assert picked.speed.tolist() == [np.inf, 3]
    assert picked.source == "made up"


def test_a_missing_joint_is_told_with_those_that_come_near():
    with pytest.raises(
        LimitError, match=r"arm has no limits for Elbow \(is it elbow\?\), tail; it has shoulder, elbow"
    ):
        ARM.of(["shoulder", "Elbow", "tail"])
    with pytest.raises(LimitError, match=r"a, b, c and 2 more; it has"):
        ARM.of(list("abcde"))


def test_a_margin_is_on_all_but_the_angles():
    slow = Limits("a", ("x",), -1, 1, 10, 100, 1000).scaled(0.9)
    assert (slow.speed[0], slow.acceleration[0], slow.jerk[0]) == pytest.approx((9, 90, 900))
    assert (slow.low[0], slow.high[0]) == (-1, 1)


def test_acceleration_is_filled_in_where_it_is_not_known():
    limits = Limits("a", ("x", "y", "z"), -1, 1, np.array([2.0, 4, np.inf]), np.array([7, np.inf, np.inf]))
    assert limits.with_acceleration(0.5).acceleration.tolist() == [7, 8, np.inf]


@pytest.mark.parametrize("value", [0, -1, np.nan, np.inf])
def test_shares_and_seconds_are_numbers_above_zero(value: float):
    with pytest.raises(LimitError, match="above 0"):
        ARM.scaled(value)
    with pytest.raises(LimitError, match="above 0"):
        ARM.with_acceleration(value)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"low": [0, 3]}, "elbow has a range of its angle of 3 … 2; the low limit has to be under the high"),
        ({"low": [0, 2]}, "elbow has a range of its angle of 2 … 2"),
        ({"low": [0, np.nan]}, "elbow has a range of its angle of nan … 2"),
        ({"high": [np.nan, 2]}, "shoulder has a range of its angle of -1 … nan"),
        ({"low": [0, np.inf], "high": [1, np.inf]}, "elbow has a range"),
        ({"high": [-np.inf, 2], "low": [-np.inf, 1]}, "shoulder has a range"),
        ({"speed": [3, 0]}, "elbow has a limit of its speed of 0; a number above 0 is expected"),
        ({"speed": [np.nan, 1]}, "shoulder has a limit of its speed of nan"),
        ({"acceleration": -1}, "shoulder has a limit of its acceleration of -1"),
        ({"jerk": [1, np.nan]}, "elbow has a limit of its jerk of nan"),
        ({"speed": [1, 2, 3]}, r"speed has the shape \(3,\); one number each of 2 joints is needed"),
        ({"joints": ("elbow", "elbow")}, "the joint elbow is there more than once"),
    ],
)
def test_limits_that_cannot_be(change: dict, told: str):
    good = {"joints": ("shoulder", "elbow"), "low": [-1, -1], "high": [2, 2], "speed": [3, 3]}
    with pytest.raises(LimitError, match=f"^arm: .*{told}"):
        Limits("arm", **{**good, **change})


def test_messages_stay_short():
    many = Limits("many", tuple(f"joint_{n}" for n in range(500)), -1, 1, 1)
    with pytest.raises(LimitError) as caught:
        many.of(["x" * 10_000])
    assert len(str(caught.value)) < 400
    assert "and 488 more" in str(caught.value)
