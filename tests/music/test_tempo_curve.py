"""The tempo as it wanders."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.tempo_curve import tempo_curve


def test_a_steady_song_has_one_tempo_everywhere() -> None:
    curve = tempo_curve(0.3 + 0.5 * np.arange(40))
    np.testing.assert_allclose(curve.bpm, 120.0, rtol=1e-12)
    assert curve.times.tolist() == (0.3 + 0.5 * np.arange(40)).tolist()


def test_a_song_that_grows_faster_is_followed() -> None:
    intervals = 60.0 / np.linspace(90.0, 150.0, 200)
    curve = tempo_curve(np.cumsum(intervals))
    np.testing.assert_allclose(curve.bpm[4:-4], np.linspace(90.0, 150.0, 200)[4:-4], atol=0.6)
    assert (np.diff(curve.bpm[4:-4]) > 0.0).all()


def test_one_late_beat_hardly_matters() -> None:
    beats = 0.5 * np.arange(40)
    beats[20] += 0.05
    assert np.abs(tempo_curve(beats).bpm - 120.0).max() < 120.0 * 0.05  # its two intervals alone say 109 and 133


@pytest.mark.parametrize("beats", [[], [1.0]])
def test_too_few_beats_have_no_tempo(beats: list[float]) -> None:
    curve = tempo_curve(np.array(beats))
    assert len(curve.bpm) == len(curve.times) == 0
    assert curve.at(np.array([1.0, 2.0])).tolist() == [0.0, 0.0]
    assert tempo_curve(np.array([1.0, 1.5])).bpm.tolist() == pytest.approx([120.0, 120.0])
