"""Intensity: low where it is quiet, high where it is loud, whatever the volume."""

from __future__ import annotations

import numpy as np

from onbeat.music.hearing import ear_weighting, hear
from onbeat.music.intensity import intensity, melody_power, normalised
from sounds import hat, kick, mix, piano


def heard(level: float = 0.7) -> tuple[np.ndarray, np.ndarray]:
    """Ten seconds of one soft voice, ten of the whole band, ten soft again."""
    rng = np.random.default_rng(0)
    events = [(at, piano(330.0, 0.6, 0.05)) for at in np.arange(0.0, 30.0, 0.5)]
    for at in np.arange(10.0, 20.0, 0.5):
        events += [(at, kick()), (at, hat(rng)), *((at, piano(tone, 0.5, 0.3)) for tone in (220.0, 440.0, 554.0))]
    hearing = hear([mix(30.0, events, level).samples], 22050)
    return intensity(hearing.tones, hearing.loudness, hearing.tone_rate, hearing.duration)


def test_the_chorus_is_higher_than_the_introduction() -> None:
    times, values = heard()
    assert np.diff(times).tolist() == [0.1] * (len(times) - 1) or np.allclose(np.diff(times), 0.1)
    assert values.min() >= 0.0
    assert values.max() <= 1.0
    loud = (times > 11.5) & (times < 18.5)
    quiet = (times < 8.5) | ((times > 21.5) & (times < 28.5))
    assert values[loud].min() > 0.7
    assert values[quiet].max() < 0.3


def test_volume_does_not_matter() -> None:
    np.testing.assert_allclose(heard(0.7)[1], heard(0.02)[1], atol=1e-3)


def test_melody_is_between_250_hz_and_1_khz() -> None:
    def power(tone: float) -> float:
        hearing = hear(
            [mix(2.0, [(0.0, piano(tone, 2.0) * 0 + np.sin(2 * np.pi * tone * np.arange(88200) / 44100))]).samples],
            22050,
        )
        return float(melody_power(hearing.tones)[10:30].mean())

    assert power(440.0) > 100.0 * power(120.0)
    assert power(440.0) > 100.0 * power(1500.0)


def test_ear_weighting_is_the_a_curve() -> None:
    decibels = 10.0 * np.log10(ear_weighting(np.array([100.0, 1000.0, 4000.0])))
    np.testing.assert_allclose(decibels, [-19.1, 0.0, 1.0], atol=0.1)


def test_normalised_is_between_percentiles() -> None:
    values = normalised(np.arange(101.0))
    assert values[5] == 0.0
    assert values[50] == 0.5
    assert values[95:].tolist() == [1.0] * 6
    assert normalised(np.zeros(0)).shape == (0,)
