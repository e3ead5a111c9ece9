"""Sound as it comes: any rate, any number of channels, damaged, silent or odd, is heard right or refused clearly."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import soundfile
import soxr

from onbeat.errors import AudioError
from onbeat.music import Song, listen
from onbeat.music.audio import AudioWarning
from sounds import RATE, beat_times, hat, kick, mix, piano, snare

SECONDS = 16.0
BEATS = beat_times(112.0, SECONDS)


@cache
def band() -> np.ndarray:
    """Samples at 44.1 kHz."""
    rng = np.random.default_rng(0)
    events = []
    for index, at in enumerate(BEATS):
        root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // 4 % 4] / 12)
        events += [(at, kick() if index % 2 == 0 else snare(rng)), (at + 0.268, hat(rng)), (at, piano(root, 0.5, 0.3))]
    return mix(SECONDS, events, rate=RATE).samples.astype(np.float64)


def heard_right(song: Song, beats: np.ndarray = BEATS, within: float = 0.02) -> None:
    assert song.tempo == pytest.approx(112.0, rel=0.005)
    assert np.abs(song.beats[:, None] - beats).min(axis=1).max() < within
    assert abs(len(song.beats) - len(beats)) <= 2


@pytest.mark.parametrize("rate", [8000, 11025, 16000, 32000, 96000, 192000])
def test_any_rate(tmp_path: Path, rate: int) -> None:
    soundfile.write(tmp_path / "a.wav", soxr.resample(band(), RATE, rate), rate)
    heard_right(listen(tmp_path / "a.wav"))


@pytest.mark.parametrize("channels", [1, 2, 6, 8])
def test_any_number_of_channels(tmp_path: Path, channels: int) -> None:
    silent = np.zeros((len(band()), channels))
    silent[:, channels - 1] = band()  # in the last alone
    soundfile.write(tmp_path / "a.wav", silent, RATE)
    heard_right(listen(tmp_path / "a.wav"))


@pytest.mark.parametrize(
    ("kind", "make"),
    [
        ("clipped hard", lambda x: np.clip(20.0 * x, -1.0, 1.0)),
        ("quiet", lambda x: 0.003 * x),
        ("on a direct current", lambda x: 0.4 * x + 0.5),
        ("upside down", lambda x: -x),
        ("with hum", lambda x: 0.5 * x + 0.05 * np.sin(2.0 * np.pi * 50.0 * np.arange(len(x)) / RATE)),
        ("louder than full scale", lambda x: 30.0 * x),
    ],
)
def test_any_level(tmp_path: Path, kind: str, make: object) -> None:
    soundfile.write(tmp_path / "a.wav", make(band()), RATE, subtype="FLOAT")  # type: ignore[operator]
    heard_right(listen(tmp_path / "a.wav"), within=0.03)


def test_a_cut_mp3_is_heard_as_far_as_it_goes(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "whole.mp3", band(), RATE)
    data = (tmp_path / "whole.mp3").read_bytes()
    (tmp_path / "cut.mp3").write_bytes(data[: len(data) * 5 // 8])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AudioWarning)
        song = listen(tmp_path / "cut.mp3")
    assert 8.0 < song.duration < 11.0
    heard_right(song, BEATS[song.duration > BEATS], within=0.04)


def test_a_corrupt_mp3_is_heard_around_the_damage_or_refused(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "whole.mp3", band(), RATE)
    data = bytearray((tmp_path / "whole.mp3").read_bytes())
    rng = np.random.default_rng(0)
    for at in rng.integers(2000, len(data), 300):
        data[at] = int(rng.integers(256))
    (tmp_path / "corrupt.mp3").write_bytes(bytes(data))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AudioWarning)
        try:
            song = listen(tmp_path / "corrupt.mp3")
        except AudioError as error:
            assert "corrupt.mp3" in str(error)  # noqa: PT017
        else:
            assert np.isfinite(song.beats).all()
            assert song.duration <= SECONDS + 0.1


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.mp3", b"", "the file is empty"),
        ("a.mp3", b"\xff\xfb" + bytes(50), "not a sound file|holds no sound|damaged|too short"),
        ("a.wav", b"RIFF\x24\x00\x00\x00WAVEfmt ", "not a sound file|holds no sound"),
        ("a.ogg", b"OggS" + bytes(100), "not a sound file"),
    ],
)
def test_what_is_no_sound_is_refused(tmp_path: Path, name: str, data: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(AudioError, match=message):
        listen(tmp_path / name)


@pytest.mark.parametrize(("seconds", "level"), [(0.01, 0.1), (0.5, 0.1), (10.0, 0.0), (10.0, 1e-6)])
def test_too_short_or_silent_is_refused(tmp_path: Path, seconds: float, level: float) -> None:
    samples = level * np.random.default_rng(0).standard_normal(round(seconds * RATE))
    soundfile.write(tmp_path / "a.wav", samples, RATE, subtype="FLOAT")
    with pytest.raises(AudioError, match=r"too short to hear a beat in|silent for all of its 10\.0 s"):
        listen(tmp_path / "a.wav")


def test_an_hour_takes_little_memory(tmp_path: Path) -> None:
    """At most 0.1 MB a second, so that three hours stay under 1.5 GB; measured from five minutes against a half."""
    pytest.importorskip("resource")
    part = soxr.resample(band(), RATE, 22050).astype(np.float32)
    code = (
        "import json, resource, sys; from onbeat.music import listen; song = listen(sys.argv[1]); "
        "print(json.dumps([resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, song.duration]))"
    )
    found: list[list[float]] = []
    for minutes in (0.5, 5.0):
        soundfile.write(tmp_path / "a.wav", np.tile(part, round(minutes * 60 / SECONDS)), 22050)
        run = subprocess.run([sys.executable, "-c", code, str(tmp_path / "a.wav")], capture_output=True, check=True)
        found.append(json.loads(run.stdout))
    (little, short), (much, long) = found
    unit = 1.0 if sys.platform == "darwin" else 1024.0  # bytes
    assert unit * (much - little) / (long - short) < 0.1e6
