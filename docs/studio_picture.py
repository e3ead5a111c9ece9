"""Makes the picture of the studio, with what onbeat brings along: ``python docs/studio_picture.py``.

Opens a studio in a temporary folder, orders a dance to the embedded song and one at another speed, opens the first in a
headless chromium (``ONBEAT_CHROMIUM``, or the one that is installed; playwright is among the extras ``dev``), and takes
the picture once the dancer stands on a downbeat.
"""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

from PIL import Image

PICTURE = Path(__file__).parent / "pictures" / "studio.webp"
SIZE = (1280, 800)
LARGEST = 120_000
"""Bytes of the picture."""
SECONDS, SHOWN = 30.0, 16.0
"""Of the song that are danced to, and about the second that is shown."""
PATIENCE = 600.0
"""Seconds for a dance on a busy machine."""
STUDIO = [sys.executable, "-c", "from onbeat.cli import main; main()", "studio"]
FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@contextmanager
def studio(folder: Path) -> Iterator[str]:
    """The address of a studio over a project folder."""
    words = [*STUDIO, str(folder), "--port", "0", "--no-open"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert process.stdout is not None
        yield process.stdout.readline().strip()
    finally:
        process.terminate()
        process.wait(20)


def ask(address: str, path: str, body: dict[str, Any] | None = None) -> dict[str, Any]:
    """What the studio answers, to an order if there is one."""
    data = None if body is None else json.dumps(body).encode()
    with urlopen(Request(f"{address}api/{path}", data, {"Content-Type": "application/json"})) as answer:
        return json.load(answer)


def settled(address: str) -> dict[str, Any]:
    """The project when all its jobs are done.

    Raises
    ------
    RuntimeError
        If one failed, or they go on too long.
    """
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        told = ask(address, "project")
        states = {job["state"] for job in told["jobs"]}
        if "failed" in states:
            raise RuntimeError(f"a job failed: {[job for job in told['jobs'] if job['state'] == 'failed']}")
        if not states & {"waiting", "running"}:
            return told
        time.sleep(0.5)
    raise RuntimeError(f"jobs go on after {PATIENCE:.0f} s")


def danced(address: str) -> str:
    """Order the dances; the place of the first in the page."""
    ask(address, "dances", {"song": "song", "seconds": SECONDS, "name": "an evening"})
    (first,) = settled(address)["dances"]
    ask(address, f"dances/{first['id']}/retimed", {"speed": 1.2})
    settled(address)
    return f"dance/{first['id']}"


def photographed(address: str, place: str) -> bytes:
    """The page with the dance, as PNG."""
    from playwright.sync_api import sync_playwright

    path = os.environ.get("ONBEAT_CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=FLAGS)
        page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]}, color_scheme="light")
        page.set_default_timeout(120_000)
        page.goto(f"{address}#{place}")
        page.wait_for_selector(".dance .track")
        beats = ask(address, "songs/song")["downbeats"]
        page.evaluate("time => window.onbeatStudio.seek(time)", min(beats, key=lambda beat: abs(beat - SHOWN)))
        page.wait_for_selector("#notices li", state="detached")
        page.wait_for_timeout(1500)
        picture = page.screenshot()
        browser.close()
    return picture


def packed(picture: bytes) -> bytes:
    """A picture as WebP of at most ``LARGEST`` bytes.

    Raises
    ------
    RuntimeError
        If it is larger at any quality that is worth looking at.
    """
    for quality in (92, 85, 75, 60):
        out = io.BytesIO()
        Image.open(io.BytesIO(picture)).convert("RGB").save(out, "WEBP", quality=quality, method=6)
        if out.tell() <= LARGEST:
            return out.getvalue()
    raise RuntimeError(f"the picture takes more than {LARGEST} bytes")


def main() -> None:
    """Write the picture."""
    with tempfile.TemporaryDirectory() as folder, studio(Path(folder) / "evening") as address:
        PICTURE.write_bytes(packed(photographed(address, danced(address))))


if __name__ == "__main__":
    main()
