"""The default method on songs of known beats that it did not learn from, and the same answer each time."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.examples.song import demo_song
from onbeat.music import listen_samples
from onbeat.music.audio import Audio
from sounds import beat_times, hat, kick, mix, piano, snare


def hits(true: np.ndarray, found: np.ndarray) -> float:
    """Share of true beats with a found one within 50 ms."""
    return float((np.abs(true[:, None] - found).min(axis=1) < 0.05).mean())


@pytest.mark.parametrize(("seed", "tempo", "meter"), [(3, 96.0, 4), (5, 124.0, 4), (7, 132.0, 3)])
def test_the_folk_dance_of_the_examples_is_heard_with_its_bars(seed: int, tempo: float, meter: int) -> None:
    demo = demo_song(40.0, seed=seed, tempo=tempo, meter=meter, drift=0.04)
    song = listen_samples(Audio(demo.samples.mean(axis=1)[::2].copy(), demo.rate // 2))
    assert hits(demo.beats, song.beats) > 0.95
    inside = (song.beats >= demo.beats[0] - 0.1) & (song.beats <= demo.beats[-1] + 0.1)  # the last chord rings on
    assert abs(inside.sum() - len(demo.beats)) <= 1
    assert song.meter == meter
    assert hits(demo.downbeats, song.downbeats) > 0.85


def test_a_step_of_tempo_is_followed() -> None:
    rng = np.random.default_rng(0)
    first = beat_times(100.0, 20.0)
    second = np.arange(first[-1] + 60.0 / 130.0, 40.0, 60.0 / 130.0)
    beats = np.concatenate([first, second])
    events = []
    for index, at in enumerate(beats):
        events += [(at, kick() if index % 2 == 0 else snare(rng) * 0.6), (at, hat(rng))]
        events += [(at, piano(220.0 * 2.0 ** ((0, 5, 7, 3)[index // 4 % 4] / 12), 0.4))]
    song = listen_samples(mix(40.0, events))
    assert hits(beats, song.beats) > 0.93


def test_the_same_sound_gives_the_same_bytes_whatever_its_blocks() -> None:
    demo = demo_song(12.0)
    audio = Audio(demo.samples.mean(axis=1)[::2].copy(), demo.rate // 2)
    assert listen_samples(audio).to_json() == listen_samples(audio).to_json()


def test_confidence_is_high_on_a_band_and_low_on_noise() -> None:
    demo = demo_song(30.0)
    sure = listen_samples(Audio(demo.samples.mean(axis=1)[::2].copy(), demo.rate // 2))
    noise = np.random.default_rng(0).standard_normal(22050 * 20) * 0.1
    unsure = listen_samples(Audio(noise.astype(np.float32), 22050))
    assert len(sure.confidence) == len(sure.beats)
    assert np.median(sure.confidence) > 0.8
    assert (unsure.confidence < 0.5).mean() > 0.5 if len(unsure.beats) else unsure.tempo == 0.0
