"""``onbeat live`` and its page as a user has them: the embedded song is heard, and the dancer dances to it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from onbeat.examples.song import demo_score
from onbeat.examples.troupe import dance_library
from onbeat.formats.write import write_motion

pytestmark = pytest.mark.browser
LIVE = [sys.executable, "-c", "from onbeat.cli import main; main()", "live"]
STATE = "window.onbeatLive.state()"


def until(page: Any, condition: str) -> dict[str, Any]:
    """The state as soon as a condition on it, ``s``, holds."""
    look = f"const look = () => {{ const s = {STATE}; ({condition}) ? done(s) : setTimeout(look, 50); }}; look();"
    late = "setTimeout(() => fail(new Error('waited 240 s in vain')), 240000);"
    return page.evaluate(f"new Promise((done, fail) => {{ {look} {late} }})")


def test_the_embedded_song_is_danced_to_and_beats_are_drawn_in_step(chromium, tmp_path):
    write_motion(dance_library()[0].motion, tmp_path / "dance.bvh")
    words = [*LIVE, str(tmp_path / "dance.bvh"), "--port", "0", "--seconds", "600"]
    process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
    try:
        lines = (process.stderr.readline() for _ in range(4))
        address = next(found[0] for line in lines if (found := re.search(r"http://\S+/", line)))
        page = chromium.new_page()
        page.set_default_timeout(120_000)
        complaints: list[str] = []
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(address)
        state = until(page, "s.dancing !== 'resting' && s.beats.length >= 6 && s.strikes.length >= 6")
        at_first = json.dumps(state["joints"])
        until(page, f"s.joints.some((place, k) => Math.abs(place - {at_first}[k]) > 0.05)")  # metres; it dances
        true = np.array(demo_score(60.0).grid.beats)
        heard = np.array([beat["time"] for beat in state["beats"]]) % 60.0  # the song begins again after a minute
        struck = np.array([strike["time"] for strike in state["strikes"]]) % 60.0
        assert np.mean(np.abs(heard[:, None] - true).min(axis=1) < 0.07) > 0.8
        assert np.mean(np.abs(struck[:, None] - true).min(axis=1) < 0.07) > 0.8
        assert min(strike["shown"] - strike["time"] for strike in state["strikes"]) >= 0
        assert not complaints
    finally:
        process.kill()
        process.wait()
