"""Windows around joins."""

import numpy as np

from onbeat.metrics.windows import near_joins, ratio, statistic


def test_near_joins_takes_both_sides_and_the_edges() -> None:
    times = np.arange(0, 3, 0.1)
    inside = near_joins(times, np.array([1.0, 1.2]), 0.2)
    assert times[inside].round(6).tolist() == [0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4]
    assert times[near_joins(times, np.array([[0.25, 0.4], [2.9, 9.0]]))].round(6).tolist() == [0.3, 0.4, 2.9]
    assert not near_joins(times, np.zeros(0)).any()
    assert near_joins(np.zeros(0), np.array([1.0])).shape == (0,)


def test_statistics_leave_out_what_is_no_number() -> None:
    values = np.array([[1.0, np.nan], [3.0, 2.0]])
    assert (statistic(values, "median"), statistic(values, "mean"), statistic(values, "max")) == (2.0, 2.0, 3.0)
    assert statistic(np.arange(101.0), "p95") == 95.0
    assert statistic(np.array([np.nan]), "mean") is None


def test_ratio_of_nothing_is_none() -> None:
    assert ratio(1.0, 2.0) == 0.5
    assert ratio(None, 1.0) is ratio(1.0, None) is ratio(1.0, 0.0) is None
