"""``onbeat listen`` as people run it."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
import soundfile

from onbeat.cli import main
from sounds import click_track

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


@pytest.fixture(scope="module")
def song(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("songs") / "clicks.wav"
    _, audio = click_track(120, 8.0)
    soundfile.write(path, audio.samples, audio.rate)
    return path


def run(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["onbeat", "listen", *map(str, words)])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def test_table(song: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(monkeypatch, song) == 0
    out, err = capsys.readouterr()
    assert "120.0" in out
    assert "8.00 s" in out
    assert err == ""


def test_json_and_files(
    song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    document, clicks, picture = tmp_path / "song.json", tmp_path / "clicks.wav", tmp_path / "song.png"
    assert run(monkeypatch, song, "-o", document, "--click", clicks, "--plot", picture, "--json", "--start", 1) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads(document.read_bytes())
    assert printed["duration"] == pytest.approx(7.0)
    assert printed["beats"][0] == pytest.approx(0.237, abs=0.01)
    assert soundfile.info(clicks).duration == pytest.approx(7.0)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_csv_by_the_paper(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(monkeypatch, song, "-o", tmp_path / "song.csv", "--method", "shiratori2006") == 0
    beats = np.loadtxt(tmp_path / "song.csv", delimiter=",", skiprows=1, usecols=0)
    assert np.median(np.diff(beats)) == pytest.approx(0.5, abs=0.011)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("missing.wav",), "missing.wav: no such file"),
        (("SONG", "--method", "ear"), "there are barpointer, onsets, shiratori2006"),
        (("SONG", "-o", "song.txt"), "use .json, .csv or .jams"),
        (("SONG", "--click", "song.mp4"), "use .wav, .flac or .ogg"),
        (("SONG", "--plot", "song"), "cannot write a file without ending; use .png, .svg or .pdf"),
        (("SONG", "--beats", "none.beats"), "none.beats: cannot be read"),
        (("SONG", "--beats", "a", "--tap", "b"), "give one of the two files"),
        (("SONG", "--meter", "99"), "meter 99: expected 1 to 16"),
        (("SONG", "--seconds", "0.5"), "too short"),
        (("SONG", "-o", "nowhere/song.json"), "cannot write"),
    ],
)
def test_errors_are_one_line(
    song: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, *(str(song) if word == "SONG" else word for word in words)) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_song_as_jams_and_as_svg(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(monkeypatch, song, "-o", tmp_path / "a.jams", "--plot", tmp_path / "a.svg") == 0
    names = [part["namespace"] for part in json.loads((tmp_path / "a.jams").read_bytes())["annotations"]]
    assert "beat" in names
    assert b"<svg" in (tmp_path / "a.svg").read_bytes()


def test_beats_are_overridden_and_moved(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine = tmp_path / "mine.beats"
    mine.write_text("\n".join(f"{0.3 + 0.5 * index:.3f}\t{index % 3 + 1}" for index in range(14)))
    out = tmp_path / "song.json"
    assert run(monkeypatch, song, "--beats", mine, "--downbeat-offset", 1, "-o", out) == 0
    document = json.loads(out.read_bytes())
    assert document["beats"][:3] == [0.3, 0.8, 1.3]
    assert document["downbeats"][:2] == [0.8, 2.3]
    assert document["meter"] == 3
    assert run(monkeypatch, song, "--beats", out, "--tempo", "half", "-o", tmp_path / "again.json") == 0
    assert json.loads((tmp_path / "again.json").read_bytes())["tempo"] == pytest.approx(60.0, rel=0.01)


def test_times_in_a_file_of_beats_count_from_the_start_of_the_sound(
    song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine = tmp_path / "mine.txt"
    mine.write_text("\n".join(f"{0.5 * index:.3f}" for index in range(1, 15)))
    out = tmp_path / "song.json"
    assert run(monkeypatch, song, "--beats", mine, "--start", 2, "--seconds", 4, "-o", out) == 0
    document = json.loads(out.read_bytes())
    assert document["beats"] == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5]


def test_a_wrong_line_of_beats_is_named(
    song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.beats"
    mine.write_text("0.5\n0.4\n")
    assert run(monkeypatch, song, "--beats", mine) == 1
    assert f"onbeat: {mine}:2: 0.4 s does not follow the 0.5 s before it" in capsys.readouterr().err


def test_taps_are_followed(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    taps = tmp_path / "taps.txt"
    taps.write_text("\n".join(f"{at:.3f}" for at in 1.237 + np.arange(6) + 0.02 * rng.standard_normal(6)))
    out = tmp_path / "song.json"
    assert run(monkeypatch, song, "--tap", taps, "-o", out) == 0
    assert json.loads(out.read_bytes())["tempo"] == pytest.approx(60.0, rel=0.01)


def test_no_beat_is_an_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    soundfile.write(tmp_path / "a.wav", 0.1 * np.random.default_rng(0).standard_normal(22050 * 6), 22050)
    files = ["-o", tmp_path / "a.csv", "--click", tmp_path / "a.flac", "--plot", tmp_path / "a.png"]
    assert run(monkeypatch, tmp_path / "a.wav", *files) == 0
    assert "no beat heard" in capsys.readouterr().out
    assert (tmp_path / "a.csv").read_text().count("\n") == 1
