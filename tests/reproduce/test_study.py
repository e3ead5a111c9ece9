"""The user study: plans are balanced, answers are put together and tested, and the server keeps what it asked for."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import httpx
import msgspec
import numpy as np
import pytest

from folk_dancers import spaces_of
from onbeat.errors import OnbeatError
from onbeat.keyposes.judging import Answer, AnswersDocument
from onbeat.reproduce.study.answers import PersonAnswers, StudyDocument, read_answers
from onbeat.reproduce.study.plans import PAGE, plans, study_page
from onbeat.reproduce.study.server import LARGEST, Study, keep_answers, open_study, study_app
from onbeat.reproduce.study.table import outcome_of, study_table
from own_loop import run


def person(number: int, chosen: str, motions: Sequence[str] = "xyz", a: str = "keyposes") -> PersonAnswers:
    """Somebody's answers, a letter each."""
    b = "uniform" if a == "keyposes" else "keyposes"
    answers = [Answer(motion, a, b, which) for motion, which in zip(motions, chosen, strict=True)]
    return PersonAnswers(f"{number:016x}", answers)


class Client:
    """A browser, as far as it asks the server for something."""

    def __init__(self, app: Any, base_url: str = "http://127.0.0.1:8652") -> None:
        self._app, self._base = app, base_url

    def asks(self, method: str, path: str, **more: Any) -> httpx.Response:
        async def answered() -> httpx.Response:
            transport = httpx.ASGITransport(app=self._app)
            async with httpx.AsyncClient(transport=transport, base_url=self._base) as client:
                return await client.request(method, path, **more)

        return run(answered())

    def get(self, path: str, **more: Any) -> httpx.Response:
        return self.asks("GET", path, **more)

    def post(self, path: str, **more: Any) -> httpx.Response:
        return self.asks("POST", path, **more)


def document(*people: PersonAnswers, study: str = "s") -> StudyDocument:
    return StudyDocument(1, study, 3, list(people))


def test_sides_and_places_are_balanced_over_each_block_of_people():
    drawn = plans(["x", "y", "z"], np.random.default_rng(3), 2)
    for block in (drawn[:6], drawn[6:]):
        assert set(Counter((t.motion, place) for plan in block for place, t in enumerate(plan)).values()) == {2}
        assert set(Counter((t.motion, place, t.a) for plan in block for place, t in enumerate(plan)).values()) == {1}
    assert all({trial.a, trial.b} == {"keyposes", "uniform"} for plan in drawn for trial in plan)
    assert drawn[:6] != drawn[6:]
    assert plans(["x", "y", "z"], np.random.default_rng(3), 2) == drawn


def test_what_the_paper_counted_has_the_interval_of_clopper_and_pearson():
    rows = {row.label: row for row in study_table(None).rows}
    assert rows["total"].paper == "92 / 102 · 90% (83%–95%)"
    assert rows["sequence 2"].paper == "29 / 34 · 85% (69%–95%)"
    assert {row.ours for row in rows.values()} == {"–"}


def test_answers_of_many_people_are_tested_by_sequence_by_person_and_by_side():
    people = [person(n, "aaa") for n in range(5)] + [person(n, "bba", a="uniform") for n in range(5, 9)]
    found = outcome_of(document(*people))
    assert (found.total.chosen, found.total.trials) == (23, 27)
    assert {name: one.chosen for name, one in found.sequences.items()} == {"x": 9, "y": 9, "z": 5}
    assert (found.people.chosen, found.people.trials) == (9, 9) if found.people else False
    assert found.people is not None
    assert found.people.p == pytest.approx(2 / 2**9)
    assert (found.left.chosen, found.left.trials) == (19, 27)
    assert 2 / 3 < found.spread[0] < 23 / 27 < found.spread[1] <= 1.0
    table = study_table(document(*people))
    assert [row.ours.split(" (")[0] for row in table.rows[:4]] == ["9 / 9 · 100%", "9 / 9 · 100%", "5 / 9 · 56%",
                                                                   "23 / 27 · 85%"]  # fmt: skip


def test_people_who_chose_both_as_often_are_of_neither_opinion():
    found = outcome_of(document(person(0, "ab", "xy"), person(1, "ba", "xy")))
    assert found.people is None
    assert found.total.p == 1.0


def test_files_are_put_together_and_each_person_counts_once(tmp_path: Path):
    (tmp_path / "a.json").write_bytes(document(person(0, "aab"), person(1, "bbb")).to_json())
    (tmp_path / "b.json").write_bytes(document(person(1, "bbb"), person(2, "aaa")).to_json())
    found = read_answers([tmp_path / "a.json", tmp_path / "b.json"])
    assert [one.id[-1] for one in found.people] == ["0", "1", "2"]
    (tmp_path / "c.json").write_bytes(document(person(1, "aaa")).to_json())
    with pytest.raises(OnbeatError, match="different answers by 0000000000000001"):
        read_answers([tmp_path / "a.json", tmp_path / "c.json"])
    (tmp_path / "d.json").write_bytes(document(person(3, "aaa"), study="other").to_json())
    with pytest.raises(OnbeatError, match="another study"):
        read_answers([tmp_path / "a.json", tmp_path / "d.json"])


def test_files_of_the_page_for_one_person_are_read_too(tmp_path: Path):
    for name in "ab":
        alone = AnswersDocument(1, 3, person(0, "aab").answers)
        (tmp_path / f"{name}.json").write_text(json.dumps({
            "version": alone.version, "dims": alone.dims,
            "answers": [{"motion": a.motion, "a": a.a, "b": a.b, "chosen": a.chosen} for a in alone.answers],
        }))  # fmt: skip
    assert outcome_of(read_answers([tmp_path / "a.json", tmp_path / "b.json"])).total[:2] == (4, 6)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "is not a file of answers"),
        (b"[]", "is not a file of answers"),
        (b'{"version": 2, "people": []}', "version 2"),
        (b'{"version": 1, "study": "s", "dims": 3, "people": []}', "no answers"),
        (document(PersonAnswers("../../etc/passwd", person(0, "aaa").answers)).to_json(), "sixteen"),
        (document(person(0, "xyz")).to_json(), "'a' or 'b'"),
        (document(PersonAnswers(f"{0:016x}", [])).to_json(), "0 answers"),
        (b'{"people": ' + b"[" * 5000, r"is not a file of answers that study\.html saved"),
        (b'{"version": 1, "dims": 3}', r"is not a file of answers that study\.html or judge\.html saved"),
    ],
)
def test_what_is_no_answers_is_refused(tmp_path: Path, data: bytes, told: str):
    path = tmp_path / "answers.json"
    path.write_bytes(data)
    with pytest.raises(OnbeatError, match=told):
        read_answers([path])
    with pytest.raises(OnbeatError, match="is no file"):
        read_answers([tmp_path])


def test_names_in_answers_neither_hide_what_they_are_nor_steer_a_terminal(tmp_path: Path):
    answers = person(0, "a", ["\x1b[31mpeople"]).answers
    path = tmp_path / "answers.json"
    path.write_bytes(msgspec.json.encode(AnswersDocument(1, 3, answers)).replace(b"\\u001b[31mpeople", b'\\"people\\"'))
    assert read_answers([path]).people[0].answers[0].motion == '"people"'
    row = study_table(document(PersonAnswers(f"{0:016x}", answers))).rows[0]
    assert row.label == "sequence 1 (ours: ?[31mpeople)"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("study")
    (folder / PAGE).write_bytes(study_page(spaces_of(3), 0, 2))
    return open_study(folder)


def answered(study: Study, number: int = 0, chosen: str = "a") -> StudyDocument:
    """What somebody sends who was asked the first of the plans."""
    plan = min(study.plans)
    answers = [Answer(t.motion, t.a, t.b, chosen, 1.0, t.stretch) for t in plan]
    return StudyDocument(1, study.key, study.dims, [PersonAnswers(f"{number:016x}", answers)])


def test_the_server_gives_the_page_and_keeps_answers(study: Study, tmp_path: Path):
    client = Client(study_app(tmp_path, study))
    assert client.get("/").content == study.page
    for number in (0, 1, 0):  # sent again where it is not known whether it came
        sent = client.post("/answers", content=answered(study, number).to_json(), headers=JSON)
        assert sent.status_code == 204
    kept = sorted(tmp_path.rglob("*.json"))
    assert [path.parent.name for path in kept] == ["answers", "answers"]
    assert len(read_answers(kept).people) == 2


JSON = {"content-type": "application/json"}


def test_the_server_refuses_what_is_not_its_own(study: Study, tmp_path: Path):
    client = Client(study_app(tmp_path, study))
    good = answered(study).to_json()
    assert client.post("/answers", content=good, headers=JSON | {"origin": "http://evil.example"}).status_code == 403
    assert client.post("/answers", content=good, headers=JSON | {"host": "evil.example"}).status_code == 403
    assert client.get("/", headers={"host": "evil.example"}).status_code == 403
    assert client.post("/answers", content=good, headers={"content-type": "text/plain"}).status_code == 415
    assert client.post("/answers", content=b" " * (LARGEST + 1), headers=JSON).status_code == 413
    for bad in (b"{", good.replace(study.key.encode(), b"x"), good.replace(b"Aiko", b"nobody"),
                good.replace(f"{0:016x}".encode(), b"../../evil")):  # fmt: skip
        assert bad != good
        refused = client.post("/answers", content=bad, headers=JSON)
        assert refused.status_code == 400
        assert refused.text.strip()
    assert client.get("/../study.html").status_code == 404
    assert list(tmp_path.rglob("*.json")) == []


def test_whoever_comes_from_another_machine_needs_the_token(study: Study, tmp_path: Path):
    client = Client(study_app(tmp_path, study, "0.0.0.0", "secret"), "http://192.168.1.5:8652")
    assert client.get("/").status_code == 404
    assert client.get("/guessed/").status_code == 404
    assert client.get("/secret/").content == study.page
    assert client.post("/guessed/answers", content=answered(study).to_json(), headers=JSON).status_code == 404
    assert client.post("/secret/answers", content=answered(study).to_json(), headers=JSON).status_code == 204


def test_what_somebody_answered_first_stays(study: Study, tmp_path: Path):
    assert keep_answers(tmp_path, study, answered(study, chosen="a")) == 1
    with pytest.raises(OnbeatError, match="answered otherwise"):
        keep_answers(tmp_path, study, answered(study, chosen="b"))
    (path,) = tmp_path.rglob("*.json")
    assert read_answers([path]) == answered(study, chosen="a")


def test_a_page_of_something_else_is_not_served(tmp_path: Path):
    with pytest.raises(OnbeatError, match="cannot read"):
        open_study(tmp_path)
    (tmp_path / PAGE).write_text("<p>hello")
    with pytest.raises(OnbeatError, match="no page of a study"):
        open_study(tmp_path)
    with pytest.raises(OnbeatError, match="4 dances cannot be shown of 3"):
        study_page(spaces_of(3), 0, 4)
