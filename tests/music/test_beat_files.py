"""Beats from files, and what is said of files that hold none."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.errors import AudioError
from onbeat.music.beat_files import read_beats


def written(folder: Path, text: str | bytes, name: str = "song.beats") -> Path:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


@pytest.mark.parametrize(
    ("name", "text", "times", "places"),
    [
        ("a.beats", "0.5\t1\n1.0\t2\n1.5\t3\n", [0.5, 1.0, 1.5], [1, 2, 3]),
        ("a.txt", "0.5\n1\n\n1.5", [0.5, 1.0, 1.5], None),
        ("a.txt", "# tapped\n0.5 1 # here\n1.0 2\n", [0.5, 1.0], [1, 2]),
        ("a.csv", "time,beat,chord_change\n0.5,4,0.1\n1.0,1,0.9\n", [0.5, 1.0], [4, 1]),
        ("a.csv", "0,5;1\r\n", [], None),
        ("a.beats", "\ufeff0.5\r\n1e0\r\n", [0.5, 1.0], None),
        ("a.json", "[0.5, 1, 1.5]", [0.5, 1.0, 1.5], None),
        ("a.json", '{"beats": [0.5, 1, 1.5, 2], "downbeats": [1]}', [0.5, 1.0, 1.5, 2.0], [4, 1, 2, 3]),
        ("a.json", '{"beats": [0.5, 1, 1.5, 2, 2.5], "downbeats": [1, 2]}', [0.5, 1.0, 1.5, 2.0, 2.5], [2, 1, 2, 1, 2]),
    ],
)
def test_what_people_write_is_read(
    tmp_path: Path, name: str, text: str, times: list[float], places: list[int] | None
) -> None:
    path = written(tmp_path, text, name)
    if not times:
        with pytest.raises(AudioError):
            read_beats(path)
        return
    found = read_beats(path, 10.0)
    assert found.times.tolist() == times
    assert (None if found.places is None else found.places.tolist()) == places


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.beats", "0.5\n1.0\n0.9\n", r"a.beats:3: 0.9 s does not follow the 1 s before it"),
        ("a.beats", "0.5\n0.5\n", r"a.beats:2: .*have to increase"),
        ("a.beats", "0.5\n11\n", r"a.beats:2: 11 s lies outside of the song, which lasts from 0 to 10.00 s"),
        ("a.beats", "-1\n2\n", r"a.beats:1: -1 s lies outside"),
        ("a.beats", "0.5\nnan\n", r"a.beats:2: nan is not a time"),
        ("a.beats", "0.5\ninf\n", r"a.beats:2: inf is not a time"),
        ("a.beats", "0.5\nhalf\n", r"a.beats:2: 'half' is not a time"),
        ("a.beats", "0.5\n", r"a.beats: holds 1 beats; expected at least 2"),
        ("a.beats", "", r"holds 0 beats"),
        ("a.beats", "0.5 1\n1.0\n", r"a.beats:2: no place in the bar"),
        ("a.beats", "0.5 1\n1.0 2.5\n", r"a.beats:2: place '2.5' in the bar"),
        ("a.beats", "0.5 0\n", r"a.beats:1: place '0'"),
        ("a.beats", b"\xff\xfe\x00\x81", r"is not text"),
        ("a.json", "[0.5", r"a.json: is not JSON"),
        ("a.json", '{"times": [1, 2]}', r"its beats are no list of numbers"),
        ("a.json", '{"beats": [1, "x"]}', r"its beats are no list of numbers"),
        ("a.json", '{"beats": [1, true]}', r"its beats are no list of numbers"),
        ("a.json", '{"beats": [1, 2], "downbeats": [1.5]}', r"one of the downbeats is not among the beats"),
        ("a.json", "[2, 1]", r"a.json: beat 2: 1 s does not follow"),
        ("a.json", "[" * 5000, r"is not JSON"),
        ("a.json", "[1, 1" + "0" * 400 + "]", r"too large|outside|is not JSON"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(tmp_path: Path, name: str, text: str | bytes, message: str) -> None:
    with pytest.raises(AudioError, match=message):
        read_beats(written(tmp_path, text, name), 10.0)


def test_no_file_and_a_folder(tmp_path: Path) -> None:
    with pytest.raises(AudioError, match="cannot be read: No such file"):
        read_beats(tmp_path / "none.beats")
    with pytest.raises(AudioError, match="cannot be read"):
        read_beats(tmp_path)
