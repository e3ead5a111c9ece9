"""The observation: onsets, harmony and what was learned, as log odds."""

from __future__ import annotations

import numpy as np

from onbeat.music.observation import activation, beat_log_odds, onset_log_odds, unit_power


def test_unit_power_leaves_silence_silent() -> None:
    assert unit_power(np.zeros(5)).tolist() == [0.0] * 5
    assert np.isclose((unit_power(np.arange(9.0)) ** 2).mean(), 1.0)
    assert len(unit_power(np.zeros(0))) == 0


def test_more_of_anything_is_likelier_a_beat() -> None:
    low, high = np.array([0.5]), np.array([2.0])
    assert onset_log_odds(high, low) > onset_log_odds(low, low)
    assert onset_log_odds(low, high) > onset_log_odds(low, low)
    for louder in ((high, low, low), (low, high, low), (low, low, high)):
        assert beat_log_odds(*louder) > beat_log_odds(low, low, low)


def test_an_onset_counts_no_more_however_loud() -> None:
    assert activation(np.array([1e6])) <= 1.0
