"""The classical method: steady drums and chords, with nothing learned."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music import listen_samples
from sounds import click_track


@pytest.mark.parametrize("bpm", [70, 120, 160])
def test_clicks_are_tracked(bpm: int) -> None:
    beats, audio = click_track(bpm)
    song = listen_samples(audio, "onsets")
    assert song.method == "onsets"
    assert song.tempo == pytest.approx(bpm, rel=2e-3)
    assert np.abs(song.beats[:, None] - beats).min(axis=1).max() < 0.02
