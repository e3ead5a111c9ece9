"""How the studio looks: its page over a project that is told, not made, so that nothing in it is by chance."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile

from browser.pictures import Pictures
from onbeat.motion import Motion
from onbeat.music.song import Song
from onbeat.studio.export_formats import format_items
from onbeat.studio.page import page as studio_page
from onbeat.studio.studio import METHODS, ROBOTS
from onbeat.studio.wire import (
    VERSION,
    DanceItem,
    DanceOrder,
    DanceView,
    ExportItem,
    JobItem,
    LibraryItem,
    MotionItem,
    Project,
    SongItem,
    SongView,
)
from onbeat.viewer.contract import ClipData, GraphData, JoinData, pack_curve
from onbeat.viewer.pages.content import page_data

pytestmark = pytest.mark.browser
ADDRESS = "http://127.0.0.1:1/"
SECONDS, BPM = 24.0, 112.0
BEATS = (0.4 + 60 / BPM * np.arange(43)).round(4)
NO_EVENTS = "window.EventSource = class { constructor() { setTimeout(() => this.onopen?.(), 0) } close() {} };"
STATE = "window.onbeatStudio.state()"
VIEWS = {
    "start": ("studio_start", (1280, 800), False),
    "song/song-1": ("studio_song", (1100, 700), False),
    "dance/dance-1": ("studio_dance", (1280, 800), True),
    "order/song-1": ("studio_order", (1000, 700), False),
}


def sound() -> bytes:
    """Twenty-four seconds of silence."""
    buffer = io.BytesIO()
    soundfile.write(buffer, np.zeros(int(8000 * SECONDS)), 8000, format="WAV")
    return buffer.getvalue()


def curve(rate: float, period: float) -> Any:
    """A curve that rises and falls."""
    times = np.arange(int(SECONDS * rate)) / rate
    return pack_curve(0.5 + 0.45 * np.sin(2 * np.pi * times / period) * np.cos(times), rate)


def song_view() -> SongView:
    sure = np.where(np.arange(43) % 7, 0.95, 0.4).tolist()
    change = np.where(np.arange(43) % 4, 0.1, 0.8).tolist()
    heard, waves = BEATS.tolist(), curve(50.0, 60 / BPM)
    return SongView(
        "song-1", "Evening", SECONDS, BPM, 4, heard, heard[::4], change, sure, curve(10.0, 9.0), waves, False,
        "A minor", heard,
    )  # fmt: skip


def dance_view(motion: Motion, item: DanceItem) -> DanceView:
    """The dancer stays in its place: the camera need not go after it."""
    motion = replace(motion, root_positions=np.tile(motion.root_positions[0], (len(motion.root_positions), 1)))
    song = Song(4.0, BPM, 4, BEATS[:7], BEATS[:7:4], np.zeros(7), [0, 4], [0.2, 0.9], title="Evening")
    moves = [
        {"clip": clip, "from_s": 0.0, "to_s": 1.4, "at_s": at} for clip, at in (("bow", 0), ("turn", 1.4), ("bow", 2.6))
    ]
    scene = page_data(motion, song, {"method": "optimal", "stops": BEATS[:7].tolist(), "moves": moves})
    clips = [ClipData("bow", 6.0), ClipData("turn", 4.0), ClipData("wave", 8.0)]
    joins = [JoinData(0, 1.4, 1, 0.0), JoinData(1, 1.2, 0, 0.0), JoinData(1, 3.0, 2, 5.0), JoinData(2, 2.0, 0, 4.0)]
    scene = msgspec.structs.replace(scene, graph=GraphData(clips, joins, 3, 4))
    return DanceView(item, scene.metrics, scene)


def project() -> Project:
    """Songs, motions, a library and dances, one of which is being made."""
    order = DanceOrder("song-1", "library-1", 0.0, 4.0)
    return Project(
        VERSION, "An evening", 1, 1 << 30,
        [
            SongItem("song-1", "Evening", "ready", duration=SECONDS, tempo=BPM),
            SongItem("song-2", "A song with a name that is too long to be shown on the shelf", "waiting", "job-2"),
        ],
        [
            MotionItem("motion-1", "bow", "ready", seconds=6.0, fps=30.0, body="a person of 1.70 m"),
            MotionItem("motion-2", "broken", "failed", error="broken.bvh ends in frame 12 of 40"),
        ],
        [
            LibraryItem("troupe", "The troupe", "ready", clips=40, seconds=320.0),
            LibraryItem("library-1", "Evening's moves", "ready", motions=["motion-1"], clips=3, seconds=18.0),
        ],
        [
            DanceItem("dance-1", "Evening 1", "danced", order, "ready", song="song-1", seconds=4.0, f50=0.83),
            DanceItem("dance-2", "Evening 2", "danced", order, "waiting", "job-1", song="song-1"),
        ],
        [ExportItem("export-1", "dance-1", "glb", "Evening 1.glb", state="ready", bytes=734003)],
        [
            JobItem("job-1", "dance", "dance-2", "Dance “Evening 2”", "running", 0.4, 12.0, "searching"),
            JobItem("job-2", "listen", "song-2", "Listen to a song", "waiting"),
        ],
        list(ROBOTS), list(METHODS), format_items(),
    )  # fmt: skip


@pytest.fixture(scope="module")
def opened(swinger: Motion, chromium: Any) -> Iterator[Any]:
    """The page, whose questions are answered here; what else it asks for is not there."""
    told = project()
    answers = {
        "api/project": told,
        "api/songs/song-1": song_view(),
        "api/dances/dance-1": dance_view(swinger, told.dances[0]),
    }
    shell, headers = studio_page()

    def answer(route: Any) -> None:
        asked = route.request.url.removeprefix(ADDRESS)
        if asked == "":
            return route.fulfill(body=shell, headers=headers, content_type="text/html")
        if asked.endswith("/sound"):
            return route.fulfill(body=sound(), content_type="audio/wav")
        if asked not in answers:
            return route.fulfill(status=404, body=b'{"error": "it is not here"}', content_type="application/json")
        return route.fulfill(body=msgspec.json.encode(answers[asked]), content_type="application/json")

    context = chromium.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.add_init_script(NO_EVENTS)
    page.route("**/*", answer)
    page.goto(ADDRESS)
    page.wait_for_selector("#shelf .card")
    yield page
    context.close()


@pytest.mark.parametrize("view", VIEWS)
def test_the_studio_looks_as_it_did(opened: Any, pictures: Pictures, view: str) -> None:
    name, size, dark = VIEWS[view]
    opened.evaluate("view => { location.hash = view }", view)
    opened.wait_for_selector(f".view.{view.split('/')[0]} h2")
    if view.startswith("dance"):
        opened.wait_for_selector(".dance .track")
        opened.evaluate("window.onbeatStudio.seek(1.5)")
    pictures.look(opened, name, size, dark=dark)


def test_the_studio_looks_on_a_phone_as_it_did(opened: Any, pictures: Pictures) -> None:
    opened.evaluate("location.hash = 'dance/dance-1'")
    opened.wait_for_selector(".dance .track")
    opened.evaluate("window.onbeatStudio.seek(1.5)")
    pictures.look(opened, "studio_phone", (390, 844))
