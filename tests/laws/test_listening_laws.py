"""What must not change what is heard: a pause before, the volume, the sample rate, the number of threads, a cut."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

import numpy as np
import pytest
import soxr
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.music import Song, listen_samples
from onbeat.music.audio import Audio
from sounds import beat_times, hat, kick, mix, piano, snare


def band(seconds: float = 16.0, bpm: float = 110.0) -> Audio:
    rng = np.random.default_rng(3)
    events = []
    for index, at in enumerate(beat_times(bpm, seconds)):
        events += [(at, kick() if index % 2 == 0 else snare(rng)), (at + 30.0 / bpm, hat(rng))]
        root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // 4 % 4] / 12)
        events += [(at, piano(root * ratio, 0.5, 0.2)) for ratio in (1.0, 2.0, 2.52, 3.0)]
    return mix(seconds, events)


@cache
def reference() -> tuple[Audio, Song]:
    audio = band()
    return audio, listen_samples(audio)


def same_beats(song: Song, times: np.ndarray, within: float) -> None:
    """Every one of the times is heard, and nothing else among them."""
    inside = song.beats[(song.beats > times[0] - 0.2) & (song.beats < times[-1] + 0.2)]
    assert len(inside) == len(times)
    assert np.abs(inside - times).max() < within


@settings(max_examples=8, deadline=None)
@given(st.floats(0.0, 3.0))
def test_a_pause_before_shifts_the_beats(pause: float) -> None:
    audio, song = reference()
    samples = round(pause * audio.rate)
    shifted = listen_samples(Audio(np.concatenate([np.zeros(samples, np.float32), audio.samples]), audio.rate))
    same_beats(shifted, song.beats[1:-1] + samples / audio.rate, 0.006)


@settings(max_examples=8, deadline=None)
@given(st.floats(-46.0, 3.0))
def test_volume_does_not_matter(decibels: float) -> None:
    audio, song = reference()
    louder = listen_samples(Audio(audio.samples * np.float32(10.0 ** (decibels / 20.0)), audio.rate))
    same_beats(louder, song.beats, 0.006)
    assert len(louder.downbeats) == len(song.downbeats)
    np.testing.assert_allclose(louder.intensity, song.intensity, atol=0.01)
    np.testing.assert_allclose(louder.chord_change, song.chord_change, atol=0.05)


@pytest.mark.parametrize("rate", [8000, 11025, 44100, 48000])
def test_the_sample_rate_hardly_matters(rate: int) -> None:
    audio, song = reference()
    other = Audio(soxr.resample(audio.samples, audio.rate, rate), rate)
    same_beats(listen_samples(other), song.beats[1:-1], 0.007)


@pytest.mark.parametrize("start", [2.0, 5.3])
def test_a_cut_song_has_the_beats_of_the_whole(start: float) -> None:
    audio, song = reference()
    part = listen_samples(Audio(audio.samples[round(start * audio.rate) :], audio.rate))
    expected = song.cut(start, 60.0)
    same_beats(part, expected.beats[2:-1], 0.006)
    assert part.tempo == pytest.approx(expected.tempo, rel=5e-3)


def test_threads_do_not_matter() -> None:
    program = (
        "import sys, numpy as np; from onbeat.music import listen_samples; from onbeat.music.audio import Audio;"
        "audio = Audio(np.frombuffer(sys.stdin.buffer.read(), np.float32), 22050);"
        "sys.stdout.buffer.write(listen_samples(audio).to_json())"
    )
    samples = reference()[0].samples.tobytes()
    documents = [
        subprocess.run(
            [sys.executable, "-c", program],
            input=samples,
            capture_output=True,
            check=True,
            env={**os.environ, "OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
        ).stdout
        for threads in ("1", "2")
    ]
    assert documents[0] == documents[1]
    assert documents[0] == reference()[1].to_json()
