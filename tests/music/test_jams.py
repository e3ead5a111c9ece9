"""A song as JAMS."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import msgspec
import numpy as np
import pytest

from onbeat.music.jams import to_jams
from onbeat.music.song import Section, Song

SONG = Song(
    4.0, 120.0, 2, [0.5, 1.0, 1.5, 2.0], [1.0, 2.0], np.zeros(4), [0.0], [0.5], "m", "A song",
    confidence=[0.9, 0.8, 0.7, 0.6], chord_root=["A:min", "A:min", "N", "C:maj"],
    sections=[Section(0.0, 2.0, "intro"), Section(2.0, 4.0, "main", 0.5)], key="A:minor", tuning=12.0,
)  # fmt: skip


def annotations(song: Song) -> dict[str, list[dict[str, object]]]:
    document = msgspec.json.decode(to_jams(song, "onbeat"))
    assert document["file_metadata"]["jams_version"]
    assert document["file_metadata"]["duration"] == 4.0
    return {annotation["namespace"]: annotation["data"] for annotation in document["annotations"]}


def test_everything_is_there() -> None:
    found = annotations(SONG)
    assert [(row["time"], row["value"], row["confidence"]) for row in found["beat"]] == [
        (0.5, 2, 0.9), (1.0, 1, 0.8), (1.5, 2, 0.7), (2.0, 1, 0.6),
    ]  # fmt: skip
    assert [row["value"]["measure"] for row in found["beat_position"]] == [0, 1, 1, 2]
    assert [(row["time"], row["duration"], row["value"]) for row in found["chord"]] == [
        (0.5, 1.0, "A:min"), (1.5, 0.5, "N"), (2.0, 2.0, "C:maj"),
    ]  # fmt: skip
    assert [row["value"] for row in found["segment_open"]] == ["intro", "main"]
    assert found["tempo"][0]["value"] == 120.0
    assert len(found["tempo"]) == 5
    assert found["key_mode"][0]["value"] == "A:minor"


def test_what_is_not_known_is_left_out() -> None:
    found = annotations(Song(4.0, 0.0, 4, [], [], [], [0.0], [0.5]))
    assert found == {}
    found = annotations(Song(4.0, 120.0, 4, [0.5, 1.0], [0.5], [0, 0], [0.0], [0.5]))
    assert set(found) == {"beat", "beat_position", "tempo"}
    assert found["beat"][0]["confidence"] is None


def test_same_song_same_bytes() -> None:
    assert to_jams(SONG, "onbeat") == to_jams(SONG, "onbeat")


@pytest.mark.skipif(importlib.util.find_spec("jams") is None, reason="the jams package is not installed")
def test_the_jams_package_finds_it_valid(tmp_path: Path) -> None:
    import jams

    (tmp_path / "song.jams").write_bytes(to_jams(SONG, "onbeat"))
    assert jams.load(str(tmp_path / "song.jams"), strict=True).validate(strict=True)
