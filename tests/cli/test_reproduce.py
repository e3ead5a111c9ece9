"""``onbeat reproduce``: pages in a folder, a table or JSON on stdout."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import onbeat.cli.reproduce as cli
import onbeat.reproduce.run as run
from made_results import MadePaper
from onbeat.cli.reproduce import reproduce_app
from onbeat.errors import OnbeatError
from onbeat.reproduce.place import place_for


@pytest.fixture(autouse=True)
def _made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "paper", MadePaper)
    monkeypatch.setattr(cli, "WORKERS", 1)  # other processes would not know what is made


def call(*words: str) -> None:
    reproduce_app([*words], exit_on_error=False, print_error=False, result_action="return_value")


def test_a_page_a_paper_and_what_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    call("p2", "P1", "-o", str(tmp_path / "out"))
    said = capsys.readouterr().out
    assert said.index("P1 Dance") < said.index("P2 Dance") < said.index("index.html")
    assert "12 of 13" in said
    assert {"index.html", "p1.html", "p2.html", "results.json"} <= {path.name for path in (tmp_path / "out").iterdir()}


def test_json_is_what_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    call("P3", "--quick", "--seed", "5", "--json", "-o", str(tmp_path))
    said = capsys.readouterr().out
    assert said == (tmp_path / "results.json").read_text()
    document = json.loads(said)
    assert (document["quick"], document["seed"], document["papers"][0]["our_data"]) == (True, 5, "seed 5")


@pytest.mark.parametrize(
    ("words", "match"), [(["P1", "--seed", "-1"], "--seed -1"), (["P7"], "no paper 'P7'"), (["..."], "no paper")]
)
def test_what_cannot_be_is_refused(words: list[str], match: str, tmp_path: Path):
    with pytest.raises(OnbeatError, match=match):
        call(*words, "-o", str(tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_is_refused_before_the_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(cli, "reproduce", lambda *_, **__: pytest.fail("the work was begun"))
    (tmp_path / "file").write_text("")
    (tmp_path / "full" / "p1.html").mkdir(parents=True)
    places = [(tmp_path / "file", "is not a folder"), (tmp_path / "file" / "in_it", "is not a folder")]
    places += [(tmp_path / "full", r"cannot write .*p1\.html: a folder is there")]
    places += [(Path("/proc/x"), "cannot write in /proc/x")] if Path("/proc/self").exists() else []
    for output, told in places:
        with pytest.raises(OnbeatError, match=f"{told}.*; choose another folder"):
            call("P1", "-o", str(output))


def test_only_one_at_a_time_writes_into_a_folder_and_what_came_to_nothing_is_taken_away(tmp_path: Path):
    with place_for(tmp_path / "out", []):
        with pytest.raises(OnbeatError, match=r"being written by process .*choose another folder"):
            call("P1", "-o", str(tmp_path / "out"))
        assert (tmp_path / "out").is_dir()
    with pytest.raises(KeyboardInterrupt), place_for(tmp_path / "new" / "stopped", []):
        raise KeyboardInterrupt
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert not any((tmp_path / "out").iterdir())  # nor does its lock stay


def test_progress_is_told_in_lines_where_stderr_is_no_screen(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    call("P3", "-o", str(tmp_path))
    assert capsys.readouterr().err.splitlines() == ["onbeat: P3, 50 %: half of it"]


def test_the_study_is_told_of_in_the_help(capsys: pytest.CaptureFixture[str]):
    call("--help")
    assert "Ask people which motion looks more" in " ".join(capsys.readouterr().out.split())
