"""A studio of its own for tests in the browser, its page, and a song that is dropped on it."""

from __future__ import annotations

import base64
import io
import json
import subprocess
import sys
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import numpy as np
import soundfile

from sounds import HEARD_RATE, beat_times, hat, kick, mix, piano, snare

STUDIO = [sys.executable, "-c", "from onbeat.cli import main; main()", "studio"]
STATE = "window.onbeatStudio.state()"
LONG = 90_000
"""Milliseconds for a busy machine."""
SECONDS, BPM = 10.0, 112.0
"""Of the song."""
DROP = """files => {
    const held = new DataTransfer();
    for (const [name, base64] of files) {
        held.items.add(new File([Uint8Array.from(atob(base64), letter => letter.charCodeAt(0))], name));
    }
    for (const kind of ["dragenter", "dragover", "drop"]) {
        document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: held, bubbles: true, cancelable: true }));
    }
}"""


class Opened:
    """The studio's page, and whatever it complained about."""

    def __init__(self, page: Any, address: str) -> None:
        self.page = page
        self.complaints: list[str] = []
        page.set_default_timeout(LONG)
        page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: self.complaints.append(f"exception: {error}"))
        page.goto(address)
        page.wait_for_selector("#shelf .card")

    def state(self) -> dict[str, Any]:
        return self.page.evaluate(STATE)

    def drop(self, files: dict[str, bytes]) -> None:
        self.page.evaluate(DROP, [[name, base64.b64encode(data).decode()] for name, data in files.items()])


@contextmanager
def studio(project: Path) -> Generator[str]:
    """The address of a studio that neither composes its own song nor builds the troupe's moves: both take long."""
    words = [*STUDIO, str(project), "--port", "0", "--no-open"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        for job in json.load(urlopen(f"{address}api/project"))["jobs"]:
            urlopen(Request(f"{address}api/jobs/{job['id']}/cancel", method="POST")).close()
        yield address
    finally:
        process.terminate()
        process.wait(20)


def song() -> bytes:
    """A small band at a steady tempo, whose chords change with the bars."""
    rng = np.random.default_rng(0)
    beats = beat_times(BPM, SECONDS)
    tones = (220.0, 174.6, 261.6, 196.0)
    events = [(t, kick() if i % 2 == 0 else snare(rng)) for i, t in enumerate(beats)]
    events += [(t + 30 / BPM, hat(rng)) for t in beats]
    events += [(t, piano(tones[i // 4 % 4] * part, 2.0)) for i, t in enumerate(beats[::4]) for part in (1.0, 1.25, 1.5)]
    sound = io.BytesIO()
    soundfile.write(sound, mix(SECONDS, events).samples, HEARD_RATE, format="WAV")
    return sound.getvalue()
