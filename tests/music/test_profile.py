"""What is kept of a sound: its tuning, its tones, its loudness, whatever pieces it comes in."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.loudness import perceptual_weighting, short_term_loudness
from onbeat.music.profile import Profile, Profiler

RATE = 22050


def tones(*semitones: float, cents: float = 0.0, seconds: float = 3.0) -> np.ndarray:
    """Sines so many semitones above A = 440 Hz."""
    times = np.arange(round(seconds * RATE)) / RATE
    hertz = [440.0 * 2.0 ** ((semitone + cents / 100.0) / 12.0) for semitone in semitones]
    return np.sum([0.1 * np.sin(2.0 * np.pi * f * times) for f in hertz], axis=0).astype(np.float32)


def profile_of(samples: np.ndarray, block: int = RATE) -> Profile:
    profiler = Profiler(RATE)
    for _ in profiler.watch(samples[begin : begin + block] for begin in range(0, len(samples), block)):
        pass
    return profiler.profile()


@pytest.mark.parametrize("cents", [-45.0, -20.0, 0.0, 7.0, 33.0, 49.0])
def test_the_tuning_is_found_to_a_cent(cents: float) -> None:
    assert profile_of(tones(-14, -9, -5, 0, 4, cents=cents)).tuning == pytest.approx(cents, abs=1.0)


@pytest.mark.parametrize("cents", [-40.0, 0.0, 25.0])
def test_chroma_has_the_tones_that_sound_in_any_tuning(cents: float) -> None:
    chroma = profile_of(tones(-24, 0, 3, 7, cents=cents)).chroma(np.array([1.0, 2.0]))[0]  # A, and A minor
    assert set(np.flatnonzero(chroma[1] > 0.2 * chroma[1].max()).tolist()) == {9, 0, 4}
    assert chroma[0].argmax() == 9


def test_blocks_of_any_size_give_the_same() -> None:
    samples = tones(0, 4, 7) * np.linspace(0.0, 1.0, 3 * RATE, dtype=np.float32)
    whole, parts = profile_of(samples, len(samples)), profile_of(samples, 777)
    np.testing.assert_allclose(parts.power, whole.power, rtol=1e-4, atol=1e-12)
    np.testing.assert_allclose(parts.news, whole.news, rtol=1e-3, atol=1e-6)
    assert parts.tuning == pytest.approx(whole.tuning, abs=1e-3)
    assert parts.duration == whole.duration == 3.0


@pytest.mark.parametrize("samples", [np.zeros(0), np.zeros(RATE), np.full(RATE, 0.5)])
def test_what_has_no_tones_has_no_tuning_to_speak_of(samples: np.ndarray) -> None:
    profile = profile_of(samples.astype(np.float32)) if len(samples) else profile_of(np.zeros(1, np.float32))
    assert np.isfinite(profile.tuning)
    assert np.isfinite(profile.chroma(np.array([0.0, 0.5]))).all()


def test_a_full_scale_sine_reads_as_meters_say() -> None:
    """ITU-R BS.1770: 0 dBFS at 997 Hz in one channel is −3.01 LUFS."""
    sine = np.sin(2.0 * np.pi * 997.0 * np.arange(6 * RATE) / RATE).astype(np.float32)
    profile = profile_of(sine)
    assert short_term_loudness(profile.power, profile.rate)[60] == pytest.approx(-3.01, abs=0.05)
    halved = profile_of(0.5 * sine)
    assert short_term_loudness(halved.power, halved.rate)[60] == pytest.approx(-9.03, abs=0.05)


def test_the_weighting_falls_in_the_bass_and_rises_in_the_treble() -> None:
    decibels = 10.0 * np.log10(perceptual_weighting(np.array([20.0, 100.0, 997.0, 10000.0])))
    assert decibels[0] < -10.0
    assert decibels[1] == pytest.approx(-1.1, abs=0.3)
    assert decibels[2] == pytest.approx(0.69, abs=0.02)
    assert decibels[3] == pytest.approx(4.0, abs=0.1)
