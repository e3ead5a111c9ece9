"""A project's folder: one studio at a time, nothing half written, nothing outside of it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.studio.project import Project
from onbeat.studio.records import KEPT_JOBS, JobRecord, ProjectDocument
from onbeat.studio.wire import JobItem, SongItem


def with_song(folder: Path) -> Project:
    project = Project(folder)
    with project.change() as document:
        document.put("songs", SongItem(document.new_id("song"), "a song"))
    return project


def test_what_was_changed_is_there_when_it_is_opened_again(tmp_path: Path):
    with_song(tmp_path / "p").close()
    again = Project(tmp_path / "p")
    assert [song.name for song in again.document.songs.values()] == ["a song"]
    with again.change() as document:
        assert document.new_id("song") == "song-2"
    again.close()


def test_two_studios_cannot_have_one_project(tmp_path: Path):
    first = Project(tmp_path / "p")
    with pytest.raises(OnbeatError, match="open in another studio"):
        Project(tmp_path / "p")
    first.close()
    Project(tmp_path / "p").close()


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('{"version": 2}', "version 2; this onbeat reads version 1: use a newer onbeat"),
        ('{"version": 1, "songs": {"so', "is damaged"),
        ("", "is damaged"),
        ('{"version": 1, "songs": {"../x": {"id": "../x", "name": "a"}}}', "no id"),
        ('{"version": 1, "songs": {"a": {"id": "b", "name": "a"}}}', "no id"),
        ("[" * 100000, "is damaged"),
    ],
)
def test_a_project_that_cannot_be_read_is_refused_and_left_as_it_is(tmp_path: Path, text: str, why: str):
    folder = tmp_path / "p"
    with_song(folder).close()
    (folder / "project.json").write_text(text)
    (folder / "songs" / "song-1").mkdir()
    for _ in range(2):  # the lock is free again
        with pytest.raises(OnbeatError, match=why):
            Project(folder)
    assert (folder / "project.json").read_text() == text
    assert (folder / "songs" / "song-1").is_dir()


def test_a_folder_with_other_things_or_without_its_document_is_not_taken(tmp_path: Path):
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "mother.txt").write_text("dear")
    with pytest.raises(OnbeatError, match=r"mother\.txt is there"):
        Project(tmp_path / "letters")
    with_song(tmp_path / "p").close()
    (tmp_path / "p" / "songs" / "song-1").mkdir()
    (tmp_path / "p" / "project.json").unlink()
    with pytest.raises(OnbeatError, match="songs is there"):
        Project(tmp_path / "p")
    (tmp_path / "file").touch()
    with pytest.raises(OnbeatError, match="is a file"):
        Project(tmp_path / "file")


def test_a_change_that_cannot_be_written_did_not_happen(tmp_path: Path):
    project = with_song(tmp_path / "p")
    (tmp_path / "p").rename(tmp_path / "away")
    with pytest.raises(OnbeatError, match="cannot write"), project.change() as document:
        document.put("songs", SongItem("song-9", "another"))
    assert list(project.document.songs) == ["song-1"]
    project.close()


def test_no_link_leads_out_of_the_project(tmp_path: Path):
    project = with_song(tmp_path / "p")
    (tmp_path / "outside").mkdir()
    (tmp_path / "p" / "songs" / "song-1").symlink_to(tmp_path / "outside")
    with pytest.raises(OnbeatError, match="leads out of the project"):
        project.place("songs", "song-1")
    with project.change() as document:
        document.places["song-1"] = "../outside/x.mp3"
    with pytest.raises(OnbeatError, match="leads out of the project"):
        project.given("song-1")
    with pytest.raises(OnbeatError, match=r"no '\.\./x'"):
        project.place("songs", "../x")
    project.close()


def test_what_was_begun_and_not_kept_goes_when_it_is_opened(tmp_path: Path):
    project = with_song(tmp_path / "p")
    (project.scratch() / "half").touch()
    (tmp_path / "p" / "songs" / "song-7").mkdir()
    (tmp_path / "p" / "songs" / "song-1").mkdir()
    project.close()
    Project(tmp_path / "p").close()
    assert not list((tmp_path / "p" / "work").iterdir())
    assert [path.name for path in (tmp_path / "p" / "songs").iterdir()] == ["song-1"]


def test_only_the_last_jobs_that_are_over_are_remembered():
    document = ProjectDocument()
    for number in range(KEPT_JOBS + 5):
        state = "waiting" if number == 0 else "done"
        document.jobs[f"job-{number}"] = JobRecord(JobItem(f"job-{number}", "listen", "song", "", state))
    document.forget_old_jobs()
    assert len(document.jobs) == KEPT_JOBS + 1
    assert list(document.jobs)[:2] == ["job-0", "job-5"]
    assert json.dumps(list(document.jobs))
