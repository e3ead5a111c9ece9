"""The study's page in a real browser: person after person is asked another plan, and the answers are kept."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import uvicorn

from browser.pictures import Pictures
from folk_dancers import spaces_of
from onbeat.reproduce.study.answers import read_answers
from onbeat.reproduce.study.plans import PAGE, study_page
from onbeat.reproduce.study.server import open_study, study_app
from onbeat.reproduce.study.table import outcome_of

pytestmark = pytest.mark.browser


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / PAGE).write_bytes(study_page(spaces_of(3), 0, 2))
    return tmp_path


@pytest.fixture
def address(folder: Path) -> Iterator[str]:
    """Where the study is served while a test runs."""
    bound = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(uvicorn.Config(study_app(folder, open_study(folder)), log_level="error", lifespan="off"))
    thread = threading.Thread(target=lambda: asyncio.run(server.serve([bound])))
    thread.start()
    yield f"http://127.0.0.1:{bound.getsockname()[1]}/"
    server.should_exit = True
    thread.join(120)
    bound.close()


def answer(page: Any) -> list[dict[str, Any]]:
    """One person, who finds keyposes more like the original but for the last time; what was asked."""
    page.keyboard.press("Enter")
    asked = page.evaluate("window.onbeat.trials")
    for number, trial in enumerate(asked):
        right = "a" if trial["a"] == "keyposes" else "b"
        page.keyboard.press(right if number < len(asked) - 1 else {"a": "b", "b": "a"}[right])
    page.wait_for_selector("#next:not([disabled])", timeout=120_000)
    return asked


def test_it_looks_as_it_did(folder: Path, open_page: Any, pictures: Pictures):
    pictures.look(open_page(folder / PAGE).page, "study", (1000, 640))


def test_answers_of_several_people_are_kept_in_the_browser_and_saved_as_one_file(folder: Path, open_page: Any):
    opened = open_page(folder / PAGE)
    page = opened.page
    assert page.is_visible("#begin")
    assert not page.is_visible("#save")
    asked = []
    for _ in range(4):
        asked.append(answer(page))
        page.click("#next")
        assert page.is_visible("#begin")
    page.reload()
    asked.append(answer(page))
    assert {plan[0]["a"] for plan in asked[:4]} == {"keyposes", "uniform"}
    with page.expect_download() as saving:
        page.click("#save")
    saving.value.save_as(folder / "saved.json")
    found = read_answers([folder / "saved.json"])
    assert [[(a.motion, a.a) for a in one.answers] for one in found.people] == [
        [(trial["motion"], trial["a"]) for trial in plan] for plan in asked
    ]
    assert outcome_of(found).total[:2] == (5, 10)
    assert opened.complaints == []


def test_answers_are_handed_to_the_server_that_the_page_comes_from(folder: Path, address: str, open_page: Any):
    opened = open_page(folder / PAGE)
    page = opened.page
    page.context.set_offline(False)
    page.goto(address)
    answer(page)
    assert page.inner_text("#told") == "Your answers are saved."
    page.click("#next")
    answer(page)
    kept = sorted((folder / "answers").glob("*.json"))
    assert len(read_answers(kept).people) == 2
    assert opened.complaints == []


def test_a_server_that_is_gone_loses_nothing(folder: Path, address: str, open_page: Any):
    page = open_page(folder / PAGE).page
    page.context.set_offline(False)
    page.goto(address)
    page.route("**/answers", lambda route: route.abort())
    answer(page)
    assert "could not be sent" in page.inner_text("#told")
    page.unroute("**/answers")
    page.click("#next")
    answer(page)
    assert len(read_answers(sorted((folder / "answers").glob("*.json"))).people) == 2
