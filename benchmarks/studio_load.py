"""The studio under load: ``python benchmarks/studio_load.py``.

Twenty dances are ordered, two are made at a time, one is cancelled, and in the middle of it the server is killed
(SIGKILL) and started again. Told are: what became of each job, whether any was done twice or its process outlived the
server, how long it took, and how long the page had to wait for answers meanwhile.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx
from rich.console import Console
from rich.table import Table

ONBEAT = Path(sys.executable).with_name("onbeat")
OVER = ("done", "failed", "cancelled")
PATIENCE = 1800.0


class Server:
    """``onbeat studio`` in a process of its own."""

    def __init__(self, project: Path) -> None:
        line = [str(ONBEAT), "studio", str(project), "--no-open", "--port", "0"]
        self.process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.process.stdout is not None
        self.client = httpx.Client(base_url=self.process.stdout.readline().strip(), timeout=60)
        self.slowest = 0.0

    def project(self) -> dict[str, Any]:
        began = time.perf_counter()
        found = self.client.get("/api/project").json()
        self.slowest = max(self.slowest, time.perf_counter() - began)
        return found

    def until(self, done: int) -> dict[str, Any]:
        """The project when so many jobs are over."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            found = self.project()
            if sum(job["state"] in OVER for job in found["jobs"]) >= done:
                return found
            time.sleep(0.2)
        raise TimeoutError(f"{done} jobs are not over after {PATIENCE:.0f} s")

    def memory(self) -> float:
        """Megabytes that it has taken at most (Linux)."""
        lines = Path(f"/proc/{self.process.pid}/status").read_text().splitlines()
        return next(float(line.split()[1]) / 1e3 for line in lines if line.startswith("VmHWM"))


def workers_of(project: Path) -> list[int]:
    """Processes of jobs that work in a project, as their folders tell (Linux)."""
    found: list[int] = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and Path(os.readlink(entry / "cwd")).is_relative_to(project / "work"):
                found.append(int(entry.name))
        except OSError:
            continue
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--jobs", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=8.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run(Path(folder) / "project", options.jobs, options.seconds)


def run(project: Path, jobs: int, seconds: float) -> None:
    began = time.monotonic()
    server = Server(project)
    server.until(2)  # the embedded song and the troupe
    ready = time.monotonic()
    made = [
        server.client.post(
            "/api/dances", json={"song": "song", "start": float(n), "seconds": seconds, "seed": n}
        ).json()
        for n in range(jobs)
    ]
    gone = made[jobs // 2]
    cancelled = server.client.post(f"/api/jobs/{gone['job']}/cancel").json()["state"]
    running = max_running(server, 2 + 1 + jobs // 4)
    before = server.project()
    done_before = {job["id"] for job in before["jobs"] if job["state"] == "done"}
    written = {dance["id"]: stamp(project, dance["id"]) for dance in before["dances"] if dance["state"] == "ready"}
    memory = server.memory()
    os.kill(server.process.pid, signal.SIGKILL)
    server.process.wait()
    time.sleep(1.0)
    left = workers_of(project)
    again = Server(project)
    after = again.until(2 + jobs)
    states = [dance["state"] for dance in after["dances"]]
    twice = [id for id, was in written.items() if stamp(project, id) != was]
    again.process.send_signal(signal.SIGTERM)
    again.process.wait()
    rows = {
        "jobs ordered": jobs,
        "cancelled": f"{states.count('cancelled')} ({cancelled})",
        "at a time": running,
        "done when the server was killed": len(done_before) - 2,
        "processes that outlived it by 1 s": len(left),
        "done at the end": states.count("ready"),
        "lost or failed": jobs - states.count("ready") - states.count("cancelled"),
        "done twice": len(twice),
        "seconds, from the orders to the end": f"{time.monotonic() - ready:.0f}",
        "seconds until the first order": f"{ready - began:.0f}",
        "slowest answer to /api/project": f"{1000 * max(server.slowest, again.slowest):.0f} ms",
        "memory of the server": f"{memory:.0f} MB",
    }
    table = Table("the studio under load", "")
    for name, value in rows.items():
        table.add_row(name, str(value))
    Console().print(table)


def max_running(server: Server, done: int) -> int:
    """The most jobs seen running at once until so many are over."""
    most = 0
    while True:
        states = [job["state"] for job in server.project()["jobs"]]
        most = max(most, states.count("running"))
        if sum(state in OVER for state in states) >= done:
            return most
        time.sleep(0.1)


def stamp(project: Path, dance: str) -> int:
    """When a dance was written."""
    return (project / "dances" / dance / "scene.json").stat().st_mtime_ns


if __name__ == "__main__":
    main()
