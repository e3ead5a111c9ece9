"""A dance that onbeat made lies beside its song, whose beats need not be guessed."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.cli.own_song import own_song


@pytest.fixture
def made(tmp_path: Path) -> Path:
    for name in ("dance.json", "song.json", "dance.bvh", "other.bvh"):
        (tmp_path / name).touch()
    return tmp_path


def test_the_song_beside_a_dance_is_taken_and_told(made: Path, capsys: pytest.CaptureFixture[str]):
    assert own_song(made / "dance.bvh", None, None, 0.0) == made / "song.json"
    assert "to which dance.bvh was made" in capsys.readouterr().err


@pytest.mark.parametrize("told", [("song.wav", None, 0.0), (None, "a.beats", 0.0), (None, None, 1.5)])
def test_what_is_told_comes_first(made: Path, told: tuple[object, ...]):
    assert own_song(made / "dance.bvh", *told) is None


def test_other_motions_and_lone_dances_have_none(made: Path):
    assert own_song(made / "other.bvh") is None
    (made / "dance.json").unlink()
    assert own_song(made / "dance.bvh") is None
