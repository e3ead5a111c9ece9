"""Files that end before their header says: told of WAV and AIFF, where libsndfile says nothing."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.music.audio import AudioWarning, read_audio
from onbeat.music.promised import promised_share

SOUND = 0.1 * np.random.default_rng(0).standard_normal((8 * 8000, 1))


def written(path: Path, kept: float = 1.0, subtype: str | None = None) -> Path:
    """A sound of 8 s, of which a share of the file is kept."""
    soundfile.write(path, SOUND, 8000, subtype)
    data = path.read_bytes()
    path.write_bytes(data[: round(kept * len(data))])
    return path


@pytest.mark.parametrize("ending", ["wav", "aiff"])
def test_a_cut_off_file_is_told(tmp_path: Path, ending: str) -> None:
    path = written(tmp_path / f"song.{ending}", 0.5)
    assert promised_share(path) == pytest.approx(2.0, abs=0.01)
    for start, seconds in ((0.0, None), (1.0, None), (1.0, 60.0)):
        with pytest.warns(AudioWarning, match=r"damaged or cut off: [34]\.0 s of [78]\.0 s can be read and are used"):
            read_audio(path, start, seconds)


def test_a_stretch_that_is_there_is_not(tmp_path: Path) -> None:
    path = written(tmp_path / "song.wav", 0.5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_audio(path, 0.5, 2.0).duration == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("ending", "subtype"), [("wav", "PCM_24"), ("wav", "FLOAT"), ("aiff", "PCM_16"), ("flac", "PCM_16")]
)
def test_whole_files_promise_what_they_have(tmp_path: Path, ending: str, subtype: str) -> None:
    assert promised_share(written(tmp_path / f"song.{ending}", subtype=subtype)) == 1.0


@pytest.mark.parametrize("size", [0xFFFFFFFF, 0x7FFFF000, 0])
def test_streams_that_did_not_know_their_length_are_whole(tmp_path: Path, size: int) -> None:
    path = written(tmp_path / "stream.wav")
    data = bytearray(path.read_bytes())
    at = data.index(b"data") + 4
    data[at : at + 4] = size.to_bytes(4, "little")
    data[4:8] = (size or 8).to_bytes(4, "little")
    path.write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_audio(path).duration == pytest.approx(8.0, abs=0.01)


def test_what_is_no_such_file_promises_nothing(tmp_path: Path) -> None:
    for name, data in (
        ("short.wav", b"RIFF"),
        ("none.wav", b"RIFF\x10\x00\x00\x00WAVEfmt "),
        ("text.wav", b"words " * 9),
    ):
        (tmp_path / name).write_bytes(data)
        assert promised_share(tmp_path / name) == 1.0
    assert promised_share(tmp_path / "missing.wav") == 1.0
