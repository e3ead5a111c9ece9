"""A studio for tests: its jobs are done by a process that does nothing (``studio_process.py``)."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it asks for another client than httpx, which may not be there
    from starlette.testclient import TestClient

from onbeat.studio.app import make_app
from onbeat.studio.studio import Studio

ADDRESS = "http://127.0.0.1:8642"
PROCESS = Path(__file__).with_name("studio_process.py")


def command(folder: Path) -> list[str]:
    """What the jobs' processes run: ``folder`` is where they log."""
    return [sys.executable, "-S", "-E", str(PROCESS), str(folder)]


@contextmanager
def house(folder: Path, largest: int = 1 << 20, workers: int = 2, **bound: Any) -> Iterator[TestClient]:
    """A client of a studio whose project is ``folder / "project"``."""
    studio = Studio.open(folder / "project", workers, largest, command(folder))
    app = make_app(studio, **bound)
    with TestClient(app, base_url=ADDRESS) as client:
        yield client


def project(client: TestClient) -> dict[str, Any]:
    return client.get("/api/project").json()


def settled(client: TestClient, seconds: float = 30.0) -> dict[str, Any]:
    """The project when no job waits or runs."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = project(client)
        if not any(job["state"] in ("waiting", "running") for job in found["jobs"]):
            return found
        time.sleep(0.02)
    raise AssertionError(f"jobs still go on after {seconds} s: {found['jobs']}")


def logged(folder: Path, word: str) -> list[str]:
    """Names of the jobs of which a word was logged."""
    path = folder / "log"
    lines = path.read_text().splitlines() if path.exists() else []
    return [line.partition(" ")[2] for line in lines if line.startswith(f"{word} ")]
