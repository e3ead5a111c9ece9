"""What the studio asks for and keeps: rates of frames, the other half of a motion, steps back, entries of forms."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import numpy as np
import pytest

from browser.studio_page import SECONDS, Opened, song, studio
from onbeat.formats.trc.write import write_trc
from onbeat.motion import Markers
from persons import AMC, ASF

pytestmark = pytest.mark.browser
STANDS = "0,0,0.79,0,0,0,1"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with studio(tmp_path_factory.mktemp("studio") / "kept") as address:
        yield address


@pytest.fixture(scope="module")
def opened(address: str, chromium: Any) -> Iterator[Opened]:
    context = chromium.new_context(viewport={"width": 1280, "height": 800})
    yield Opened(context.new_page(), address)
    context.close()


def motions(address: str) -> dict[str, dict[str, Any]]:
    return {item["name"]: item for item in json.load(urlopen(f"{address}api/project"))["motions"]}


def table(frames: int) -> bytes:
    """A robot that stands and swings all its joints, at a rate that nobody knows."""
    return "".join(f"{STANDS},{','.join([f'{0.01 * (k % 9):.2f}'] * 29)}\n" for k in range(frames)).encode()


def test_an_amc_waits_for_its_skeleton_and_is_shown_when_it_comes(opened: Opened, address: str) -> None:
    page = opened.page
    opened.drop({"t_01.amc": AMC.encode()})
    page.wait_for_selector("text=Waits for its skeleton t.asf")
    assert page.locator("#shelf progress:visible").count() == 0, "nobody works on it"
    opened.drop({"body.asf": ASF.encode()})
    page.wait_for_selector("text=The skeleton of motions body_…")
    page.click("#shelf a:has-text('t_01')")
    page.wait_for_selector("button:has-text('Read it with body.asf')")
    opened.drop({"t.asf": ASF.encode()})
    page.wait_for_selector("text=Read now, for the skeleton has come: t_01.amc")
    page.wait_for_selector(".motion .track")
    assert motions(address)["t_01.amc"]["state"] == "ready"
    assert opened.complaints == []


def test_a_rate_that_no_file_stores_is_asked_for_and_kept(opened: Opened, address: str) -> None:
    page = opened.page
    opened.drop({"bow.csv": table(120), "turn.csv": table(90)})
    page.wait_for_selector("#shelf .card:has-text('turn') :text('30 fps assumed')")
    page.click("#shelf a:has-text('bow')")
    page.wait_for_selector(".rate.asks")
    assert page.input_value("[name=fps]") == "30"
    assert "30 frames a second, assumed" in page.inner_text(".motion .facts")
    assert page.inner_text(".rate button") == "That is right"
    page.fill("[name=fps]", "60")
    page.check("text=the same for the other .csv file")
    page.click("button:has-text('Use it')")
    page.wait_for_selector(".facts:has-text('60 frames a second, as you said')")
    assert page.locator(".rate.asks").count() == 0
    page.wait_for_selector("#shelf .card:has-text('turn') :text('0:01.5')")
    kept = motions(address)
    assert [(kept[name]["rate"], kept[name]["seconds"]) for name in ("bow.csv", "turn.csv")] == [
        (60.0, pytest.approx(2.0, abs=0.05)), (60.0, pytest.approx(1.5, abs=0.05)),
    ]  # fmt: skip
    page.click("button:has-text('As it was assumed')")
    page.wait_for_selector(".rate.asks")
    assert opened.complaints == []


def test_a_file_that_cannot_be_read_without_a_rate_is_read_with_it(opened: Opened, tmp_path: Path) -> None:
    page = opened.page
    write_trc(Markers(("LASI",), np.ones((1, 1, 3)), fps=100), tmp_path / "odd.trc")
    opened.drop({"odd.trc": (tmp_path / "odd.trc").read_bytes().replace(b"\n100.00", b"\nfast", 1)})
    page.click("#shelf a:has-text('odd')")
    page.wait_for_selector(".pending .rate:has-text('What is the frame rate of this file?')")
    assert page.input_value("[name=fps]") == ""
    page.fill("[name=fps]", "100")
    page.click(".rate button[type=submit]")
    page.wait_for_selector(".pending .rate:has-text('The file tells no frame rate; you did.')")
    assert "DataRate" not in page.inner_text(".pending .problem"), "what is wrong now is another thing"


def test_every_step_of_a_songs_beats_can_be_undone_after_it_was_left(opened: Opened, address: str) -> None:
    page = opened.page
    opened.drop({"evening.wav": song()})
    page.wait_for_selector(".editor .track")
    where, before = opened.state()["where"], opened.state()["beats"]
    page.click("button:has-text('Halve')")
    halved = opened.state()["beats"]
    page.keyboard.press("a")
    page.evaluate("location.hash = 'start'")  # before it was kept
    page.wait_for_selector(".view.start")
    page.go_back()
    page.wait_for_selector(".editor .track")
    assert len(opened.state()["beats"]) == len(halved) + 1
    for steps in (halved, before):
        page.keyboard.press("Control+z")
        assert opened.state()["beats"] == pytest.approx(steps, abs=1e-3)
    assert page.is_disabled("button:has-text('Undo')")
    page.keyboard.press("Control+Shift+z")
    page.wait_for_selector("text=your beats are kept")
    kept = json.load(urlopen(f"{address}api/songs/{where.split('/')[1]}"))
    assert kept["beats"] == pytest.approx(halved, abs=1e-3)


def test_what_was_entered_for_a_dance_is_there_after_back(opened: Opened) -> None:
    page = opened.page
    page.click("button:has-text('Dance to this song')")
    page.wait_for_selector(".stretch .track")
    page.fill("[name=start]", "2")
    page.fill("[name=seconds]", "5")
    page.select_option("[name=method]", "greedy")
    page.get_by_label("λ").fill("0.5")
    page.fill("[name=seed]", "7")
    page.evaluate("location.hash = 'start'")
    page.wait_for_selector(".view.start")
    page.go_back()
    page.wait_for_selector(".stretch .track")
    names = ("start", "seconds", "method", "seed", "intensity_weight")
    assert [page.input_value(f"[name={name}]") for name in names] == ["2", "5", "greedy", "7", "0.5"]
    page.evaluate("location.hash = 'order'")
    page.wait_for_selector("small:has-text('the best over the whole song')")  # another form has entries of its own
    assert page.input_value("[name=seed]") == "0"
    page.go_back()
    page.wait_for_selector("small:has-text('on the objective of the best')")


def test_more_seconds_than_the_song_has_left_are_told_before(opened: Opened) -> None:
    page = opened.page
    page.fill("[name=start]", "8")
    page.fill("[name=seconds]", "30")
    end = f"0:{SECONDS:04.1f}"
    page.wait_for_selector(f"text=0:08.0 to {end} of {end}: only 2.0 seconds are left from there")
    page.fill("[name=start]", "12")
    page.wait_for_selector("text=begin at second 9.0 or before")
    page.fill("[name=start]", "3")
    page.fill("[name=seconds]", "4")
    page.wait_for_selector(f"text=0:03.0 to 0:07.0 of {end}")
