"""Another rate, without waiting."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.live.sound.resampling import Resampler


def tone(hertz: float, rate: int, seconds: float = 1.0) -> np.ndarray:
    return np.sin(2 * np.pi * hertz * np.arange(round(seconds * rate)) / rate).astype(np.float32)


@pytest.mark.parametrize("rate", [4000, 8000, 11025, 48000, 96000, 399989])
def test_a_tone_keeps_its_time_to_the_sample(rate: int):
    resampler = Resampler(rate, 44100)
    out = np.concatenate((resampler.push(tone(440.0, rate)), resampler.flush()))
    assert len(out) >= 44100 - 1
    expected = tone(440.0, 44100)[1000:-1000]
    assert np.abs(out[1000 : 1000 + len(expected)] - expected).max() < 1e-3


@pytest.mark.parametrize("rate", [8000, 48000, 399989])
def test_what_comes_late_is_a_few_milliseconds_and_always_the_same(rate: int):
    resampler = Resampler(rate, 44100)
    given, taken = 0, 0
    for block in np.array_split(tone(440.0, rate), 100):
        given, taken = given + len(block), taken + len(resampler.push(block))
        assert given / rate - taken / 44100 == pytest.approx(resampler.latency, abs=1.0 / min(rate, 44100))
    assert resampler.latency <= 0.0021


def test_the_size_of_blocks_changes_no_bit():
    sound = np.random.default_rng(0).standard_normal(48000).astype(np.float32)
    whole = Resampler(48000, 44100).push(sound)
    pieces = Resampler(48000, 44100)
    parts = [pieces.push(part) for part in np.split(sound, [1, 2, 7, 700, 5000, 5000, 30000])]
    assert np.array_equal(np.concatenate(parts), whole)


def test_tones_that_the_ear_cannot_hold_are_not_heard_as_others():
    assert np.abs(Resampler(96000, 44100).push(tone(30000.0, 96000))[1000:]).max() < 1e-3
