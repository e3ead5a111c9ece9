"""How the live page looks: a session is told to it in one go, and then its clock stands still."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from browser.pictures import Pictures
from onbeat.live.page.wire import HelloData, packed, text
from onbeat.live.protocol import BeatSaid, Pose, Status
from onbeat.motion import Motion
from onbeat.viewer.pages.content import body_data
from onbeat.viewer.pages.live import live_page

pytestmark = pytest.mark.browser
ADDRESS = "http://127.0.0.1:1/"
BEGIN, END, BEAT = 6.0, 9.2, 0.5
STOPPED = """
    window.second = 0;
    performance.now = () => 1000 * window.second;
    const next = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = draw => next(() => draw(performance.now()));
    window.WebSocket = class { constructor() { window.line = this; this.readyState = 1; } close() {} };
"""
TELL = """told => {
    for (const [second, message, bytes] of told) {
        window.second = second;
        const raw = bytes && Uint8Array.from(atob(bytes), letter => letter.charCodeAt(0)).buffer;
        window.line.onmessage({ data: raw || message });
    }
}"""


def session(motion: Motion) -> list[tuple[float, str, str]]:
    """What a session says over three seconds: when, and what."""
    body = body_data(motion, 1)
    hello = HelloData(
        1, "An evening", "swinger", "character", body.joints, body.capsules, body.spine, 0.0, 0.0, 0.05, 1.0, BEGIN,
        ["waltz"], True, 0.0, 6.0, True,
    )  # fmt: skip
    told = [(BEGIN, text(hello), "")]
    columns = [motion.skeleton.index(name) for name in body.joints]
    none = np.zeros(0)
    for number in range(int(100 * BEGIN), int(100 * END)):
        second = number / 100
        points = motion.at(np.array([second % motion.duration])).positions[0, columns].astype(np.float32)
        if number % 50 == 0:
            told.append((second, text(BeatSaid(second, number // 50 % 4 + 1, 0.9, second)), ""))
        if number % 5 == 0:
            told.append((second, text(status(second)), ""))
        pose = Pose(number, second, np.zeros(3), none.reshape(0, 4), none, points)
        told.append((second, "", base64.b64encode(packed(pose)).decode()))
    return told


def status(second: float) -> Status:
    coming = int(second / BEAT) + 1
    level = [float(np.sin(2 * second + k / 10) ** 2) for k in range(5)]
    beats = [BEAT * (coming + k) for k in range(6)]
    return Status(second, "music", 120.0, 0.8, 4, coming % 4 + 1, beats, level, "swings", 1.0)


@pytest.fixture(scope="module")
def page(swinger: Motion, chromium: Any) -> Iterator[Any]:
    context = chromium.new_context(viewport={"width": 1000, "height": 640})
    page = context.new_page()
    page.add_init_script(STOPPED)
    page.route("**/*", lambda route: route.fulfill(body=live_page(), content_type="text/html"))
    page.goto(ADDRESS)
    page.evaluate(TELL, session(swinger))
    yield page
    context.close()


def test_it_looks_as_it_did(page: Any, pictures: Pictures) -> None:
    pictures.look(page, "live", (1000, 640))
    pictures.look(page, "live_phone", (390, 844), dark=True)
