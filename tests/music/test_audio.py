"""Reading sound: formats, rates, channels, stretches, and every way a file can be bad."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.errors import AudioError
from onbeat.music.audio import AudioWarning, audio_duration, read_audio, read_blocks, read_stereo
from sounds import click, mix

CLICKS = (0.5, 1.1, 2.7)


@pytest.fixture(scope="module")
def sound() -> np.ndarray:
    return mix(4.0, [(at, click()) for at in CLICKS], rate=44100).samples


def write(path: Path, samples: np.ndarray, rate: int = 44100, **options: str) -> Path:
    soundfile.write(path, samples, rate, **options)
    return path


def loudest_moments(samples: np.ndarray, rate: int) -> np.ndarray:
    """Where each click is: the loudest sample in the 0.1 s from its time on."""
    found = []
    for at in CLICKS:
        begin = round((at - 0.05) * rate)
        found.append((begin + np.abs(samples[begin : begin + round(0.1 * rate)]).argmax()) / rate)
    return np.array(found)


@pytest.mark.parametrize("ending", ["wav", "flac", "ogg", "mp3"])
def test_formats_keep_time(tmp_path: Path, sound: np.ndarray, ending: str) -> None:
    path = write(tmp_path / f"song.{ending}", sound)
    audio = read_audio(path)
    assert audio.rate == 22050
    assert audio.samples.dtype == np.float32
    assert audio.duration == pytest.approx(4.0, abs=0.05)
    assert np.abs(loudest_moments(audio.samples, audio.rate) - CLICKS).max() < 0.003


def test_mp3_is_read_in_parts_as_it_is_at_once(
    tmp_path: Path, sound: np.ndarray, capfd: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "song.mp3", sound)
    np.testing.assert_allclose(read_stereo(path)[0], soundfile.read(path, always_2d=True)[0], atol=1e-5)
    assert capfd.readouterr().err == ""  # the decoder itself complains there


@pytest.mark.parametrize("rate", [8000, 22050, 48000, 192000])
def test_rates_keep_time(tmp_path: Path, rate: int) -> None:
    sound = mix(4.0, [(at, click()) for at in CLICKS], rate=rate).samples
    audio = read_audio(write(tmp_path / "song.wav", sound, rate))
    assert len(audio.samples) == pytest.approx(4.0 * 22050, abs=3)
    assert np.abs(loudest_moments(audio.samples, audio.rate) - CLICKS).max() < 0.002


def test_channels_are_mixed_down(tmp_path: Path, sound: np.ndarray) -> None:
    six = write(tmp_path / "six.wav", np.stack([sound] * 6, axis=1))
    one = write(tmp_path / "one.wav", sound)
    np.testing.assert_allclose(read_audio(six).samples, read_audio(one).samples, atol=1e-4)
    assert read_stereo(six)[0].shape[1] == 1
    two = write(tmp_path / "two.wav", np.stack([sound, -0.5 * sound], axis=1))
    stereo, rate = read_stereo(two, 1.0, 2.0)
    assert stereo.shape == (2 * 44100, 2)
    assert rate == 44100
    np.testing.assert_allclose(stereo[:, 1], -0.5 * stereo[:, 0], atol=1e-4)


def test_stretch_and_duration(tmp_path: Path, sound: np.ndarray) -> None:
    path = write(tmp_path / "song.flac", sound)
    assert audio_duration(path) == pytest.approx(4.0)
    part = read_audio(path, start=1.0, seconds=2.0, rate=44100).samples
    np.testing.assert_array_equal(part, read_audio(path, rate=44100).samples[44100 : 3 * 44100])
    assert read_audio(path, start=3.0, seconds=60.0).duration == pytest.approx(1.0, abs=1e-3)


def test_blocks_are_the_whole(tmp_path: Path) -> None:
    noise = 0.1 * np.random.default_rng(1).standard_normal(50 * 8000)
    path = write(tmp_path / "long.wav", noise, 8000)
    blocks = list(read_blocks(path, rate=8000))
    assert len(blocks) > 1
    np.testing.assert_allclose(np.concatenate(blocks), noise, atol=1e-4)


def test_the_sound_of_a_container(tmp_path: Path, sound: np.ndarray) -> None:
    av = pytest.importorskip("av")
    path = tmp_path / "song.mkv"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("pcm_s16le", rate=44100)
        stream.layout = "mono"
        frame = av.AudioFrame.from_ndarray((sound[None] * 32767).astype(np.int16), format="s16", layout="mono")
        frame.sample_rate = 44100
        for packet in [*stream.encode(frame), *stream.encode(None)]:
            container.mux(packet)
    audio = read_audio(path)
    assert np.abs(loudest_moments(audio.samples, audio.rate) - CLICKS).max() < 0.003
    assert read_audio(path, start=1.0, seconds=1.0).duration == pytest.approx(1.0, abs=0.01)


def test_cut_off_file_is_used_with_a_warning(tmp_path: Path) -> None:
    noise = 0.1 * np.random.default_rng(1).standard_normal(4 * 22050)
    path = write(tmp_path / "song.flac", noise, 22050)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.warns(AudioWarning, match=r"1\.\d s of 4\.0 s can be read"):
        audio = read_audio(path)
    np.testing.assert_allclose(audio.samples, noise[: len(audio.samples)], atol=1e-4)


def test_too_much_cut_off_is_refused(tmp_path: Path, sound: np.ndarray) -> None:
    path = write(tmp_path / "song.flac", sound)
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(AudioError, match="use a whole copy"):
        read_audio(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [(b"", "0 bytes"), (b"this is not a song\n" * 99, "expected wav, flac, ogg or mp3")],
)
def test_no_sound(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "song.wav"
    path.write_bytes(content)
    with pytest.raises(AudioError, match=message):
        read_audio(path)


def test_bad_places(tmp_path: Path, sound: np.ndarray) -> None:
    with pytest.raises(AudioError, match="no such file"):
        read_audio(tmp_path / "none.wav")
    with pytest.raises(AudioError, match="is a folder"):
        read_audio(tmp_path)
    path = write(tmp_path / "song.wav", sound)
    with pytest.raises(AudioError, match=r"is 4\.0 s long"):
        read_audio(path, start=5.0)
    with pytest.raises(AudioError, match="start -1 s"):
        read_audio(path, start=-1.0)
    with pytest.raises(AudioError, match="length 0 s"):
        read_audio(path, seconds=0.0)


def test_numbers_that_are_none(tmp_path: Path, sound: np.ndarray) -> None:
    broken = sound.copy()
    broken[44100] = np.nan
    path = write(tmp_path / "song.wav", broken, subtype="FLOAT")
    with pytest.raises(AudioError, match=r"not a number at 1\.00 s"):
        read_audio(path)


def test_zero_length(tmp_path: Path) -> None:
    path = write(tmp_path / "song.wav", np.zeros(0))
    with pytest.raises(AudioError, match="0 samples"):
        read_audio(os.fspath(path))


@pytest.mark.parametrize("channels", [1, 2, 6])
def test_high_rates_can_be_brought_down_as_they_stream(tmp_path: Path, sound: np.ndarray, channels: int) -> None:
    fast = np.repeat(mix(4.0, [(at, click()) for at in CLICKS], rate=96000).samples[:, None], channels, axis=1)
    path = write(tmp_path / "fast.wav", fast, 96000)
    samples, rate = read_stereo(path, highest=48000)
    assert rate == 48000
    assert samples.shape == (4 * 48000, channels if channels < 3 else 1)
    assert np.abs(loudest_moments(samples[:, 0], rate) - CLICKS).max() < 0.002
    assert read_stereo(path)[1] == 96000
    assert read_stereo(write(tmp_path / "slow.wav", sound), highest=48000)[1] == 44100
