"""Clicks over a song."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import soundfile

from onbeat.music.clicks import BEAT_TONE, DOWNBEAT_TONE, with_clicks, write_with_clicks
from onbeat.music.song import Song

SONG = Song(3.0, 60.0, 4, [0.5, 1.5, 2.99], [1.5], np.zeros(3), [0.0], [0.5])
RATE = 8000


def tone_at(samples: np.ndarray, at: float) -> float:
    stretch = samples[round(at * RATE) : round((at + 0.04) * RATE)]
    spectrum = np.abs(np.fft.rfft(stretch, 8000))
    return float(spectrum.argmax())


def test_clicks_are_at_beats_and_higher_at_downbeats() -> None:
    mixed = with_clicks(np.zeros((3 * RATE, 2), np.float32), RATE, SONG)
    assert abs(tone_at(mixed[:, 0], 0.5) - BEAT_TONE) < 30
    assert abs(tone_at(mixed[:, 1], 1.5) - DOWNBEAT_TONE) < 30
    assert np.abs(mixed[round(0.6 * RATE) : round(1.5 * RATE)]).max() == 0.0
    assert np.abs(mixed[round(1.5 * RATE) :]).max() > np.abs(mixed[: round(1.0 * RATE)]).max()


def test_never_past_full_scale_and_the_song_is_untouched(tmp_path: Path) -> None:
    loud = np.ones((3 * RATE, 1), np.float32)
    write_with_clicks(tmp_path / "clicks.wav", loud, RATE, SONG)
    written, rate = soundfile.read(tmp_path / "clicks.wav")
    assert rate == RATE
    assert len(written) == 3 * RATE
    assert np.abs(written).max() <= 1.0
    assert loud.min() == 1.0
