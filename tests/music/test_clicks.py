"""Clicks over a song."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.errors import OnbeatError
from onbeat.music.clicks import (
    BEAT_TONE,
    DOWNBEAT_TONE,
    SONG_LEVEL,
    stream_with_clicks,
    with_clicks,
    write_with_clicks,
)
from onbeat.music.song import Song

SONG = Song(3.0, 60.0, 4, [0.5, 1.5, 2.99], [1.5], np.zeros(3), [0.0], [0.5])
RATE = 8000


def tone_at(samples: np.ndarray, at: float) -> float:
    stretch = samples[round(at * RATE) : round((at + 0.04) * RATE)]
    spectrum = np.abs(np.fft.rfft(stretch, 8000))
    return float(spectrum.argmax())


def test_clicks_are_at_beats_and_higher_at_downbeats() -> None:
    mixed = with_clicks(np.zeros((3 * RATE, 2), np.float32), RATE, SONG)
    assert abs(tone_at(mixed[:, 0], 0.5) - BEAT_TONE) < 30
    assert abs(tone_at(mixed[:, 1], 1.5) - DOWNBEAT_TONE) < 30
    assert np.abs(mixed[round(0.6 * RATE) : round(1.5 * RATE)]).max() == 0.0
    assert np.abs(mixed[round(1.5 * RATE) :]).max() > np.abs(mixed[: round(1.0 * RATE)]).max()


def test_never_past_full_scale_and_the_song_is_untouched(tmp_path: Path) -> None:
    loud = np.ones((3 * RATE, 1), np.float32)
    write_with_clicks(tmp_path / "clicks.wav", loud, RATE, SONG)
    written, rate = soundfile.read(tmp_path / "clicks.wav")
    assert rate == RATE
    assert len(written) == 3 * RATE
    assert np.abs(written).max() < 1.0  # nothing was cut off
    assert loud.min() == 1.0


def test_downbeats_are_louder_by_more_than_three_decibels() -> None:
    mixed = with_clicks(np.zeros((3 * RATE, 1), np.float32), RATE, SONG)

    def level(at: float) -> float:
        return float(np.abs(mixed[round(at * RATE) : round((at + 0.04) * RATE)]).max())

    assert level(1.5) > 10 ** (3 / 20) * level(0.5)


def test_a_quiet_song_is_heard_beside_its_clicks() -> None:
    rng = np.random.default_rng(0)
    quiet = (0.1 * rng.uniform(-1.0, 1.0, (3 * RATE, 1))).astype(np.float32)
    mixed = with_clicks(quiet, RATE, SONG)
    assert np.abs(mixed[round(0.6 * RATE) : RATE]).max() == pytest.approx(SONG_LEVEL, rel=0.01)


@pytest.mark.parametrize(
    ("ending", "rate", "channels", "kept"),
    [("wav", 8000, 1, 1), ("wav", 192000, 2, 2), ("flac", 44100, 2, 2), ("ogg", 48000, 1, 1), ("wav", 22050, 6, 1)],
)
def test_rate_and_stereo_are_kept(tmp_path: Path, ending: str, rate: int, channels: int, kept: int) -> None:
    silence = np.zeros((3 * rate, channels), np.float32)
    write_with_clicks(tmp_path / f"clicks.{ending}", silence, rate, SONG)
    samples, written = soundfile.read(tmp_path / f"clicks.{ending}", always_2d=True)
    assert written == rate
    assert samples.shape == (3 * rate, kept)
    loudest = np.abs(samples[:, 0]).argmax() / rate
    assert 1.5 <= loudest < 1.55
    assert list(tmp_path.iterdir()) == [tmp_path / f"clicks.{ending}"]


def test_blocks_of_any_size_give_the_same(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    sound = (0.5 * rng.uniform(-1.0, 1.0, (3 * RATE, 2))).astype(np.float32)
    for name, size in (("one", len(sound)), ("two", 777)):
        parts = [(sound[begin : begin + size], RATE) for begin in range(0, len(sound), size)]
        stream_with_clicks(tmp_path / f"{name}.wav", lambda parts=parts: parts, SONG)
    assert (tmp_path / "one.wav").read_bytes() == (tmp_path / "two.wav").read_bytes()


def test_a_folder_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(OnbeatError, match=r"cannot write .*nowhere"):
        write_with_clicks(tmp_path / "nowhere" / "a.wav", np.zeros((RATE, 1), np.float32), RATE, SONG)
