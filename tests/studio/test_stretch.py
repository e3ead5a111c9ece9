"""Sound is played faster at its own pitch, and what is heard is heard when it is due."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.studio.stretch import stretched

RATE = 16000


@pytest.mark.parametrize("speed", [0.7, 1.2, 1.6])
def test_pitch_stays_and_clicks_come_when_they_are_due(speed: float):
    times = np.arange(4 * RATE) / RATE
    sound = 0.05 * np.sin(2 * np.pi * 440 * times)
    due = np.arange(0.5, 3.9, 0.5)
    for click in due:
        at = round(click * RATE)
        sound[at : at + 80] += np.sin(2 * np.pi * 3000 * times[:80]) * np.exp(-times[:80] / 0.002)
    out = stretched(sound[:, None].astype(np.float32), RATE, speed)[:, 0]
    assert len(out) == round(len(sound) / speed)
    for click in due / speed:
        around = np.abs(out[round((click - 0.1) * RATE) : round((click + 0.1) * RATE)])
        assert abs(np.argmax(around) / RATE - 0.1) < 0.02
    calm = out[round(0.6 / speed * RATE) : round(0.9 / speed * RATE)]
    spectrum = np.abs(np.fft.rfft(calm * np.hanning(len(calm)), 1 << 16))
    assert abs(np.argmax(spectrum) * RATE / (1 << 16) - 440) < 6


def test_at_the_songs_own_speed_not_a_sample_changes():
    sound = np.random.default_rng(0).normal(size=(500, 2)).astype(np.float32)
    assert stretched(sound, RATE, 1.0) is sound
    assert np.array_equal(stretched(sound[:0], RATE, 1.5), sound[:0])
