"""``onbeat dance`` to beats that somebody knows better, and to a song that has none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile

Run = Callable[..., tuple[int, str, str]]

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A beat every 0.6 s, three in a bar."""
    path = tmp_path / "mine.beats"
    path.write_text("\n".join(f"{0.25 + 0.6 * index:.3f}\t{index % 3 + 1}" for index in range(9)))
    return path


def test_the_dance_is_to_the_beats_of_the_file(run: Run, song: Path, clips: Path, tmp_path: Path, mine: Path) -> None:
    status, _, err = run(song, "--moves", clips, "-o", tmp_path / "dance", "--beats", mine)
    assert status == 0, err
    document = json.loads((tmp_path / "dance" / "song.json").read_bytes())
    np.testing.assert_allclose(document["beats"], 0.25 + 0.6 * np.arange(9))
    assert document["meter"] == 3
    assert document["tempo"] == pytest.approx(100.0)
    assert len(document["chord_root"]) == 9
    assert document["sections"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--beats", "LATE"), "late.beats:2: 60 s lies outside of the song, which lasts from 0 to 6.00 s"),
        (("--beats", "none.beats"), "none.beats: cannot be read"),
        (("--tap", "none.txt"), "none.txt: cannot be read"),
        (("--meter", "0"), "meter 0: expected 1 to 16"),
    ],
)
def test_what_cannot_be_taken_is_said(
    run: Run, song: Path, clips: Path, tmp_path: Path, words: tuple[str, ...], message: str
) -> None:
    late = tmp_path / "late.beats"
    late.write_text("0.5\n60\n")
    words = tuple(str(late) if word == "LATE" else word for word in words)
    status, out, err = run(song, "--moves", clips, "-o", tmp_path / "dance", *words)
    assert status == 1
    assert out == ""
    assert message in err
    assert not (tmp_path / "dance").exists()


def test_no_beat_is_said_and_beats_can_be_given(run: Run, clips: Path, tmp_path: Path, mine: Path) -> None:
    noise = tmp_path / "noise.wav"
    soundfile.write(noise, 0.1 * np.random.default_rng(0).standard_normal(22050 * 6), 22050)
    status, _, err = run(noise, "--moves", clips, "-o", tmp_path / "dance")
    assert status == 1
    assert "no beat is heard in 6.0 s of noise" in err
    assert run(noise, "--moves", clips, "-o", tmp_path / "dance", "--beats", mine)[0] == 0


def test_what_is_told_of_the_tempo_is_danced(run: Run, song: Path, clips: Path, tmp_path: Path, mine: Path) -> None:
    out = tmp_path / "dance"
    status, printed, err = run(song, "--moves", clips, "-o", out, "--beats", mine, "--tempo", "half")
    assert status == 0, err
    assert "at 50 BPM" in printed
    assert "heard" not in err
    assert json.loads((out / "song.json").read_bytes())["tempo"] == pytest.approx(50.0)
    assert "heard_bpm" not in json.loads((out / "dance.json").read_bytes())


def test_no_beat_is_said_before_the_moves_are_read(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onbeat.cli.dance._library", lambda *_: pytest.fail("the moves were read"))
    noise = tmp_path / "noise.wav"
    soundfile.write(noise, 0.1 * np.random.default_rng(0).standard_normal(22050 * 6), 22050)
    status, _, err = run(noise, "-o", tmp_path / "dance")
    assert status == 1
    assert "or say where the beats are with --beats or --tap" in err
