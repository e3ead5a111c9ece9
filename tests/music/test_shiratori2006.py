"""Each formula of the paper on signals made for it."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.listen import listen_samples
from onbeat.music.shiratori2006 import (
    beat_interval,
    beat_phase,
    chord_change_degree,
    dominant,
    follow_beats,
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
