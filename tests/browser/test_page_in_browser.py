"""The page in a real browser, opened from a file: the dancer moves with the clock, clicks and keys seek."""

from __future__ import annotations

import io
from typing import Any

import msgspec
import numpy as np
import pytest
from matplotlib import image

from browser.pictures import Pictures
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.viewer.contract import StepData, WarpData
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.page import filled, write_page

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
    steps = [StepData("left", 1.0, 2.0, -0.5, 0.9, 0.0, 0.3), StepData("right", 1.9, 2.5, -0.5, 0.9, 0.0, 0.3)]
    page = page_data(swinger, song, document, (samples, 22050))
    warp = WarpData([0.0, 2.0, 4.0], [0.0, 1.9, 4.0])
    path.write_bytes(filled(msgspec.structs.replace(page, steps=steps, warp=warp)))
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
    opened_with_song.page.set_viewport_size({"width": 480, "height": 560})
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


def test_it_looks_as_it_did(with_song: Any, pictures: Pictures) -> None:
    with_song.posed(1.5)
    pictures.look(with_song.page, "dance")
    pictures.look(with_song.page, "dance_dark", dark=True)
    pictures.look(with_song.page, "dance_phone", (390, 844))


def test_the_motion_graph_looks_as_it_did(with_song: Any, pictures: Pictures) -> None:
    page = with_song.page
    page.click("#roads")
    with_song.posed(2.5)
    try:
        pictures.look(page, "dance_graph", (900, 560))
    finally:  # the other tests have the dancer to themselves
        page.click("#roads")


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
    apart: list[float] = []
    # Sound stands still for a moment when a busy machine has no time for it: one round of a few is enough.
    while min(apart, default=1.0) >= 0.2 and len(apart) < 6:
        times = with_song.page.evaluate(
            """async () => {
                window.onbeat.seek(0);
                window.onbeat.play();
                const seen = [];
                while (seen.length < 18 && window.onbeat.state().time < 3) {
                    await new Promise(requestAnimationFrame);
                    seen.push([performance.now() / 1000, window.onbeat.state().time]);
                }
                return seen;
            }"""
        )
        clock, dance = np.array(times)[min(5, len(times) - 2) :].T
        assert np.all(np.diff(dance) >= 0)
        apart.append(float(np.ptp(dance - clock)))
    assert min(apart) < 0.2, apart


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


def test_there_is_something_to_see(with_song: Any) -> None:
    page = with_song.page
    with_song.posed(1.0)
    first = pixels(page)
    red = (first[..., 0] > 0.55) & (first[..., 1] < 0.45) & (first[..., 2] < 0.4)
    stage = page.locator("#stage").bounding_box()
    assert red[: int(stage["height"])].sum() > 900, "the dancer's shirt"
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
    # A busy machine leaves out what it would sound late, and the song may be over before two have sounded.
    again = "window.onbeat.state().playing || (window.onbeat.seek(0), window.onbeat.play())"
    with_song.until(f"{again}, window.onbeat.state().clicks >= 2")
    page.click("#clicks")
    sounded = page.evaluate("window.onbeat.state().clicks")
    page.evaluate("window.onbeat.seek(0.3); window.onbeat.play()")
    with_song.until("window.onbeat.state().time > 1.2")
    assert page.evaluate("window.onbeat.state().clicks") == sounded


def test_what_a_page_has_nothing_of_it_does_not_show(silent: Any) -> None:
    state = silent.posed(1.0)
    assert (state["heat"], state["master"], state["other"]) == ([], None, [])
    for part in ("#clicks", "#poses", "#stepper", "#previous", "#heat", "#master"):
        assert not silent.page.is_visible(part), part
    silent.page.keyboard.press("]")  # to the next keypose
    assert silent.state()["time"] == pytest.approx(1.0)
    assert silent.complaints == []


def test_clocks_of_sound_and_pose_agree_at_every_speed(with_song: Any) -> None:
    for speed in (0.5, 1, 1.5):
        seen = np.array(
            with_song.page.evaluate(
                """async speed => {
                    const slider = document.getElementById("speed");
                    slider.value = speed;
                    slider.dispatchEvent(new Event("input"));
                    window.onbeat.seek(0.2);
                    window.onbeat.play();
                    const [seen, late] = [[], performance.now() + 20000];
                    const enough = () => seen.length > 5 && seen.at(-1)[0] - seen[0][0] > 0.3;
                    while (!enough() && window.onbeat.state().time < 3.5 && performance.now() < late) {
                        await new Promise(requestAnimationFrame);
                        const { heard, posed, rate } = window.onbeat.state();
                        if (heard !== null && heard > 0.3) seen.push([heard, posed, rate]);
                    }
                    window.onbeat.pause();
                    return seen;
                }""",
                speed,
            )
        )
        assert len(seen) >= 2
        heard, posed, rate = seen.T
        assert (rate == speed).all()
        assert np.ptp(heard) > 0.1
        assert np.median(np.abs(heard - posed)) < 0.1, (speed, np.abs(heard - posed).max())
    with_song.page.keyboard.press("0")
    assert with_song.state()["rate"] == 1


def test_a_stretch_chosen_along_the_seconds_is_played_over_and_over(with_song: Any) -> None:
    page = with_song.page
    with_song.posed(2.0)
    box = page.locator("#detail").bounding_box()
    middle, ruler = box["x"] + box["width"] / 2, box["y"] + 7
    page.mouse.move(middle - 95, ruler)
    page.mouse.down()
    page.mouse.move(middle - 40, ruler)
    page.mouse.move(middle - 19, ruler)
    page.mouse.up()
    low, high, on = with_song.state()["loop"]
    assert (low, high) == pytest.approx((1.0, 1.8), abs=0.03)
    assert on
    page.evaluate("window.onbeat.seek(1.6); window.onbeat.play()")
    with_song.until("window.onbeat.state().time < 1.4")
    assert with_song.state()["time"] >= low - 0.001
    page.keyboard.press("l")
    with_song.until("window.onbeat.state().time > 1.95")
    assert page.get_attribute("#loop", "aria-pressed") == "false"


def test_lanes_are_zoomed_scrolled_hidden_and_told(with_song: Any) -> None:
    page = with_song.page
    with_song.posed(2.0)
    box = page.locator("#detail").bounding_box()
    assert {"Stops", "Waveform", "Clips"} <= set(page.locator("#names span").all_text_contents())
    before = with_song.state()["lanes"]
    page.mouse.move(box["x"] + 100, box["y"] + 40)
    page.mouse.wheel(0, -300)
    with_song.until(
        f"window.onbeat.state().lanes.to - window.onbeat.state().lanes.from < {before['to'] - before['from']}"
    )
    near = with_song.state()["lanes"]
    at = lambda span: span["from"] + 100 / span["width"] * (span["to"] - span["from"])  # noqa: E731
    assert at(near) == pytest.approx(at(before), abs=0.03)
    page.mouse.wheel(60, 0)
    with_song.until(f"window.onbeat.state().lanes.from > {near['from']}")
    page.mouse.move(box["x"] + 150, box["y"] + box["height"] - 6)
    assert any("walk" in line for line in page.locator("#tip").all_text_contents())
    page.click("#lanes summary")
    tall = page.locator("#detail").bounding_box()["height"]
    page.click("#lanes label:has-text('Waveform')")
    page.keyboard.press("Escape")
    assert page.locator("#detail").bounding_box()["height"] < tall


def test_the_camera_goes_where_keys_send_it(with_song: Any) -> None:
    page = with_song.page
    for key, view in zip("12345", ("front", "side", "top", "follow", "orbit"), strict=True):
        page.keyboard.press(key)
        assert with_song.state()["view"] == view
        assert page.get_attribute(f"[data-view={view}]", "aria-pressed") == "true"
    page.keyboard.press("3")
    with_song.until("Math.hypot(...window.onbeat.state().camera.slice(0, 2)) < 0.4")
    assert with_song.state()["camera"][2] > 3
    page.keyboard.press("f")
    assert with_song.state()["view"] == "follow"


def test_feet_ghosts_and_the_graph_are_shown_when_asked_for(with_song: Any) -> None:
    page = with_song.page
    with_song.posed(1.5)
    plain = pixels(page)
    assert with_song.state()["standing"] == ["left"]
    page.keyboard.press("s")
    with_song.posed(1.5)
    assert np.abs(pixels(page) - plain).max() > 0.1
    page.click("#feet")
    page.keyboard.press("o")
    assert with_song.state()["ghosts"] == 1
    with_song.posed(1.5)
    assert np.abs(pixels(page) - plain).max() > 0.1
    page.select_option("#ghosts", "warp")
    with_song.posed(1.5)
    page.select_option("#ghosts", "off")
    assert page.locator("#graph").is_hidden()
    page.click("#roads")
    with_song.posed(1.5)
    assert "Move 1 of 2: walk" in str(page.text_content("#road"))
    page.click("#later")
    assert with_song.state()["time"] == pytest.approx(2.0)
    page.click("#roads")


def test_everything_is_reached_by_tab_and_has_a_name(with_song: Any) -> None:
    page = with_song.page
    found = page.evaluate(
        """() => [...document.querySelectorAll("button, summary, input, select, [tabindex]")]
            .filter(each => each.checkVisibility() && !each.closest("dialog")
                && (each.tagName === "SUMMARY" || !each.closest("details:not([open])")))
            .map(each => [each.id || each.dataset.view || each.textContent,
                each.getAttribute("aria-label") || each.labels?.[0]?.textContent || each.textContent.trim()])"""
    )
    assert all(name for _, name in found), found
    reached = set()
    for _ in range(len(found) + 4):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("(e => e.id || e.dataset.view || e.textContent)(document.activeElement)"))
    assert {name for name, _ in found} <= reached
    page.keyboard.press("?")
    assert page.evaluate("document.querySelector('#keyboard').contains(document.activeElement)")
    page.keyboard.press("Escape")
    assert page.locator("#keyboard").is_hidden()
    page.focus("#loop")
    page.keyboard.press("Space")
    assert not with_song.state()["playing"]
    assert page.get_attribute("#loop", "aria-pressed") == "true"
    page.keyboard.press("l")


CONTRAST = """() => {
    const parsed = colour => (colour.match(/[\\d.]+/g) || []).map(Number);
    const over = ([r, g, b, a = 1], under) => [r, g, b].map((value, i) => value * a + under[i] * (1 - a));
    const bright = colour => colour.map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
        .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const grounds = element => {
        const style = getComputedStyle(element);
        const own = parsed(style.backgroundColor);
        const stops = (style.backgroundImage.match(/rgba?\\([^)]*\\)/g) || []).map(parsed);
        const solid = own.length && (own[3] ?? 1) === 1;
        if (solid && !stops.length) return [own];
        const below = element.parentElement ? grounds(element.parentElement) : [[255, 255, 255]];
        const mixed = below.map(under => over(own.length ? own : [0, 0, 0, 0], under));
        return stops.length ? stops.map(stop => over(stop, mixed[0])) : mixed;
    };
    const low = [];
    const words = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (words.nextNode()) {
        const element = words.currentNode.parentElement;
        const seen = words.currentNode.textContent.trim() && element.checkVisibility();
        if (!seen || element.closest("script, option, [aria-hidden]")) continue;
        const ink = parsed(getComputedStyle(element).color);
        for (const ground of grounds(element)) {
            const [a, b] = [bright(over(ink, ground)), bright(ground)];
            const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
            if (ratio < 4.5) low.push([words.currentNode.textContent, ratio]);
        }
    }
    return low;
}"""


def test_words_stand_out_in_a_light_and_in_a_dark_room(with_song: Any) -> None:
    page = with_song.page
    page.click("#figures summary")
    page.keyboard.press("g")
    for _ in range(2):
        assert page.evaluate(CONTRAST) == []
        page.keyboard.press("d")
    page.keyboard.press("g")
    page.keyboard.press("Escape")
    assert page.get_attribute("#figures", "open") is None


def test_all_is_in_the_window_of_a_phone(with_song: Any) -> None:
    page = with_song.page
    page.set_viewport_size({"width": 390, "height": 844})
    with_song.posed(0.0)
    begin = page.locator("#start").bounding_box()
    assert begin["x"] > 390 / 2 + 60  # beside the dancer's feet, not on them
    with_song.posed(1.0)
    outside = page.evaluate(
        """() => [...document.querySelectorAll("button, summary, input, select, canvas, h1")].filter(each => {
            const { left, right, top, bottom } = each.getBoundingClientRect();
            const shown = each.checkVisibility() && !each.closest("details:not([open]) > div, dialog, #poses");
            return shown && (left < 0 || right > innerWidth || top < 0 || bottom > innerHeight);
        }).map(each => each.id)"""
    )
    assert outside == []
