"""The page in a real browser, opened from a file: the dancer moves with the clock, clicks and keys seek."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from matplotlib import image

from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.viewer.page import write_page

pytestmark = pytest.mark.browser
HOSTILE = "</script><img src=x onerror=\"document.title='broken'\">"


@pytest.fixture(scope="module")
def opened_with_song(swinger: Motion, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> Any:
    path = tmp_path_factory.mktemp("page") / "dance.html"
    beats = np.arange(0.5, 4, 0.5)
    song = Song(4.0, 120.0, 4, beats, beats[::4], np.zeros(len(beats)), [0, 4], [0.1, 0.8], title="A song")
    moves = [{"clip": clip, "from_s": 0.0, "to_s": 2.0, "at_s": at} for clip, at in (("walk", 0.0), (HOSTILE, 2.0))]
    document = {"method": "optimal", "stops": beats.tolist(), "moves": moves, "metrics": {"f50": 0.8, HOSTILE: HOSTILE}}
    samples = np.sin(np.arange(22050 * 4) / 12).astype(np.float32) * 0.2
    write_page(path, swinger, song, document, (samples, 22050))
    opened = open_page(path)
    opened.until("window.onbeat.state().sound")
    return opened


@pytest.fixture(scope="module")
def opened_silent(swinger: Motion, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> Any:
    path = tmp_path_factory.mktemp("page") / "silent.html"
    write_page(path, swinger)
    return open_page(path)


@pytest.fixture
def with_song(opened_with_song: Any) -> Any:
    opened_with_song.page.evaluate("window.onbeat.pause(); window.onbeat.seek(0)")
    return opened_with_song


@pytest.fixture
def silent(opened_silent: Any) -> Any:
    opened_silent.page.evaluate("window.onbeat.pause(); window.onbeat.seek(0)")
    return opened_silent


def joints_off(state: dict[str, Any], motion: Motion) -> float:
    """Metres between the page's joints and the motion's at the page's own time."""
    expected = motion.at(np.array([state["time"]])).positions[0]
    columns = [motion.skeleton.index(name) for name in state["names"]]
    return float(np.abs(np.reshape(state["joints"], (-1, 3)) - expected[columns]).max())


def pixels(page: Any) -> np.ndarray:
    return image.imread(io.BytesIO(page.screenshot()), format="png")[..., :3]


def test_it_opens_without_a_word_and_asks_nobody(with_song: Any, silent: Any) -> None:
    for opened in (with_song, silent):
        opened.posed(1.0)
        assert opened.complaints == []
        assert [url for url in opened.requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_the_dancer_stands_as_the_motion_says(with_song: Any, swinger: Motion) -> None:
    for time in (0.0, 0.517, 2.25, 3.9):
        state = with_song.posed(time)
        assert state["time"] == pytest.approx(time)
        assert joints_off(state, swinger) < 0.002


@pytest.mark.parametrize("name", ["with_song", "silent"])
def test_playing_moves_time_and_dancer(name: str, request: pytest.FixtureRequest, swinger: Motion) -> None:
    opened = request.getfixturevalue(name)
    opened.page.keyboard.press("Space")
    opened.until("window.onbeat.state().time > 0.3")
    first = opened.state()
    opened.until(f"window.onbeat.state().time > {first['time'] + 0.4}")
    second = opened.state()
    assert first["playing"]
    assert np.abs(np.subtract(first["joints"], second["joints"])).max() > 0.1
    opened.page.keyboard.press("Space")
    stopped = opened.posed(opened.state()["time"])
    assert not stopped["playing"]
    assert joints_off(stopped, swinger) < 0.002


def test_playing_keeps_the_time_of_the_clock(with_song: Any) -> None:
    times = with_song.page.evaluate(
        """async () => {
            window.onbeat.play();
            const seen = [];
            while (seen.length < 40 && window.onbeat.state().time < 3) {
                await new Promise(requestAnimationFrame);
                seen.push([performance.now() / 1000, window.onbeat.state().time]);
            }
            return seen;
        }"""
    )
    clock, dance = np.array(times)[5:].T
    assert np.all(np.diff(dance) >= 0)
    assert np.ptp(dance - clock) < 0.2


def test_it_stops_at_the_end_and_starts_again(silent: Any) -> None:
    silent.page.evaluate("window.onbeat.seek(3.8); window.onbeat.play()")
    silent.until("!window.onbeat.state().playing")
    assert silent.state()["time"] == pytest.approx(4.0)
    silent.page.click("#play")
    silent.until("window.onbeat.state().time < 3")


def test_clicks_and_keys_seek(with_song: Any, swinger: Motion) -> None:
    box = with_song.page.locator("#overview").bounding_box()
    with_song.page.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + 20)
    assert with_song.state()["time"] == pytest.approx(3.0, abs=0.02)
    with_song.page.keyboard.press("ArrowLeft")
    assert with_song.state()["time"] == pytest.approx(1.0, abs=0.02)
    box = with_song.page.locator("#detail").bounding_box()
    with_song.page.mouse.click(box["x"] + 0.5 * box["width"] + 95, box["y"] + 20)
    assert with_song.state()["time"] == pytest.approx(2.0, abs=0.03)
    assert joints_off(with_song.posed(with_song.state()["time"]), swinger) < 0.002


def test_names_stay_text(with_song: Any) -> None:
    with_song.posed(3.0)
    assert with_song.page.title() == "A song"
    assert with_song.page.locator("#now span").text_content() == HOSTILE
    assert with_song.page.locator("#metrics dd").all_text_contents() == ["0.8", HOSTILE]
    assert with_song.page.locator("img").count() == 0


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_there_is_something_to_see(with_song: Any, width: int, height: int) -> None:
    page = with_song.page
    page.set_viewport_size({"width": width, "height": height})
    with_song.posed(1.0)
    first = pixels(page)
    red = (first[..., 0] > 0.55) & (first[..., 1] < 0.45) & (first[..., 2] < 0.4)
    stage = page.locator("#stage").bounding_box()
    assert red[: int(stage["height"])].sum() > 1500, "the dancer's shirt"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    with_song.posed(3.0)
    assert np.abs(pixels(page) - first).max() > 0.2


def test_clicks_sound_on_the_beats_when_asked_for(with_song: Any) -> None:
    page = with_song.page
    assert page.evaluate("window.onbeat.state().clicks") == 0
    page.evaluate("window.onbeat.play()")
    with_song.until("window.onbeat.state().time > 0.7")
    assert page.evaluate("window.onbeat.state().clicks") == 0  # nobody has asked yet
    page.keyboard.press("c")
    assert page.get_attribute("#clicks", "aria-pressed") == "true"
    with_song.until("window.onbeat.state().clicks >= 2")  # a busy machine leaves out what it would sound late
    page.click("#clicks")
    sounded, time = page.evaluate("[window.onbeat.state().clicks, window.onbeat.state().time]")
    with_song.until(f"window.onbeat.state().time > {time + 1.2}")
    assert page.evaluate("window.onbeat.state().clicks") == sounded


def test_without_sound_there_is_nothing_to_click_to(silent: Any) -> None:
    assert not silent.page.is_visible("#clicks")
