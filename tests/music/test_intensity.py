"""Intensity: low where it is quiet, high where it is loud, whatever the volume."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.music.hearing import ear_weighting, hear
from onbeat.music.intensity import intensity, melody_power, normalised, perceived_intensity
from onbeat.music.loudness import short_term_loudness
from onbeat.music.profile import Profile, Profiler
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


PASSAGE = (8.0, 16.0)  # [s]


@cache
def steady() -> np.ndarray:
    """Twenty-four seconds of an even band."""
    rng = np.random.default_rng(0)
    events = []
    for at in np.arange(0.1, 24.0, 0.5):
        events += [
            (at, kick()),
            (at + 0.25, hat(rng)),
            *((at, piano(tone, 0.5, 0.2)) for tone in (220.0, 440.0, 554.0)),
        ]
    return mix(24.0, events).samples


def profile_of(samples: np.ndarray) -> Profile:
    profiler = Profiler(22050)
    for _ in profiler.watch([samples.astype(np.float32)]):
        pass
    return profiler.profile()


def with_passage(decibels: float) -> np.ndarray:
    """The band with one passage made louder."""
    times = np.arange(len(steady())) / 22050
    inside = (times >= PASSAGE[0]) & (times < PASSAGE[1])
    return steady() * np.where(inside, 10.0 ** (decibels / 20.0), 1.0)


def levels(samples: np.ndarray) -> tuple[float, float]:
    """Median intensity within the passage and outside of it, away from its edges."""
    times, values = perceived_intensity(profile_of(samples))
    inside = (times > PASSAGE[0] + 2.0) & (times < PASSAGE[1] - 2.0)
    outside = ((times > 2.0) & (times < PASSAGE[0] - 2.0)) | ((times > PASSAGE[1] + 2.0) & (times < 22.0))
    return float(np.median(values[inside])), float(np.median(values[outside]))


@settings(max_examples=8, deadline=None)
@given(st.floats(1.5, 30.0))
def test_a_louder_passage_is_more_intense(decibels: float) -> None:
    inside, outside = levels(with_passage(decibels))
    assert inside > outside + 0.2
    inside, outside = levels(with_passage(-decibels))
    assert inside < outside - 0.2


@settings(max_examples=6, deadline=None)
@given(st.floats(-50.0, 10.0))
def test_the_volume_of_the_whole_song_changes_nothing(decibels: float) -> None:
    samples = with_passage(6.0)
    _, usual = perceived_intensity(profile_of(samples))
    _, other = perceived_intensity(profile_of(samples * 10.0 ** (decibels / 20.0)))
    np.testing.assert_allclose(other, usual, atol=2e-4)


def test_intensity_climbs_with_a_crescendo() -> None:
    growing = steady() * 10.0 ** (np.linspace(-30.0, 0.0, len(steady())) / 20.0)
    times, values = perceived_intensity(profile_of(growing))
    seconds = values[(times >= 1.0) & (times < 23.0)].reshape(-1, 10).mean(axis=1)
    assert (np.diff(seconds) > 0.0).mean() > 0.85
    assert seconds[-1] > seconds[0] + 0.8


def test_intensity_follows_the_loudness_that_meters_show() -> None:
    rng = np.random.default_rng(0)
    swell = np.interp(np.arange(len(steady())) / 22050, np.arange(0, 25, 3), rng.uniform(-25, 0, 9))
    profile = profile_of(steady() * 10.0 ** (swell / 20.0))
    times, values = perceived_intensity(profile)
    meter = profile.at(short_term_loudness(profile.power, profile.rate, 2.0), times)
    assert np.corrcoef(values, meter)[0, 1] > 0.9


def test_of_two_passages_as_loud_the_one_with_more_attacks_is_more_intense() -> None:
    rng = np.random.default_rng(0)
    pad = [(0.0, 0.3 * np.sin(2 * np.pi * 220.0 * np.arange(16 * 44100) / 44100))]
    busy = [(at, hat(rng, 0.2)) for at in np.arange(8.0, 16.0, 0.125)]
    times, values = perceived_intensity(profile_of(mix(16.0, pad + busy).samples))
    assert np.median(values[times > 10.0]) > np.median(values[(times > 2.0) & (times < 7.0)]) + 0.3


@pytest.mark.parametrize("samples", [np.zeros(22050), np.full(22050, 0.5), np.zeros(1)])
def test_nothing_to_hear_gives_finite_values(samples: np.ndarray) -> None:
    _, values = perceived_intensity(profile_of(samples))
    assert np.isfinite(values).all()
