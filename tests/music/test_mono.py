"""From channels to one: the mean, unless it is silence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.music.audio import AudioWarning, read_audio
from onbeat.music.mono import Mono
from sounds import click, mix

RATE = 22050


def noise(channels: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, 0.1, (4000, channels)).astype(np.float32)


@pytest.mark.parametrize("channels", [1, 2, 6, 64])
def test_channels_that_have_nothing_in_common_are_mixed(channels: int) -> None:
    block = noise(channels)
    mono = Mono()
    np.testing.assert_array_equal(mono(block), block.mean(axis=1, dtype=np.float32))
    assert mono.one is None


@pytest.mark.parametrize("right", [0.0, 0.5, -0.5])
def test_a_mean_that_is_heard_is_heard(right: float) -> None:
    one = noise(1)
    mono = Mono()
    np.testing.assert_allclose(
        mono(np.hstack([one, right * one]).astype(np.float32)), 0.5 * (1 + right) * one[:, 0], atol=1e-7
    )


def test_of_channels_that_cancel_out_the_louder_is_heard_from_there_on() -> None:
    one, rest = noise(1), noise(2, seed=1)
    mono = Mono()
    np.testing.assert_array_equal(mono(rest), rest.mean(axis=1, dtype=np.float32))
    np.testing.assert_array_equal(mono(np.hstack([one, -1.05 * one]).astype(np.float32)), -1.05 * one[:, 0])
    assert mono.one == 1
    np.testing.assert_array_equal(mono(rest), rest[:, 1])


def test_silence_decides_nothing() -> None:
    mono = Mono()
    mono(np.zeros((100, 2), np.float32))
    assert mono.one is None


def test_a_song_with_a_swapped_wire_is_heard_and_told(tmp_path: Path) -> None:
    sound = mix(4.0, [(at, click()) for at in (0.5, 1.1, 2.7)], rate=RATE).samples
    soundfile.write(tmp_path / "swapped.wav", np.stack([sound, -0.98 * sound], axis=1), RATE)
    with pytest.warns(
        AudioWarning, match=r"swapped\.wav: its channels cancel each other out.*channel 1 is heard alone"
    ):
        heard = read_audio(tmp_path / "swapped.wav")
    np.testing.assert_allclose(heard.samples, sound, atol=1e-4)
