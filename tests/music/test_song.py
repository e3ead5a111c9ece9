"""The song and its document."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.music.song import Section, Song

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


FULL = replace(
    SONG,
    confidence=[0.9, 0.5, 0.1],
    chord_root=["A:min", "N", "C:maj"],
    sections=[Section(0.0, 1.2, "intro"), Section(1.2, 4.0, "main", 0.4)],
    key="A:minor",
    tuning=-12.5,
)


def test_everything_new_makes_the_round_trip() -> None:
    again = Song.from_json(FULL.to_json())
    assert again.to_json() == FULL.to_json()
    assert again.confidence.tolist() == [0.9, 0.5, 0.1]
    assert again.chord_root == ("A:min", "N", "C:maj")
    assert again.sections == FULL.sections
    assert (again.key, again.tuning) == ("A:minor", -12.5)
    np.testing.assert_allclose(again.tempo_curve.bpm, 120.0)


def test_documents_of_before_are_read() -> None:
    document = msgspec.json.decode(FULL.to_json())
    for name in ("confidence", "tempo_curve", "chord_root", "sections", "key", "tuning"):
        del document[name]
    old = Song.from_json(msgspec.json.encode(document))
    assert len(old.confidence) == len(old.chord_root) == len(old.sections) == 0
    np.testing.assert_allclose(old.tempo_curve.bpm, 120.0)  # it follows from the beats


def test_other_beats_lose_what_belonged_to_the_old_ones() -> None:
    fewer = replace(FULL, beats=[0.5, 1.5], downbeats=[0.5], chord_change=[0, 0], beat_strength=[1, 1])
    assert len(fewer.confidence) == len(fewer.chord_root) == 0
    assert fewer.sections == FULL.sections


@pytest.mark.parametrize(("field", "values"), [("confidence", [0.5]), ("chord_root", ["N"])])
def test_a_document_whose_lists_disagree_is_refused(field: str, values: list[object]) -> None:
    document = msgspec.json.decode(FULL.to_json())
    document[field] = values
    with pytest.raises(AudioError, match=r"s.json: 3 beats have 1 (confidences|chord roots); expected one for each"):
        Song.from_json(msgspec.json.encode(document), "s.json")


def test_a_cut_keeps_what_lies_in_it() -> None:
    part = FULL.cut(0.75, 1.0)
    assert part.confidence.tolist() == [0.5, 0.1]
    assert part.chord_root == ("N", "C:maj")
    assert [(s.start, s.end, s.kind) for s in part.sections] == [(0.0, 1.2 - 0.75, "intro"), (1.2 - 0.75, 1.0, "main")]
    assert part.key == "A:minor"
    assert len(SONG.cut(0.75, 1.0).confidence) == 0
