"""No beat found is an answer."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music import Song, listen_samples
from onbeat.music.audio import Audio
from sounds import beat_times, hat, kick, mix, piano

SAMPLES = 22050 * 12


def heard(samples: np.ndarray) -> Song:
    return listen_samples(Audio(samples.astype(np.float32), 22050))


@pytest.mark.parametrize("kind", ["white noise", "swelling noise", "pink noise", "hum", "constant", "one click"])
def test_what_has_no_beat_has_none(kind: str) -> None:
    rng = np.random.default_rng(0)
    times = np.arange(SAMPLES) / 22050
    sound = {
        "white noise": 0.1 * rng.standard_normal(SAMPLES),
        "swelling noise": 0.1 * rng.standard_normal(SAMPLES) * (1.0 + 0.5 * np.sin(0.4 * times)),
        "pink noise": 0.1
        * np.fft.irfft(np.fft.rfft(rng.standard_normal(SAMPLES)) / np.sqrt(np.arange(SAMPLES // 2 + 1) + 9)),
        "hum": 0.3 * np.sin(2.0 * np.pi * 100.0 * times) + 0.1 * np.sin(2.0 * np.pi * 300.0 * times),
        "constant": np.full(SAMPLES, 0.5),
        "one click": 0.9 * np.eye(1, SAMPLES, SAMPLES // 2)[0],
    }[kind]
    song = heard(sound / max(np.abs(sound).max(), 1.0))
    assert len(song.beats) == len(song.downbeats) == len(song.chord_change) == len(song.chord_root) == 0
    assert song.tempo == 0.0
    assert len(song.intensity) > 100
    assert Song.from_json(song.to_json()).to_json() == song.to_json()


def test_soft_music_has_beats() -> None:
    beats = beat_times(90.0, 12.0)
    song = heard(0.01 * mix(12.0, [(at, piano(262.0, 0.6, 0.3, attack=0.03)) for at in beats]).samples)
    assert abs(len(song.beats) - len(beats)) <= 2


def test_drums_in_noise_have_beats() -> None:
    rng = np.random.default_rng(0)
    beats = beat_times(110.0, 12.0)
    events = [(at, kick() if index % 2 == 0 else hat(rng)) for index, at in enumerate(beats)]
    drums = mix(12.0, events).samples
    assert abs(len(heard(drums + 0.02 * rng.standard_normal(len(drums))).beats) - len(beats)) <= 2
