"""``live.html`` in a real browser, at the page's own server: the dancer moves, beats come in step, and lines break."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from onbeat.live.page.http import Sound
from onbeat.live.page.server import Server
from onbeat.live.page.wire import HelloData
from onbeat.live.protocol import BeatSaid, Command, Event, Note, Pose, Status, Who
from onbeat.motion import Motion
from onbeat.viewer.pages.content import body_data
from onbeat.viewer.pages.live import live_page

pytestmark = pytest.mark.browser
BEAT, LATENCY = 0.5, 0.05
HOSTILE = "<img src=x onerror=\"document.title='broken'\">"
SOCKET = """
    const Real = WebSocket;
    window.WebSocket = class extends Real { constructor(...at) { super(...at); window.socket = this; } };
"""


class Playing:
    """A session that plays a motion over and over, with a beat each half second, at a server of its own."""

    def __init__(self, motion: Motion, sound: Sound | None = None) -> None:
        self.body = body_data(motion, 1)
        columns = [motion.skeleton.index(name) for name in self.body.joints]
        times = np.arange(int(motion.duration * 100)) / 100
        self.points = motion.at(times).positions[:, columns].astype(np.float32)
        self.commands: list[Command] = []
        self.hearing: Any = "music"
        self.sound = sound
        self.begin(0)

    def begin(self, port: int) -> None:
        """Another session, at this port."""
        self.server = Server(live_page(), self._hello, self.commands.append, self.sound, port=port)
        self.began = time.perf_counter()
        self.who = Who("swinger", "character", ("a",), (-1,), (), tuple(self.body.joints), LATENCY, 1000.0 * self.began)
        self.server.open(self.who)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    def say(self, event: Event) -> None:
        self.server.say(event)

    def end(self) -> int:
        """Ends it; the port where it was."""
        self._ended.set()
        self._thread.join(60)
        self.server.close()
        return int(self.server.address.rstrip("/").rpartition(":")[2])

    def _hello(self) -> HelloData:
        return HelloData(
            1, "A session", "swinger", "character", self.body.joints, self.body.capsules, self.body.spine, 0.0, 0.0,
            LATENCY, self.who.started, time.perf_counter() - self.began, [HOSTILE, "waltz"], self.sound is not None,
            0.0, 6.0 if self.sound else 0.0, True,
        )  # fmt: skip

    def _play(self) -> None:
        number = 0
        while not self._ended.wait(max(self.began + number / 100 - time.perf_counter(), 0.0)):
            second = number / 100
            points = self.points[number % len(self.points)]
            none = np.zeros(0)
            self.server.pose(Pose(number, second, np.zeros(3), none.reshape(0, 4), none, points))
            if number % 5 == 0:
                self.say(self._status(second))
            if number % 50 == 0 and self.hearing == "music":
                self.say(BeatSaid(second, number // 50 % 4 + 1, 0.9, second))
            number += 1

    def _status(self, second: float) -> Status:
        coming = int(second / BEAT) + 1
        beats = [BEAT * (coming + k) for k in range(6)]
        level = [float(abs(np.sin(9 * second + k))) for k in range(5)]
        return Status(second, self.hearing, 120.0, 0.8, 4, coming % 4 + 1, beats, level, "swings", 1.0)


class LivePage:
    """The page at a session's address, with all it complained about and asked for."""

    def __init__(self, chromium: Any, address: str) -> None:
        self.context = chromium.new_context(viewport={"width": 340, "height": 460})
        self.context.set_default_timeout(120_000)
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.complaints.append(f"exception: {error}"))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.add_init_script(SOCKET)
        self.page.goto(address)
        self.until("live.poses > 30 && live.joints.length")

    def state(self) -> dict[str, Any]:
        return self.page.evaluate("window.onbeatLive.state()")

    def until(self, condition: str) -> None:
        """Wait until a JavaScript condition on the page's state ``live`` holds."""
        look = "const live = window.onbeatLive?.state(); const now = performance.now();"
        ask = f"const look = () => {{ {look} ({condition}) ? done() : setTimeout(look, 20); }}; look();"
        late = "setTimeout(() => fail(new Error('waited 120 s in vain')), 120000);"
        self.page.evaluate(f"new Promise((done, fail) => {{ {ask} {late} }})")

    def drawn(self, script: str = "null") -> Any:
        """What a script says two pictures later."""
        wait = "await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));"
        return self.page.evaluate(f"(async () => {{ {wait} return {script}; }})()")


def wav(seconds: float) -> Sound:
    import io

    import soundfile

    buffer = io.BytesIO()
    soundfile.write(buffer, 0.01 * np.sin(np.arange(int(8000 * seconds)) / 3), 8000, format="WAV")
    return Sound(buffer.getvalue(), "audio/wav")


@pytest.fixture(scope="module")
def session(swinger: Motion) -> Iterator[Playing]:
    pytest.importorskip("websockets")
    playing = Playing(swinger, wav(6.0))
    yield playing
    playing.end()


@pytest.fixture(scope="module")
def opened_page(chromium: Any, session: Playing) -> Iterator[LivePage]:
    opened = LivePage(chromium, session.server.address)
    yield opened
    opened.context.close()


@pytest.fixture
def opened(opened_page: LivePage, session: Playing) -> LivePage:
    session.hearing = "music"
    session.commands.clear()
    return opened_page


def test_it_opens_without_a_word_and_asks_its_own_session_only(opened: LivePage, session: Playing):
    assert opened.complaints == []
    assert all(url.startswith((session.server.address, "data:")) for url in opened.requests)
    assert opened.page.title() == "A session"
    assert opened.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert opened.page.text_content("#now span") == "swings"


def test_the_dancer_stands_as_the_motion_says_at_the_second_that_is_shown(opened: LivePage, session: Playing):
    opened.until("live.poses > 90 && live.newest > live.time + 0.02")  # the first pictures take long, poses wait
    grid = np.arange(len(session.points)) / 100
    seen: list[dict[str, Any]] = []
    off: list[float] = []
    while sum(one < 0.01 for one in off) < 6 and len(seen) < 100:
        state = opened.drawn("window.onbeatLive.state()")
        seen.append(state)
        at = state["posed"] % (len(session.points) / 100)  # time goes on while a picture is drawn
        wanted = [np.interp(at, grid, track) for track in session.points.reshape(len(grid), -1).T]
        if 0.1 < at < grid[-1] - 0.1:  # else it is between the motion's end and its beginning
            off.append(float(np.abs(np.subtract(wanted, state["joints"])).max()))
    assert len({tuple(state["joints"]) for state in seen}) > 3, "it moves"
    assert np.all(np.diff([state["time"] for state in seen]) >= 0)
    # On a busy machine poses come late or far apart, and it stands still or goes straight between them for a moment.
    assert sum(one < 0.01 for one in off) >= 6, off
    assert max(off) < 0.5
    assert 0.0 < np.median([state["newest"] - state["time"] for state in seen]) < 0.6, "a little behind the newest"


def test_beats_light_up_when_they_are_shown(opened: LivePage):
    opened.until("live.strikes.length >= 4 && live.beats.length >= 3 && live.marks >= 4 && live.next.length")
    state = opened.state()
    for strike in state["strikes"][1:]:
        assert strike["time"] % BEAT == pytest.approx(0.0, abs=1e-6)
        assert strike["position"] == round(strike["time"] / BEAT) % 4 + 1
    # A software renderer on a busy machine may pass a beat over with a picture, but lights none early or twice.
    late = [strike["shown"] - strike["time"] for strike in state["strikes"]]
    assert min(late) >= 0.0
    assert np.diff([strike["time"] for strike in state["strikes"]]).min() >= BEAT - 1e-6
    assert len(state["beats"]) >= 3
    assert state["marks"] >= 4
    later = [beat["time"] for beat in state["next"]]
    assert later
    assert min(later) > state["music"] == pytest.approx(state["time"] + LATENCY)
    assert opened.page.text_content("#tempo") == "120 bpm"
    lit = "[window.onbeatLive.state().music, document.querySelector('#lights .lit')?.textContent]"
    seen = [opened.drawn(lit) for _ in range(12)]
    true = [int(number or 0) == int(music / BEAT) % 4 + 1 for music, number in seen if 0.1 < music % BEAT < BEAT - 0.02]
    assert np.mean(true) > 0.75, seen


def test_a_break_and_silence_are_told(opened: LivePage, session: Playing):
    for hearing, words in (("held", "holds the tempo"), ("nothing", "hears no music")):
        session.hearing = hearing
        opened.until(f"live.hearing === '{hearing}'")
        assert opened.page.text_content("#hearing") == words
    opened.until("document.querySelectorAll('#lights .lit').length === 0")
    assert opened.state()["next"] == []
    assert opened.page.text_content("#tempo") == "– bpm"


def test_buttons_and_keys_become_commands(opened: LivePage, session: Playing):
    page = opened.page
    for key in "nrdt":
        page.keyboard.press(key)
    page.click("#tap")
    page.keyboard.press("p")
    page.locator("#choices button").nth(1).click()
    page.keyboard.press("f")
    wanted = [*(Command(what) for what in ("next", "rest", "dance", "tap", "tap")), Command("play", "waltz")]  # type: ignore[arg-type]
    deadline = time.monotonic() + 120
    while len(session.commands) < len(wanted) and time.monotonic() < deadline:
        page.wait_for_timeout(50)
    assert session.commands == wanted
    assert not opened.state()["follow"]
    assert page.locator("#choices button").nth(0).text_content() == HOSTILE
    assert page.locator("img").count() == 0
    dark = opened.state()["dark"]
    page.keyboard.press("l")
    assert opened.state()["dark"] != dark


def test_sound_comes_with_a_click_and_keeps_in_step(opened: LivePage):
    assert not opened.state()["sound"]["sounding"]
    opened.page.click("#sound")
    opened.until("live.sound.sounding && live.sound.problem === '' && Math.abs(live.sound.error) < 0.08")
    opened.page.keyboard.press("s")
    opened.until("!live.sound.sounding")


def test_garbage_is_passed_over_and_said_once(opened: LivePage):
    before = opened.state()
    opened.page.evaluate(
        """() => {
            const status = { type: "status", time: 1, hearing: "music", tempo: 120, confidence: 1, meter: 4,
                             next_position: 1, next_beats: [], level: [], dancing: "", clock: 1, simulated: false };
            const far = new Float64Array(2 + 1.5 * window.onbeatLive.state().names.length);
            far.fill(NaN);
            const wrong = ["", "{", "null", "[1]", '{"type":"beat"}', '{"type":"status","level":null}', "7",
                '{"type":"hello","points":["a"],"capsules":[{"a":4}],"spine":[0]}',
                JSON.stringify({ ...status, tempo: null }), JSON.stringify({ ...status, next_beats: "many" }),
                new ArrayBuffer(0), new ArrayBuffer(7), new ArrayBuffer(12), far.buffer.slice(4)];
            for (const data of wrong) window.socket.onmessage({ data });
        }"""
    )
    after = opened.state()
    assert after["unread"] - before["unread"] == 14
    assert sum("unreadable" in note for note in after["notes"]) == 1
    opened.until(f"live.poses > {after['poses'] + 20} && live.time > {after['time']}")
    assert opened.complaints == []


def test_notes_are_shown_as_words(opened: LivePage, session: Playing):
    session.say(Note(1.0, HOSTILE))
    opened.until(f"live.notes.includes({json.dumps(HOSTILE)})")
    assert HOSTILE in opened.page.locator("#toasts li").all_text_contents()
    assert opened.page.title() == "A session"


def test_it_comes_back_when_the_session_does(opened: LivePage, session: Playing):
    before, complaints = opened.state(), len(opened.complaints)
    newest = max(5.0, before["newest"])
    opened.page.evaluate("window.socket.onmessage = null")  # the line stays open, but nothing comes through it
    opened.until(f"live.hellos === {before['hellos'] + 1}")
    port = session.end()
    opened.until("!live.connected")
    assert "gone" in opened.page.text_content("#message")
    session.begin(port)
    opened.until(
        f"live.connected && live.hellos === {before['hellos'] + 2} && live.newest > 1 && live.newest < {newest}"
    )
    assert not opened.page.is_visible("#message")
    assert opened.state()["notes"].count("The session is back.") == 2
    assert not [words for words in opened.complaints[complaints:] if "ERR_CONNECTION_REFUSED" not in words]
    opened.complaints.clear()
