"""The sound inside the page: in time to the sample, the same bytes each time."""

from __future__ import annotations

import base64
import io

import numpy as np
import pytest
import soundfile

from onbeat.errors import AudioError
from onbeat.viewer.contract import AudioData, unpack_curve
from onbeat.viewer.pages import mp3


def decoded(audio: AudioData) -> tuple[np.ndarray, int]:
    kind, data = audio.uri.split(",")
    assert kind == "data:audio/mpeg;base64"
    return soundfile.read(io.BytesIO(base64.b64decode(data)), always_2d=True)


def clicks(rate: int, channels: int) -> np.ndarray:
    """Two seconds with one click, at one second."""
    samples = np.zeros((2 * rate, channels), np.float32)
    samples[rate] = 0.9
    return samples


@pytest.mark.parametrize(("rate", "channels"), [(8000, 1), (22050, 2), (44100, 2), (48000, 6), (96000, 1)])
def test_a_click_stays_where_it_is(rate: int, channels: int) -> None:
    audio = mp3.encode(clicks(rate, channels), rate)
    samples, decoded_rate = decoded(audio)
    assert decoded_rate == audio.rate
    assert audio.seconds == pytest.approx(2.0)
    assert np.argmax(np.abs(samples[:, 0])) / decoded_rate == pytest.approx(1.0, abs=0.001)
    assert samples.shape[1] == (channels if channels <= 2 else 1)


def test_the_same_samples_give_the_same_bytes() -> None:
    samples = np.random.default_rng(3).normal(0, 0.1, (44100, 2)).astype(np.float32)
    assert mp3.encode(samples, 44100) == mp3.encode(samples.copy(), 44100)


def test_the_waveform_shows_where_it_is_loud() -> None:
    samples = np.zeros(44100, np.float32)
    samples[22050:] = 0.5
    level = unpack_curve(mp3.waveform(samples, 44100))
    assert len(level) == 50
    assert level[:24].max() == 0
    assert level[26:].min() == 1


@pytest.mark.parametrize(
    ("samples", "rate", "message"),
    [
        (np.zeros((0, 2)), 44100, r"shape \(0, 2\)"),
        (np.zeros(10), 0, "0 Hz"),
        (np.zeros((2, 3, 4)), 44100, r"shape \(2, 3, 4\)"),
        (np.array([0.0, np.nan]), 44100, "sample 1 of the audio"),
    ],
)
def test_what_is_no_sound_is_refused(samples: np.ndarray, rate: int, message: str) -> None:
    with pytest.raises(AudioError, match=message):
        mp3.encode(samples.astype(np.float32), rate)
