"""The decoder is exact: no chain of intervals scores better."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from onbeat.music.decode import decode_beats
from onbeat.music.tempo import BeatSpace, beat_space


def score(beats: list[int], heard: np.ndarray, space: BeatSpace, weight: float, first: int, last: int) -> float:
    """Score of a chain, with the kinds of the intervals before its first and after its last beat given."""
    cost = weight * space.log_prior * space.intervals / space.rate
    kinds = [first, *(int(np.flatnonzero(space.intervals == step)[0]) for step in np.diff(beats)), last]
    total = heard[beats].sum() + cost[kinds[:-1]].sum()
    total += sum(space.log_change[a, b] for a, b in itertools.pairwise(kinds))
    return float(total + cost[last] * (len(heard) - 1 - beats[-1]) / space.intervals[last])


def best_by_trying_all(heard: np.ndarray, space: BeatSpace, weight: float) -> float:
    best = -np.inf
    longest = space.intervals.max()

    def extend(beats: list[int], first: int) -> None:
        nonlocal best
        for last, interval in enumerate(space.intervals):
            if beats[-1] + interval > len(heard) - 1:
                best = max(best, score(beats, heard, space, weight, first, last))
            if beats[-1] + interval < len(heard):
                extend([*beats, beats[-1] + int(interval)], first)

    for start in range(longest):
        for first, interval in enumerate(space.intervals):
            if start < interval:
                extend([start], first)
    return best


@pytest.mark.parametrize("seed", range(6))
def test_equals_trying_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    intervals = np.array([3, 4, 6])
    change = np.log(rng.dirichlet(np.ones(3), 3))
    space = BeatSpace(4.0, intervals, -rng.random(3), change)
    heard = rng.normal(-0.3, 1.0, 22)
    beats = decode_beats(heard, space, 0.7).tolist()
    ways = [
        score(beats, heard, space, 0.7, first, last)
        for first in range(3)
        for last in range(3)
        if beats[0] < intervals[first] and beats[-1] + intervals[last] > len(heard) - 1
    ]
    assert max(ways) == pytest.approx(best_by_trying_all(heard, space, 0.7))


def test_follows_a_tempo_that_drifts_over_missing_onsets() -> None:
    true = np.round(20 + np.cumsum(np.append(0.0, np.linspace(45, 58, 60)))).astype(int)
    heard = np.full(true[-1] + 30, -1.5)
    heard[np.delete(true, [10, 11, 30])] = 5.0
    beats = decode_beats(heard, beat_space(100.0, 60.0), 1.0)
    missed = [frame for frame in true if np.abs(beats - frame).min() > 2]
    assert len(beats) == len(true)
    assert len(missed) <= 1
