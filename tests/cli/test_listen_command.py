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
    assert "120.00 BPM" in out
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
    beats = np.loadtxt(tmp_path / "song.csv", delimiter=",", skiprows=1)[:, 0]
    assert np.median(np.diff(beats)) == pytest.approx(0.5, abs=0.011)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("missing.wav",), "missing.wav: no such file"),
        (("SONG", "--method", "ear"), "there are barpointer, shiratori2006"),
        (("SONG", "-o", "song.txt"), "use .json or .csv"),
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
