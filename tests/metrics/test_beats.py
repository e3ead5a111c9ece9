"""Scores of beats: known cases, bad input, chance, and agreement with mir_eval."""

import json
from pathlib import Path

import mir_eval
import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.metrics import beats

NONE = np.zeros(0)
BEATS = np.arange(0.5, 60, 0.5)
GOLDEN = Path(__file__).parents[1] / "golden" / "beats.json"


def rng() -> np.random.Generator:
    return np.random.default_rng(7)


@pytest.mark.parametrize("tolerance", [0.05, 0.1])
def test_f_is_mir_evals(tolerance: float) -> None:
    draw = rng()
    for number in range(200):
        stops, music = (np.sort(draw.uniform(0, 8, draw.integers(1, 40))) for _ in range(2))
        music = np.arange(draw.uniform(0, 0.5), 8.0, 0.5) if number % 2 else music  # no stop is near two of these
        pairs = mir_eval.util.match_events(music, stops, tolerance)
        assert beats.matches(stops, music, tolerance) == len(pairs)
        expected = mir_eval.beat.f_measure(music, stops, tolerance)
        assert beats.f_measure(stops, music, tolerance) == pytest.approx(expected, abs=1e-12)


def test_each_stop_and_beat_is_matched_once() -> None:
    assert beats.matches(np.array([0.96, 1.0, 1.04]), np.array([1.0]), 0.05) == 1
    assert beats.matches(np.array([1.0]), np.array([0.96, 1.0, 1.04]), 0.05) == 1
    # The first stop could take the second beat, and leave none to the second stop.
    assert beats.matches(np.array([1.0, 1.08]), np.array([0.96, 1.04]), 0.05) == 2


def test_perfect() -> None:
    scores = beats.evaluate(BEATS, BEATS, 60.0, rng(), strong=BEATS[::4])
    for name in ("precision50", "recall50", "f50", "f100", "strong_recall50", "beat_align_fact", "beat_align_bailando"):
        assert scores[name] == pytest.approx(1.0), name
    assert scores["f50_jitter_z"] > 12
    # An even rhythm cannot stand far above its own shifts, however good.
    assert scores["f50_phase_z"] < 4


def test_late_by_a_quarter_beat_is_off_every_beat() -> None:
    scores = beats.evaluate(BEATS[:-1] + 0.125, BEATS, 60.0, rng())
    assert scores["f50"] == scores["f100"] == 0.0
    assert scores["f100_jitter_z"] < -3
    assert scores["beat_align_fact"] == pytest.approx(np.exp(-(2.5**2) / 2), rel=1e-6)
    assert scores["beat_align_fact_margin"] < -0.15


def test_every_other_beat_is_precise_and_half_recalled() -> None:
    scores = beats.evaluate(BEATS[::2], BEATS, 60.0, rng())
    assert scores["precision50"] == 1.0
    assert scores["recall50"] == pytest.approx(60 / 119)
    # FACT sees only the stops there are, Bailando the beats that have none.
    assert scores["beat_align_fact"] == pytest.approx(1.0)
    assert scores["beat_align_bailando"] == pytest.approx(60 / 119, abs=1e-6)


def test_random_stops_are_at_chance() -> None:
    draw = rng()
    z = [beats.evaluate(np.sort(draw.uniform(0, 60, 90)), BEATS, 60.0, draw)["f50_jitter_z"] for _ in range(12)]
    assert abs(np.mean(z)) < 1.0
    assert np.max(np.abs(z)) < 4.0


def test_chance_of_beat_align_is_as_published() -> None:
    """√(2π)·σ/spacing = 0.25 at 120 beats a minute."""
    scores = beats.evaluate(np.sort(rng().uniform(0, 60, 100)), BEATS, 60.0, rng())
    assert scores["beat_align_fact_null"] == pytest.approx(np.sqrt(2 * np.pi) * 0.05 / 0.5, abs=0.01)


def test_nothing_scores_nothing() -> None:
    for stops, music in ((NONE, BEATS), (BEATS, NONE), (NONE, NONE)):
        scores = beats.evaluate(stops, music, 60.0, rng(), strong=NONE)
        assert scores["f50"] == scores["beat_align_fact"] == scores["beat_align_bailando"] == 0.0
        assert scores["f50_jitter_z"] is None
        assert scores["strong_recall50"] is None
        assert "NaN" not in json.dumps(scores)


def test_a_single_stop_and_beat() -> None:
    scores = beats.evaluate(np.array([1.02]), np.array([1.0]), 2.0, rng())
    assert scores["f50"] == 1.0
    assert scores["f50_jitter_null"] is None
    assert scores["f50_phase_null"] == pytest.approx(0.05, abs=0.05)
    assert scores["beat_align_fact"] == scores["beat_align_bailando"] == pytest.approx(np.exp(-(0.4**2) / 2))


def test_only_what_lies_within_the_duration_counts() -> None:
    stops, music = np.array([-0.5, 1.0, 5.0]), np.array([1.0, 2.0, 4.0])
    scores = beats.evaluate(stops, music, 3.0, rng())
    assert (scores["stops"], scores["beats"], scores["precision50"], scores["recall50"]) == (1, 2, 1.0, 0.5)


@pytest.mark.parametrize(
    ("stops", "music", "duration", "message"),
    [
        (np.zeros((2, 2)), BEATS, 60.0, r"stops have shape \(2, 2\); one list of seconds, \(N,\), is needed"),
        (BEATS, np.array(1.0), 60.0, r"beats have shape \(\)"),
        (np.array([2.0, 1.0]), BEATS, 60.0, "stops go back from 2 s to 1 s; sort them"),
        (BEATS, np.array([1.0, np.nan]), 60.0, "beats: number 1 is nan"),
        (BEATS, BEATS, 0.0, "the duration is 0.0 s; a positive number"),
        (BEATS, BEATS, np.inf, "the duration is inf s"),
    ],
)
def test_bad_input_is_named(stops: np.ndarray, music: np.ndarray, duration: float, message: str) -> None:
    with pytest.raises(MetricError, match=message):
        beats.evaluate(stops, music, duration, rng())


def test_bad_strong_beats_are_named() -> None:
    with pytest.raises(MetricError, match="strong beats go back from 3 s"):
        beats.evaluate(BEATS, BEATS, 60.0, rng(), strong=np.array([3.0, 2.0]))


def test_jitter_stays_within_half_the_shorter_interval() -> None:
    music = np.array([0.0, 0.5, 1.0, 9.0, 9.5])
    moved = np.array(beats.jitter_null(music, rng(), 500))
    assert (np.diff(moved, axis=1) >= 0).all()
    assert np.abs(moved - music).max() <= 0.25
    assert np.abs(moved - music).max() > 0.24


def test_phase_keeps_the_rhythm() -> None:
    stops = np.array([0.0, 0.3, 1.1])
    for shifted in beats.phase_null(stops, 2.0, rng(), 20):
        assert (shifted >= 0).all()
        assert (shifted < 2.0).all()
        gaps = np.sort(np.diff(np.append(shifted, shifted[0] + 2.0)))
        assert gaps == pytest.approx([0.3, 0.8, 0.9])


def test_same_generator_same_scores() -> None:
    stops = np.sort(rng().uniform(0, 60, 80))
    assert beats.evaluate(stops, BEATS, 60.0, rng()) == beats.evaluate(stops, BEATS, 60.0, rng())


@pytest.mark.parametrize("case", json.loads(GOLDEN.read_text()), ids=lambda case: case["name"])
def test_golden(case: dict) -> None:
    found = beats.evaluate(np.array(case["stops"]), np.array(case["beats"]), case["duration"], rng())
    assert found == pytest.approx(case["scores"], abs=1e-9)
