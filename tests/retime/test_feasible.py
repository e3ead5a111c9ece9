"""What cannot be done is said: which keypose, why, and the speed that would do."""

from __future__ import annotations

import numpy as np

from onbeat.retime.bspline import Spline
from onbeat.retime.controlpoints import fit
from onbeat.retime.demand import Demand
from onbeat.retime.feasible import missed, slower, speed_that_would_do
from onbeat.retime.lock import TimeMap
from onbeat.retime.measures import measure

FREE = np.full(2, np.inf)


def steps(high: float = np.inf, speed: float = np.inf) -> Demand:
    """The first channel steps by 1 rad in the middle, the second stays."""
    wish = Spline.through(np.stack((np.repeat([0.0, 1.0], 60), np.zeros(120)), axis=1), 60)
    bounds = (-FREE, np.array([high, np.inf]), np.array([speed, 1.0]), FREE, FREE)
    return Demand(wish, *bounds, np.array([0.75, 1.25]), TimeMap.steady(2.0))


def found(demand: Demand):
    return missed(demand, measure(demand, fit(demand).trajectory))


def test_nothing_is_missed_where_there_is_time():
    demand = steps(speed=3.0)
    assert found(demand) == []
    assert speed_that_would_do(demand, []) == 1.0


def test_a_keypose_out_of_range_is_told_as_such_and_no_speed_helps():
    demand = steps(high=0.8)
    one = found(demand)[0]
    assert (one.channel, one.range, round(one.time, 3)) == (0, True, 1.25)
    assert abs(one.error - 0.2) < 0.01
    assert speed_that_would_do(demand, [one]) == 1.0


def test_the_speed_that_would_do_does_and_a_little_more_does_not():
    demand = steps(speed=1.0)
    some = found(demand)
    assert {one.channel for one in some} == {0}
    assert not any(one.range for one in some)
    share = speed_that_would_do(demand, some)
    assert share is not None
    assert 0.4 < share < 0.6
    assert found(slower(demand, share)) == []
    assert found(slower(demand, share * 1.05)) != []


def test_what_is_far_too_slow_has_no_speed_that_would_do():
    demand = steps(speed=0.05)
    assert speed_that_would_do(demand, found(demand)) is None
