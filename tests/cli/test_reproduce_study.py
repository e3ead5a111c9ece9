"""``onbeat reproduce study``: the page is made once, answers are told as a table or JSON, what cannot be is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from folk_dancers import spaces_of
from onbeat.cli.reproduce import reproduce_app
from onbeat.errors import OnbeatError
from onbeat.keyposes.judging import Answer
from onbeat.reproduce.data import Data
from onbeat.reproduce.p3 import people
from onbeat.reproduce.study.answers import PersonAnswers, StudyDocument


class MadePeople:
    """In place of the troupe, of whom it takes long to dance."""

    def spaces(self) -> object:
        return spaces_of(3)


def made(data: Data) -> MadePeople:
    return MadePeople()


@pytest.fixture(autouse=True)
def _made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(people, "people_of", made)


def call(*words: str) -> None:
    reproduce_app(["study", *words], exit_on_error=False, print_error=False, result_action="return_value")


def kept(folder: Path, number: int, chosen: str) -> Path:
    answers = [Answer(motion, "keyposes", "uniform", chosen) for motion in ("Aiko", "Carla")]
    path = folder / f"{number}.json"
    path.write_bytes(StudyDocument(1, "s", 3, [PersonAnswers(f"{number:016x}", answers)]).to_json())
    return path


def test_a_page_is_made_once_and_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    folder = tmp_path / "study"
    call(str(folder), "--page-only", "--sequences", "2")
    page = (folder / "study.html").read_bytes()
    assert b'"plans"' in page
    assert capsys.readouterr().out.strip().endswith("study.html")
    call(str(folder), "--page-only", "--sequences", "3", "--seed", "7")
    assert (folder / "study.html").read_bytes() == page


def test_answers_are_told_beside_the_papers(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    files = [str(kept(tmp_path, number, "a" if number else "b")) for number in range(4)]
    call(*files)
    said = capsys.readouterr().out
    assert "92 / 102" in said
    assert "6 / 8 · 75%" in said
    call(str(tmp_path), "--table", "--json")
    told = json.loads(capsys.readouterr().out)
    assert (told["people"], told["total"]["chosen"], told["total"]["trials"]) == (4, 6, 8)
    assert told["sequences"]["Aiko"]["chosen"] == 3


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "0 folders"),
        (["a", "b"], "2 folders"),
        (["a", "b.json"], "not both"),
        (["nothing.json"], "cannot read"),
        (["empty", "--table"], "no answers in empty"),
        (["x", "--page-only", "--sequences", "9"], "9 dances cannot be shown of 3"),
        (["x", "--page-only", "--seed", "-1"], "--seed -1"),
    ],
)
def test_what_cannot_be_is_refused(words: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OnbeatError, match=told):
        call(*words)
    assert not list(tmp_path.rglob("*.html"))


@pytest.mark.parametrize("port", ["65536", "-1"])
def test_a_port_that_no_machine_has_is_refused(tmp_path: Path, port: str):
    with pytest.raises(OnbeatError, match=f"--port {port}: give a number from 1 to 65535"):
        call(str(tmp_path), "--sequences", "2", "--port", port)
