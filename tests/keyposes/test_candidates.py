"""Fig. 1: minima near beats, under T1 or beside a rise of more than T2."""

import numpy as np
import pytest

from onbeat.keyposes.candidates import Thresholds, candidates, minima, windows

T = np.arange(0, 5, 1 / 120)
DIPS = 1.0 - 0.9 * np.exp(-(((T - 1.013) / 0.1) ** 2)) - 0.3 * np.exp(-(((T - 3.0) / 0.1) ** 2))
BEATS = np.arange(0.5, 5, 0.5)


def at(t1: float, t2: float, beats: np.ndarray = BEATS) -> list[float]:
    found = candidates(minima(DIPS), beats, Thresholds(t1, t2), 0.25)
    return [round(float(time), 2) for time in found if np.isfinite(time)]


def test_a_minimum_is_found_between_samples() -> None:
    assert minima(DIPS).times[0] == pytest.approx(1.013, abs=1e-3)


def test_low_minima_pass_t1_and_deep_ones_t2() -> None:
    assert at(0.2, 9.0) == [1.01]
    assert at(0.0, 0.5) == [1.01]
    assert at(0.8, 9.0) == [1.01, 3.0]
    assert at(0.0, 0.2) == [1.01, 3.0]
    assert at(0.0, 9.0) == []


def test_only_minima_near_a_beat_count() -> None:
    assert at(2.0, 0.0, np.array([1.3, 1.8, 2.3, 2.8])) == []
    assert at(2.0, 0.0, np.array([1.1, 1.6, 2.1, 2.6])) == [1.01]


def test_the_lowest_of_several_minima_is_taken() -> None:
    curve = 1.0 - 0.5 * np.exp(-(((T - 0.9) / 0.03) ** 2)) - 0.8 * np.exp(-(((T - 1.1) / 0.03) ** 2))
    assert candidates(minima(curve), np.array([1.0, 2.0]), Thresholds(1.0, 0.1))[0] == pytest.approx(1.1, abs=0.005)


def test_a_flat_valley_is_one_minimum_in_its_middle() -> None:
    curve = np.ones(240)
    curve[100:141] = 0.2
    found = minima(curve)
    assert found.times.tolist() == [pytest.approx(1.0)]
    assert found.rises.tolist() == [pytest.approx(0.8)]


def test_a_curve_without_minima_has_none() -> None:
    for curve in (np.zeros(50), np.linspace(0, 1, 50), np.linspace(1, 0, 50), np.zeros(1)):
        assert not len(minima(curve).times)


def test_windows_follow_uneven_beats() -> None:
    first, last = windows(np.array([0.0, 1.0, 3.0]), 0.25)
    assert first.tolist() == [-0.375, 0.75, 2.5]
    assert last.tolist() == [0.25, 1.5, 3.375]
