"""Confidence of beats: high where the activation agrees, low where it does not."""

from __future__ import annotations

import numpy as np

from onbeat.music.confidence import beat_confidence


def heard(beats: np.ndarray, frames: int = 2000, at: float = 3.0) -> np.ndarray:
    odds = np.full(frames, -6.0)
    odds[beats] = at
    return odds


def test_beats_that_are_heard_are_sure() -> None:
    beats = np.arange(20, 2000, 50)
    sure = beat_confidence(heard(beats), beats)
    assert sure.shape == beats.shape
    assert sure.min() > 0.75
    assert beat_confidence(heard(beats, at=-3.0), beats).max() < 0.5


def test_beats_beside_those_that_are_heard_are_unsure() -> None:
    beats = np.arange(20, 2000, 50)
    assert beat_confidence(heard(beats), beats[:-1] + 12).mean() < 0.5


def test_what_is_unsure_for_a_while_is_unsure_there() -> None:
    beats = np.arange(20, 4000, 50)
    odds = heard(beats, 4000)
    odds[1500:2500] = -4.0
    sure = beat_confidence(odds, beats)
    assert sure[(beats > 1700) & (beats < 2300)].max() < sure[beats < 1300].min()


def test_uneven_beats_are_less_sure() -> None:
    even = np.arange(20, 2000, 50)
    uneven = even + np.random.default_rng(0).integers(-15, 16, len(even))
    assert beat_confidence(heard(uneven), uneven).mean() < beat_confidence(heard(even), even).mean()


def test_too_few_beats_are_not_sure() -> None:
    odds = np.zeros(100)
    assert beat_confidence(odds, np.zeros(0, np.int64)).tolist() == []
    assert beat_confidence(odds, np.array([4])).tolist() == [0.0]
