"""Precision, recall, F and chance."""

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.keyposes.matching import chance, hits, score


def test_each_time_is_used_once() -> None:
    assert hits(np.array([1.0, 1.01]), np.array([1.005])) == 1
    assert hits(np.array([1.005]), np.array([1.0, 1.01])) == 1


def test_as_many_pairs_as_can_be_are_made() -> None:
    assert hits(np.array([0.96, 1.04]), np.array([1.0, 1.08]), 0.05) == 2


def test_scores_of_known_lists() -> None:
    assert score(np.array([1.0, 2.0, 3.0, 9.0]), np.array([1.0, 2.04])) == (0.5, 1.0, pytest.approx(2 / 3))
    assert score(np.zeros(0), np.array([1.0])) == (0.0, 0.0, 0.0)


def test_nothing_to_find_is_refused() -> None:
    with pytest.raises(MetricError, match="0 true keyposes"):
        score(np.array([1.0]), np.zeros(0))


def test_chance_of_even_times_is_the_share_of_the_tolerance() -> None:
    times = np.arange(0.25, 60, 0.5)
    mean, deviation = chance(times, times, (0.0, 60.0), np.random.default_rng(0), 0.05, 2000)
    assert mean == pytest.approx(0.2, abs=0.03)
    assert 0.2 < deviation < 0.5


def test_chance_is_the_same_for_the_same_seed() -> None:
    times = np.array([1.0, 2.2, 3.1])
    one, other = (chance(times, times, (0.0, 5.0), np.random.default_rng(3)) for _ in range(2))
    assert one == other
