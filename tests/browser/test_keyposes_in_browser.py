"""``keyposes.html`` in a real browser: keys, buttons, marks and pictures go from keypose to keypose."""

from __future__ import annotations

from typing import Any

import pytest

from browser.pictures import Pictures
from folk_dancers import dancers
from onbeat.keyposes.extract import Keyposes, find_keyposes
from onbeat.viewer.pages.keyposes import write_keypose_page

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def found() -> Keyposes:
    clip = dancers(1)[0]
    return find_keyposes(clip.motion, clip.beats)


@pytest.fixture(scope="module")
def opened_page(found: Keyposes, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> Any:
    path = tmp_path_factory.mktemp("keyposes") / "keyposes.html"
    write_keypose_page(path, found, dancers(1)[0].motion, title="Folk", downbeats=found.song_beats[::4])
    opened = open_page(path)
    opened.page.set_viewport_size({"width": 1000, "height": 720})
    return opened


@pytest.fixture
def opened(opened_page: Any) -> Any:
    opened_page.page.evaluate("window.onbeat.pause()")
    opened_page.posed(0)
    return opened_page


def time_of(opened: Any) -> float:
    return opened.state()["time"]


def test_it_looks_as_it_did(opened: Any, pictures: Pictures, found: Keyposes):
    opened.posed(float(found.times[4]) + 0.01)
    pictures.look(opened.page, "keyposes", (1000, 720))


def test_it_opens_without_a_word(opened: Any):
    opened.posed(1.0)
    assert opened.complaints == []
    assert [url for url in opened.requests if not url.startswith(("file:", "data:", "blob:"))] == []
    assert opened.page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize(("forth", "back"), [("]", "["), ("n", "p")])
def test_keys_step_from_keypose_to_keypose(opened: Any, found: Keyposes, forth: str, back: str):
    for time in found.times[:3]:
        opened.page.keyboard.press(forth)
        assert time_of(opened) == pytest.approx(time, abs=1e-3)
    opened.page.keyboard.press(back)
    assert time_of(opened) == pytest.approx(found.times[1], abs=1e-3)
    opened.posed(float(found.times[1:3].mean()))
    opened.page.keyboard.press(back)  # to the one that is shown first
    assert time_of(opened) == pytest.approx(found.times[1], abs=1e-3)


def test_steps_end_at_the_first_and_the_last(opened: Any, found: Keyposes):
    opened.page.keyboard.press("[")
    assert time_of(opened) == pytest.approx(found.times[0], abs=1e-3)
    opened.page.evaluate(f"window.onbeat.seek({found.times[-1] + 0.1})")
    opened.page.keyboard.press("]")
    assert time_of(opened) == pytest.approx(found.times[-1], abs=1e-3)


def test_the_number_of_the_current_keypose_is_shown(opened: Any, found: Keyposes):
    assert opened.page.text_content("#keypose") == "Keypose –"
    for index in (0, 4, len(found) - 1):
        opened.posed(float(found.times[index]) + 0.01)
        assert opened.state()["keypose"] == index
        assert opened.page.text_content("#keypose") == f"Keypose {index + 1}"
        assert opened.page.text_content("#poses button[aria-current]") == str(index + 1)


def test_buttons_step_and_pictures_jump(opened: Any, found: Keyposes):
    opened.page.click("#next")
    opened.page.click("#next")
    opened.page.click("#previous")
    assert time_of(opened) == pytest.approx(found.times[0], abs=1e-3)
    opened.page.locator("#poses button").nth(3).click()
    assert time_of(opened) == pytest.approx(found.times[3], abs=1e-3)


def test_marks_on_both_strips_jump(opened: Any, found: Keyposes):
    page, motion = opened.page, dancers(1)[0].motion
    box = page.locator("#overview").bounding_box()
    page.mouse.click(box["x"] + found.times[5] / motion.duration * box["width"] + 3, box["y"] + 6)
    assert time_of(opened) == pytest.approx(found.times[5], abs=1e-3)
    box = page.locator("#detail").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2 + 95 * (found.times[6] - found.times[5]) - 6, box["y"] + 9)
    assert time_of(opened) == pytest.approx(found.times[6], abs=1e-3)


def test_there_is_a_picture_of_every_keypose_and_they_differ(opened: Any, found: Keyposes):
    pictures = opened.page.evaluate("[...document.querySelectorAll('#poses canvas')].map(canvas => canvas.toDataURL())")
    assert len(pictures) == len(found)
    assert all(len(picture) > 1000 for picture in pictures)  # something is drawn
    assert len(set(pictures)) == len(found)
