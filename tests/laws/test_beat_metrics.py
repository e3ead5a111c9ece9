"""Laws of the beat metrics: they see only differences of time, and are fair to both sides."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.metrics import beats

# Tenths of milliseconds, so that no pair lies on the very edge of a tolerance by rounding alone.
TIMES = st.lists(st.integers(0, 200_000), max_size=30).map(lambda ticks: np.sort(np.array(ticks, float)) / 1e4)
TOLERANCE = st.integers(1, 4000).map(lambda tick: (tick + 0.5) / 1e4)
SCORES = (beats.beat_align_fact, beats.beat_align_bailando)


@given(TIMES, TIMES, TOLERANCE, st.integers(-50, 50))
def test_time_shift_changes_nothing(stops: np.ndarray, music: np.ndarray, tolerance: float, shift: int) -> None:
    assert beats.matches(stops + shift, music + shift, tolerance) == beats.matches(stops, music, tolerance)
    for score in SCORES:
        assert score(stops + shift, music + shift) == pytest.approx(score(stops, music), abs=1e-9)


@given(TIMES, TIMES, TOLERANCE)
def test_time_reversal_changes_nothing(stops: np.ndarray, music: np.ndarray, tolerance: float) -> None:
    backwards = [(20.0 - times)[::-1] for times in (stops, music)]
    assert beats.matches(*backwards, tolerance) == beats.matches(stops, music, tolerance)


@given(TIMES, TIMES, TOLERANCE)
def test_swapping_sides_swaps_precision_and_recall(stops: np.ndarray, music: np.ndarray, tolerance: float) -> None:
    precision, recall, f = beats.precision_recall_f(stops, music, tolerance)
    assert beats.precision_recall_f(music, stops, tolerance) == (recall, precision, pytest.approx(f))
    assert beats.beat_align_fact(stops, music) == beats.beat_align_bailando(music, stops)


@given(TIMES, TIMES, TOLERANCE, TOLERANCE)
def test_more_tolerance_never_scores_less(stops: np.ndarray, music: np.ndarray, one: float, other: float) -> None:
    low, high = sorted((one, other))
    assert beats.matches(stops, music, low) <= beats.matches(stops, music, high)


@given(TIMES, TIMES, TOLERANCE)
def test_scores_lie_between_nothing_and_one(stops: np.ndarray, music: np.ndarray, tolerance: float) -> None:
    for value in (*beats.precision_recall_f(stops, music, tolerance), *(score(stops, music) for score in SCORES)):
        assert 0.0 <= value <= 1.0


@given(TIMES, TIMES, TOLERANCE)
def test_one_more_stop_adds_at_most_one_match(stops: np.ndarray, music: np.ndarray, tolerance: float) -> None:
    fewer, all_of_them = beats.matches(stops[:-1], music, tolerance), beats.matches(stops, music, tolerance)
    assert fewer <= all_of_them <= fewer + 1


@settings(max_examples=25)
@given(TIMES, TIMES, st.integers(0, 2**32 - 1))
def test_same_seed_same_result(stops: np.ndarray, music: np.ndarray, seed: int) -> None:
    first, second = (beats.evaluate(stops, music, 20.0, np.random.default_rng(seed), samples=20) for _ in range(2))
    assert first == second
