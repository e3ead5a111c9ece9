"""Each formula of the paper on signals made for it."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.audio import Audio
from onbeat.music.listen import listen_samples
from onbeat.music.shiratori2006 import (
    HOP,
    TONE_HOP,
    _spectra,
    beat_interval,
    beat_phase,
    chord_change_degree,
    dominant,
    follow_beats,
    histogram_peaks,
    melody_intensity,
    onset_component,
    previous_power,
)
from sounds import click_track

RATE = 100.0


def test_equation_4_takes_the_loudest_of_three_neighbours() -> None:
    power = np.array([[1.0, 5.0, 2.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    assert previous_power(power).tolist() == [[5.0, 5.0, 5.0, 2.0]]


def test_equation_3_counts_a_rise_that_lasts() -> None:
    lasting = np.array([[1.0], [4.0], [6.0], [1.0]])
    assert onset_component(lasting).tolist() == [5.0, 0.0]  # max(4, 6) − 1; then 6 → 1 falls
    flicker = np.array([[1.0], [4.0], [0.0]])
    assert onset_component(flicker).tolist() == [0.0]  # min(4, 0) < 1


def test_equation_3_ignores_a_tone_that_glides() -> None:
    gliding = np.eye(6)[[1, 1, 2, 2, 3, 3]]
    assert onset_component(gliding).sum() == 0.0


def pulses(interval: float, first: float, seconds: float = 30.0) -> np.ndarray:
    onsets = np.zeros(round(seconds * RATE))
    frames = np.round(np.arange(first, seconds - 0.01, interval) * RATE).astype(int)
    for step, height in ((-1, 0.5), (0, 1.0), (1, 0.5)):
        onsets[np.clip(frames + step, 0, len(onsets) - 1)] = height
    return onsets


@pytest.mark.parametrize("interval", [0.4, 0.5, 0.73])
def test_interval_and_phase_of_pulses(interval: float) -> None:
    onsets = pulses(interval, 0.2)
    assert beat_interval(onsets, RATE) == pytest.approx(interval, abs=0.004)
    assert beat_phase(onsets, RATE, interval) == pytest.approx(0.2, abs=0.011)


def test_beats_follow_a_drift() -> None:
    true = 0.2 + np.cumsum(np.linspace(0.5, 0.56, 50))
    onsets = np.zeros(round((true[-1] + 0.3) * RATE))
    onsets[np.round(true * RATE).astype(int)] = 1.0
    beats = follow_beats(onsets, RATE, 0.53, true[0])
    assert np.abs(beats[:50] - true).max() < 0.011


def test_dominant_frequencies_are_local_maxima() -> None:
    power = np.array([[0.0, 2.0, 1.0, 3.0, 0.0]], np.float32)
    assert dominant(power).tolist() == [[0.0, 2.0, 0.0, 3.0, 0.0]]


def test_equations_5_and_6_count_new_tones_up_to_500_hz() -> None:
    frequencies = np.array([100.0, 300.0, 500.0, 700.0])
    peaks = np.array([[1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 0.0, 9.0], [0.0, 2.0, 0.5, 9.0]])
    assert chord_change_degree(peaks, frequencies).tolist() == [0.0, 2.0, 0.5]


def test_equation_7_sums_250_hz_to_1_khz() -> None:
    frequencies = np.array([200.0, 250.0, 1000.0, 1100.0])
    assert melody_intensity(np.array([[8.0, 1.0, 2.0, 8.0]]), frequencies).tolist() == [3.0]


def test_it_hears_clicks() -> None:
    beats, audio = click_track(120.0, 20.0)
    song = listen_samples(audio, "shiratori2006")
    assert song.method == "shiratori2006"
    assert song.tempo == pytest.approx(120.0, rel=0.01)
    nearest = np.abs(song.beats[:, None] - beats).min(axis=1)
    assert np.median(nearest) < 0.03
    assert set(song.downbeats) <= set(song.beats)


def literal_onset_component(power: np.ndarray) -> list[float]:
    """Eqs. 3–4 as they are printed, a time and a frequency at a time; there is nothing beyond the ends."""
    frames, bins = power.shape
    total = []
    for t in range(1, frames - 1):
        d = 0.0
        for f in range(bins):
            before = max(power[t - 1, g] for g in (f - 1, f, f + 1) if 0 <= g < bins)
            if min(power[t, f], power[t + 1, f]) >= before:
                d += max(power[t, f], power[t + 1, f]) - before
        total.append(d)
    return total


@pytest.mark.parametrize("seed", range(5))
def test_equations_3_and_4_to_the_letter(seed: int) -> None:
    power = np.random.default_rng(seed).random((12, 7)) ** 2
    np.testing.assert_allclose(onset_component(power), literal_onset_component(power), rtol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_equations_5_to_7_to_the_letter(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frequencies = np.arange(0.0, 1200.0, 50.0)
    peaks = rng.random((6, len(frequencies))) * (rng.random((6, len(frequencies))) > 0.6)
    bass = [f for f, hertz in enumerate(frequencies) if 0.0 <= hertz <= 500.0]
    beat = [sum(max(peaks[tau, f] - peaks[tau - 1, f], 0.0) for f in bass) for tau in range(1, 6)]
    np.testing.assert_allclose(chord_change_degree(peaks, frequencies)[1:], beat)
    melody = [sum(row[f] for f, hertz in enumerate(frequencies) if 250.0 <= hertz <= 1000.0) for row in peaks]
    np.testing.assert_allclose(melody_intensity(peaks, frequencies), melody)


def test_the_unit_of_power_scales_equations_3_to_7() -> None:
    power = np.random.default_rng(0).random((10, 40))
    np.testing.assert_allclose(onset_component(9.0 * power), 9.0 * onset_component(power))
    frequencies = np.linspace(0.0, 1200.0, 40)
    for equation in (chord_change_degree, melody_intensity):
        np.testing.assert_allclose(equation(9.0 * power, frequencies), 9.0 * equation(power, frequencies))


def test_a_tone_that_is_switched_on_is_one_onset_at_its_time() -> None:
    times = np.arange(2 * 22050) / 22050
    step = (0.5 * np.sin(2.0 * np.pi * 440.0 * times) * (times >= 1.0)).astype(np.float32)
    onsets = _spectra([step], 22050, None)[0]
    rate = 22050 / round(HOP * 22050)
    assert onsets.argmax() / rate == pytest.approx(1.0, abs=0.025)
    away = np.abs(np.arange(len(onsets)) / rate - 1.0) > 0.06
    assert onsets[away][:-6].max() < 0.02 * onsets.max()  # at its end the sound is cut off, which is an onset, too


def test_a_glide_is_no_onset_beside_a_step() -> None:
    """Eq. 4 looks at the neighbouring frequencies, so that a voice that slides does not count again and again."""
    times = np.arange(2 * 22050) / 22050
    glide = (0.5 * np.sin(2.0 * np.pi * (400.0 * times + 50.0 * times**2)) * (times >= 0.5)).astype(np.float32)
    onsets = _spectra([glide], 22050, None)[0]
    later = np.arange(len(onsets)) * HOP > 0.6
    assert onsets[later][:-6].max() < 0.1 * onsets.max()


def test_two_tones_are_two_peaks_at_their_frequencies() -> None:
    times = np.arange(2 * 22050) / 22050
    tones = (0.3 * np.sin(2 * np.pi * 300.0 * times) + 0.2 * np.sin(2 * np.pi * 700.0 * times)).astype(np.float32)
    _, frames, frequencies, _ = _spectra([tones], 22050, None)
    highest = np.sort(frequencies[np.argsort(frames[len(frames) // 2])[-2:]])
    np.testing.assert_allclose(highest, [300.0, 700.0], atol=frequencies[1])
    assert frequencies[-1] >= 1000.0


def test_chord_change_and_intensity_of_tones_that_begin_at_a_beat() -> None:
    """200 Hz throughout; from beat 4 on 300 Hz (a new bass tone, and melody); from beat 8 on 2 kHz (neither)."""
    beats = 0.5 * np.arange(12)
    times = np.arange(6 * 22050) / 22050
    sound = 0.2 * np.sin(2 * np.pi * 200.0 * times)
    sound += 0.2 * np.sin(2 * np.pi * 300.0 * times) * (times >= beats[4])
    sound += 0.2 * np.sin(2 * np.pi * 2000.0 * times) * (times >= beats[8])
    _, frames, frequencies, _ = _spectra([sound.astype(np.float32)], 22050, None)
    peaks = histogram_peaks(frames, 22050 / round(TONE_HOP * 22050), beats)
    assert chord_change_degree(peaks, frequencies)[1:11].argmax() + 1 == 4
    melody = melody_intensity(peaks, frequencies)
    assert melody[5:11].min() > 20.0 * melody[:3].max()
    assert melody[9:11].max() == pytest.approx(melody[5:7].max(), rel=0.05)


def test_the_strongest_interval_is_taken_even_if_it_is_a_double() -> None:
    """Assumption 2 has no prior on tempo: with every other pulse stronger, the double interval is the highest peak."""
    onsets = pulses(0.4, 0.2) + 2.0 * pulses(0.8, 0.2)
    assert beat_interval(onsets, RATE) == pytest.approx(0.8, abs=0.004)


def test_volume_changes_none_of_its_beats() -> None:
    """Eqs. 3–6 scale with power, and only their ratios are used."""
    beats, audio = click_track(100.0, 12.0)
    song = listen_samples(Audio(0.5 * audio.samples, audio.rate), "shiratori2006")
    again = listen_samples(audio, "shiratori2006")
    np.testing.assert_allclose(song.beats, again.beats)
    np.testing.assert_allclose(song.chord_change, again.chord_change, atol=1e-5)
    assert song.tempo == pytest.approx(100.0, rel=0.01)
    assert abs(len(beats) - len(song.beats)) < 3
