"""The studio as a user has it: a song and a motion are dropped, danced, played with sound, and exported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from browser.studio_page import BPM, SECONDS, Opened, song, studio
from onbeat.examples.troupe import dance_library
from onbeat.formats.write import write_motion
from onbeat.viewer.contract import PathData, unpack_path
from sounds import beat_times

pytestmark = pytest.mark.browser

PLAYED = """async () => {
    const seen = [];
    while (seen.length < 12) {
        await new Promise(requestAnimationFrame);
        const { time, heard, joints, duration } = window.onbeatStudio.state();
        if (time >= duration) break; // the picture stands still at the end
        if (heard > 0.3) seen.push({ time, heard, joints });
    }
    return seen;
}"""
FAINT = """() => {
    const read = words => {
        const [r, g, b, a = 1] = words.match(/[\\d.]+/g).map(Number);
        return { r, g, b, a };
    };
    const over = (top, under) => ({
        r: top.a * top.r + (1 - top.a) * under.r,
        g: top.a * top.g + (1 - top.a) * under.g,
        b: top.a * top.b + (1 - top.a) * under.b,
        a: 1,
    });
    const light = colour => {
        const [r, g, b] = [colour.r, colour.g, colour.b]
            .map(c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const grounds = element => {
        const layers = [];
        for (let up = element; up; up = up.parentElement) {
            const { backgroundColor, backgroundImage } = getComputedStyle(up);
            const drawn = backgroundImage.match(/rgba?\\([^)]*\\)/g);
            if (drawn) return drawn.map(words => layers.reduceRight((under, top) => over(top, under), read(words)));
            const layer = read(backgroundColor);
            if (layer.a > 0) layers.push(layer);
            if (layer.a === 1) break;
        }
        return [layers.reduceRight((under, top) => over(top, under), { r: 255, g: 255, b: 255, a: 1 })];
    };
    const told = element => Array.from(element.childNodes).some(node => node.nodeType === 3 && node.textContent.trim());
    const worst = element => {
        const ink = read(getComputedStyle(element).color);
        return Math.min(...grounds(element).map(ground => {
            const [one, other] = [light(over(ink, ground)), light(ground)];
            return (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
        }));
    };
    return Array.from(document.body.querySelectorAll("*"))
        .filter(element => element.matches("input, select") || (told(element) && !element.matches("option, script")))
        .filter(element => element.checkVisibility() && !element.closest(":disabled, [aria-hidden=true]"))
        .map(element => [worst(element), element.tagName, element.className, element.textContent.slice(0, 40)])
        .filter(([contrast]) => contrast < 4.5);
}"""
CONTROLS = "a[href], button, input, select, summary, [tabindex='0']"
REACHABLE = f"""() => Array.from(document.querySelectorAll("{CONTROLS}"))
    .filter(one => one.checkVisibility() && !one.disabled)
    .map((one, i) => (one.dataset.place = String(i)))"""
UNNAMED = f"""() => Array.from(document.querySelectorAll("{CONTROLS}")).filter(one => one.checkVisibility())
    .filter(one => !(one.getAttribute("aria-label") || one.labels?.length || one.textContent.trim()))
    .map(one => one.outerHTML.slice(0, 120))"""
FOCUSED = """() => {
    const one = document.activeElement;
    const { outlineStyle, outlineWidth } = getComputedStyle(one);
    return [one.dataset.place ?? "", outlineStyle !== "none" && parseFloat(outlineWidth) >= 2];
}"""


@dataclass(frozen=True)
class Given:
    """What a user drops: a song, and motions with their roles file."""

    song: str
    files: dict[str, bytes]
    seconds: str  # of it that are danced to


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with studio(tmp_path_factory.mktemp("studio") / "evening") as address:
        yield address


@pytest.fixture(scope="module")
def opened(address: str, chromium: Any) -> Iterator[Opened]:
    context = chromium.new_context(viewport={"width": 1024, "height": 480}, accept_downloads=True)
    yield Opened(context.new_page(), address)
    context.close()


def motions(folder: Path) -> dict[str, bytes]:
    """Seven seconds each of three dancers."""
    files = {}
    for take, name in zip(dance_library(fps=30.0), ("bow", "turn", "wave"), strict=False):
        write_motion(take.motion[:210], folder / f"{name}.bvh")
        files[f"{name}.bvh"] = (folder / f"{name}.bvh").read_bytes()
    return files


@pytest.fixture(scope="module")
def given(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Given:
    """A real song and real motions where the optional data are there, else made ones."""
    roles = {"roles.toml": b'[joints]\nhips = "Hips"\n'}  # it has to come with its motions
    try:
        data: Path = request.getfixturevalue("data")
    except pytest.skip.Exception:
        return Given("evening", {"evening.wav": song(), **motions(tmp_path_factory.mktemp("given")), **roles}, "7")
    real = (data / "music" / "vibe_ace.ogg", *(data / "cmu" / f"131_0{take}.bvh" for take in (1, 2, 3)))
    return Given("vibe_ace", {file.name: file.read_bytes() for file in real} | roles, "10")


def poses(page: Any, dance: str) -> tuple[np.ndarray, float]:
    """The dance's joints (frames, joints, 3) as the page turns them, and their rate, as the server tells them."""
    scene = page.evaluate(f"fetch('/api/dances/{dance}').then(answer => answer.json())")["scene"]
    path = unpack_path(PathData(**scene["path"]), len(scene["joints"])) - [0, 0, scene["floor"]]
    cos, sin = np.cos(scene["facing"]), np.sin(scene["facing"])
    return path @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]), scene["fps"]


def test_a_song_and_a_motion_are_dropped_danced_and_taken_away(opened: Opened, given: Given, tmp_path: Path) -> None:
    page = opened.page
    opened.drop(given.files)
    page.wait_for_selector("text=3 motions came out of ")
    page.wait_for_selector(".editor .track")
    page.click("#shelf a[href^='#motion/']")
    page.wait_for_selector(".motion .track")
    assert re.search(r"\d+ stops? · \d+ keyposes?", page.inner_text(".motion .facts"))
    page.get_by_role("button", name="Make a library", exact=True).click()
    page.click("button:has-text('Build')")
    page.get_by_role("button", name="Dance with it").click()
    page.fill("[name=seconds]", given.seconds)
    page.click("button:has-text('Dance'):not([aria-label])")
    page.wait_for_selector(".dance .track")

    dance = opened.state()["dance"]
    page.keyboard.press("Space")
    seen = page.evaluate(PLAYED)
    page.keyboard.press("Space")
    path, fps = poses(page, dance)
    for one in seen:
        assert abs(one["time"] - one["heard"]) <= 0.1
        joints = np.reshape(one["joints"], (-1, 3))
        away = np.abs(np.arange(len(path)) / fps - one["heard"])
        off = np.abs(path - joints).max(axis=(1, 2))
        assert off[away <= 0.1 + 1 / fps].min() <= off[away < 0.5].min() + 0.01  # dancers come back to a pose
    assert seen[-1]["heard"] - seen[0]["heard"] > 0.3

    with page.expect_download() as download:
        page.get_by_role("button", name="Export").click()
    download.value.save_as(tmp_path / "dance.glb")
    assert (tmp_path / "dance.glb").read_bytes()[:4] == b"glTF"
    for key in "og":  # ghosts, the motion graph
        page.keyboard.press(key)
    page.wait_for_selector(".graph p:has-text('Move ')")
    assert page.input_value("[aria-label=Ghosts]") == "1"
    for key in "og":
        page.keyboard.press(key)
    assert opened.complaints == []


def test_beats_are_put_right_and_kept(opened: Opened, given: Given) -> None:
    page = opened.page
    if given.song != "evening":
        opened.drop({"evening.wav": song()})
    page.click("#shelf a[href^='#song/']:has-text('evening')")
    page.wait_for_selector(".editor .track")
    before = opened.state()["beats"]
    true = beat_times(BPM, SECONDS)
    assert np.mean(np.abs(np.array(before)[:, None] - true).min(axis=1) < 0.07) > 0.8
    box = page.locator(".editor .track").bounding_box()
    x = box["x"] + box["width"] * (before[2] + before[3]) / 2 / SECONDS  # all of it is shown
    page.mouse.dblclick(x, box["y"] + 100)
    assert len(opened.state()["beats"]) == len(before) + 1
    assert page.inner_text(".told").startswith("Added. Beat"), "said to who does not see it"
    words = page.get_attribute(".editor .track", "aria-label")
    assert f"{len(before) + 1} beats, " in words
    assert "put right: 1 not as they were heard" in words
    page.mouse.move(x, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(x + 5, box["y"] + 100)
    page.mouse.move(x + 8, box["y"] + 100)
    page.mouse.up()
    moved = opened.state()["beats"]
    assert moved[3] == pytest.approx((before[2] + before[3]) / 2 + 8 * SECONDS / box["width"], abs=0.03)
    page.wait_for_selector("text=your beats are kept")
    kept = page.evaluate("fetch(`/api/songs/${location.hash.split('/')[1]}`).then(answer => answer.json())")
    assert kept["edited"]
    assert kept["beats"] == pytest.approx(moved, abs=0.001)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert opened.state()["beats"] == pytest.approx(before)
    page.get_by_role("button", name="Back to what was heard").click()
    page.keyboard.press("Enter")
    page.wait_for_selector("text=as it was heard")
    assert opened.state()["beats"] == pytest.approx(before, abs=0.001)


def test_everything_has_a_name_is_reached_by_tab_and_can_be_read(opened: Opened) -> None:
    page = opened.page
    page.click("#shelf a[href^='#dance/']")
    page.wait_for_selector(".dance .track")
    page.evaluate("document.querySelectorAll('#notices button').forEach(button => button.click())")
    assert page.evaluate(UNNAMED) == []
    places = set(page.evaluate(REACHABLE))
    page.evaluate("document.getElementById('skip').focus()")
    reached = {page.evaluate(FOCUSED)[0]}
    for _ in range(len(places) - 1):
        page.keyboard.press("Tab")
        place, outlined = page.evaluate(FOCUSED)
        assert outlined, f"no outline on {page.evaluate('document.activeElement.outerHTML')[:120]}"
        reached.add(place)
    assert places <= reached
    library, song = (page.get_attribute(f"#shelf a[href^='#{kind}/']", "href")[1:] for kind in ("library", "song"))
    for view in ("start", "order", library, opened.state()["where"], song):
        page.evaluate("view => { location.hash = view }", view)
        page.wait_for_selector(f".view.{view.split('/')[0]} h2")
        for _ in range(2):
            assert page.evaluate(FAINT) == [], view
            page.click("#dark")


def test_what_was_entered_beside_a_dance_is_there_after_back(opened: Opened) -> None:
    page = opened.page
    page.click("#shelf a[href^='#dance/']")
    page.wait_for_selector(".dance .track")
    for label, value in (("Format", "mp4"), ("Size", "1080x1920"), ("Robot", "talos")):
        page.get_by_label(label, exact=True).select_option(value)
    page.get_by_label("Speed of the music").fill("1.25")
    page.check("text=Flashes on the beats")
    page.evaluate("window.onbeatStudio.seek(1)")
    page.keyboard.press("[")
    page.evaluate("window.onbeatStudio.seek(3)")
    page.keyboard.press("]")
    [lock] = opened.state()["locks"]
    for leave in ("location.hash = 'start'", "location.reload()"):
        page.evaluate(leave)
        if "hash" in leave:
            page.wait_for_selector(".view.start")
            page.go_back()
        page.wait_for_selector(".dance .track")
        entered = [page.get_by_label(label, exact=True).input_value() for label in ("Format", "Size", "Robot")]
        assert entered == ["mp4", "1080x1920", "talos"]
        assert page.get_by_label("Speed of the music").input_value() == "1.25"
        assert page.is_checked("text=Flashes on the beats")
        assert page.is_enabled("text=Retime")
        assert opened.state()["locks"] == [lock]


def test_each_folder_that_is_dropped_keeps_to_itself(opened: Opened, tmp_path: Path) -> None:
    page, sent = opened.page, []
    take = dance_library(fps=30.0)[0].motion[:90]
    for name in ("one", "two"):
        (tmp_path / "both" / name).mkdir(parents=True)
        write_motion(take, tmp_path / "both" / name / f"in_{name}.bvh")
        (tmp_path / "both" / name / "roles.toml").write_text('[joints]\nhips = "Hips"\n')
    page.on("request", lambda request: request.url.partition("?")[0].endswith("/api/motions") and sent.append(request))
    mouse = page.context.new_cdp_session(page)
    dragged = {"items": [], "files": [str(tmp_path / "both")], "dragOperationsMask": 1}
    for kind in ("dragEnter", "dragOver", "drop"):
        mouse.send("Input.dispatchDragEvent", {"type": kind, "x": 500, "y": 200, "data": dragged})
    for name in ("one", "two"):
        page.wait_for_selector(f"#shelf .card:has-text('in_{name}')")
    assert len(sent) == 2  # two archives, in which each motion has its own roles
    assert page.locator("#notices .bad").count() == 0
    assert opened.complaints == []


def test_dialogs_keep_the_focus_and_close_with_escape(opened: Opened) -> None:
    page = opened.page
    page.focus("#help")
    page.keyboard.press("Enter")
    for _ in range(4):
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement === document.body || !!document.activeElement.closest('dialog')")
    page.focus("dialog button")  # the browser's own bar is one of the stops
    page.keyboard.press("Escape")
    page.wait_for_selector("dialog", state="detached")
    assert page.evaluate("document.activeElement.id") == "help"


def test_a_phone_shows_it_without_scrolling_sideways(opened: Opened) -> None:
    page = opened.page
    page.set_viewport_size({"width": 360, "height": 740})
    page.click("#shelf-button")
    page.click("#shelf a[href^='#dance/']")
    page.wait_for_selector(".dance .track")
    assert not page.is_visible("#shelf")
    wide = "Math.max(document.documentElement.scrollWidth, document.getElementById('work').scrollWidth)"
    assert page.evaluate(wide) <= 360
