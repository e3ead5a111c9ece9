"""The song and its document."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.music.song import Song

SONG = Song(
    4.0,
    120.0,
    4,
    [0.5, 1.0, 1.5],
    [0.5],
    [1.0, 0.0, 0.2],
    [0.0, 2.0, 4.0],
    [0.0, 1.0, 0.5],
    "barpointer",
    "x",
    [1, 0.5, 0.2],
)


def test_round_trip() -> None:
    again = Song.from_json(SONG.to_json())
    assert again.to_json() == SONG.to_json()
    assert again.beat_strength.tolist() == [1.0, 0.5, 0.2]


def test_documents_without_beat_strength_are_read() -> None:
    document = msgspec.json.decode(SONG.to_json())
    del document["beat_strength"]
    document["something_new"] = 1
    assert Song.from_json(msgspec.json.encode(document)).beat_strength.tolist() == [1.0, 1.0, 1.0]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "not a song document"),
        (b"[]", "not a song document"),
        (SONG.to_json().replace(b'"version":1', b'"version":9'), "version 9; this onbeat reads version 1"),
        (SONG.to_json().replace(b'"chord_change":[1.0,', b'"chord_change":['), "3 beats has 2 chord changes"),
    ],
)
def test_bad_documents(data: bytes, message: str) -> None:
    with pytest.raises(AudioError, match=message):
        Song.from_json(data)


def test_cut_keeps_arrays_together() -> None:
    part = SONG.cut(0.75, 1.0)
    assert part.beats.tolist() == [0.25, 0.75]
    assert part.beat_strength.tolist() == [0.5, 0.2]
    assert part.downbeats.tolist() == []
    assert part.duration == 1.0


def test_arrays_are_read_only_and_fit() -> None:
    with pytest.raises(ValueError, match="read-only"):
        SONG.beats[0] = 9.0
    with pytest.raises(AudioError, match="beat strengths"):
        Song(1.0, 120.0, 4, [0.5], [], [0.0], [0.0], [0.0], beat_strength=np.ones(2))
    assert SONG.intensity_at(np.array([1.0, 9.0])).tolist() == [0.5, 0.5]
