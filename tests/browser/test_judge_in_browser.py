"""``judge.html`` in a real browser: both motions move, keys and buttons choose, answers are saved."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from browser.pictures import Pictures
from folk_dancers import spaces_of
from onbeat.keyposes.judging import AnswersDocument, trials, verdict_of
from onbeat.viewer.pages.judge import write_judge_page

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def opened_page(tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> Any:
    found = spaces_of(3)
    path = tmp_path_factory.mktemp("judge") / "judge.html"
    write_judge_page(path, found, trials([one.person for one in found.taught], np.random.default_rng(1)))
    return open_page(path)


@pytest.fixture
def opened(opened_page: Any) -> Any:
    """As somebody finds it who was never there."""
    opened_page.page.evaluate("localStorage.clear()")
    opened_page.page.reload()
    opened_page.complaints.clear()
    return opened_page


def drawn_at(page: Any, time: float) -> dict[str, np.ndarray]:
    """Where the points are that are drawn at a second, by the names of the canvases."""
    page.evaluate(
        "time => { window.onbeat.hold(time); "
        "return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))) }",
        time,
    )
    return {name: np.reshape(places, (-1, 3)) for name, places in page.evaluate("window.onbeat.places()").items()}


def between(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, None] - points[None], axis=-1)


def test_it_looks_as_it_did(opened: Any, pictures: Pictures):
    drawn_at(opened.page, 1.5)
    pictures.look(opened.page, "judge", (1000, 640))


def test_three_dancers_move_as_the_motions_do(opened: Any):
    found, trial = spaces_of(3), opened.page.evaluate("window.onbeat.trials[0]")
    which = [one.person for one in found.taught].index(trial["motion"])
    for time in (0.0, 2.51):
        drawn = drawn_at(opened.page, time)
        for name, points in drawn.items():
            motion = found.motions[which] if name == "original" else found.motion(which, trial[name])
            at = motion.at(np.array([found.taught[which].start + time]))
            true = at.positions[0, found.vectors[which].joints]
            assert np.abs(between(points / 1000) - between(true)).max() < 0.005
    colours = opened.page.evaluate(
        "[...document.querySelectorAll('canvas')].map(c => new Set(c.getContext('2d')"
        ".getImageData(0, 0, c.width, c.height).data).size)"
    )
    assert min(colours) > 10
    assert opened.complaints == []


def test_answers_outlive_a_reload_until_the_next_person(opened: Any):
    page = opened.page
    page.keyboard.press("b")
    page.keyboard.press("a")
    given = page.evaluate("window.onbeat.collected().answers")
    page.reload()
    assert page.evaluate("window.onbeat.collected().answers") == given
    assert page.inner_text("#place") == "3 of 3"
    page.keyboard.press("a")
    page.reload()
    assert page.is_visible("#done")
    assert page.is_disabled("#next")  # not before the answers are saved
    with page.expect_download():
        page.click("#save")
    page.click("#next")
    assert page.inner_text("#place") == "1 of 3"
    page.reload()
    assert page.evaluate("window.onbeat.collected().answers") == []
    assert opened.complaints == []


@pytest.mark.parametrize("kept", ["{", "null", "[]", "[null]", '[{"chosen": "a"}]', '{"a": 1}', "7"])
def test_what_is_kept_and_is_no_answers_is_left_alone(opened: Any, kept: str):
    page = opened.page
    page.evaluate(
        "kept => localStorage.setItem("
        "'onbeat judge ' + JSON.parse(document.getElementById('data').textContent).key, kept)",
        kept,
    )
    page.reload()
    assert page.inner_text("#place") == "1 of 3"
    assert opened.complaints == []


def test_keys_and_buttons_choose_and_answers_are_saved(opened: Any, tmp_path: Path):
    page = opened.page
    page.keyboard.press("a")
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("window.onbeat.collected().answers") == []
    page.keyboard.press("b")
    page.click("#choose-a")
    page.click("figure.b")
    assert page.is_visible("#done")
    assert not page.is_visible("#choose-a")
    with page.expect_download() as saving:
        page.click("#save")
    saving.value.save_as(tmp_path / "answers.json")
    saved = AnswersDocument.from_json((tmp_path / "answers.json").read_bytes())
    assert [answer.chosen for answer in saved.answers] == ["b", "a", "b"]
    shown = page.evaluate("window.onbeat.trials")
    assert [(a.motion, a.a, a.b) for a in saved.answers] == [(t["motion"], t["a"], t["b"]) for t in shown]
    assert verdict_of([saved]).trials == 3
    assert opened.complaints == []
    assert all(url.startswith(("file:", "blob:")) for url in opened.requests)


def test_a_browser_that_keeps_nothing_asks_all_the_same(opened: Any):
    page = opened.page
    # From here on, for all tests that would come after this one.
    page.add_init_script("Object.defineProperty(window, 'localStorage', { get() { throw new Error('no'); } })")
    page.reload()
    page.keyboard.press("b")
    assert page.inner_text("#place") == "2 of 3"
    assert opened.complaints == []
