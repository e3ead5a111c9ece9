"""The folder of results is held, and as it was if nothing came of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.reproduce.place import LOCK, place_for


def test_a_folder_is_made_held_and_left_without_a_lock(tmp_path: Path):
    place = tmp_path / "deep" / "results"
    with place_for(place, ["index.html"]):
        (place / "index.html").write_text("made")
        assert (place / LOCK).exists()
    assert [path.name for path in place.iterdir()] == ["index.html"]


def test_what_was_made_in_vain_goes_again(tmp_path: Path):
    with pytest.raises(KeyboardInterrupt), place_for(tmp_path / "deep" / "results", []):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_a_lock_that_somebody_took_away_ends_nothing_and_another_run_s_stays(tmp_path: Path):
    with place_for(tmp_path, []):
        (tmp_path / LOCK).unlink()
    with place_for(tmp_path, []):
        (tmp_path / LOCK).unlink()
        (tmp_path / LOCK).write_text("another's")
    assert (tmp_path / LOCK).read_text() == "another's"


def test_a_file_to_be_written_that_is_a_folder_is_told_at_once(tmp_path: Path):
    (tmp_path / "index.html").mkdir()
    with pytest.raises(OnbeatError, match=r"index\.html: a folder is there"), place_for(tmp_path, ["index.html"]):
        pass
