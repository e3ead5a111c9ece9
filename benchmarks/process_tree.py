"""A command and all its processes, measured: time, the processor's time, and the peak of memory."""

from __future__ import annotations

import contextlib
import os
import subprocess
import threading
import time
from pathlib import Path
from typing import Any, NamedTuple

import psutil

EVERY = 0.1  # s between two looks


class Peak(NamedTuple):
    """What a command took.

    Parameters
    ----------
    status : exit status.
    seconds, cpu : on the clock and of the processor, all processes together.
    memory, own : GB at most at one time, pages shared by several counted once; of these not mapped from files.
    """

    status: int
    seconds: float
    cpu: float
    memory: float
    own: float


def run_measured(command: list[str], **options: Any) -> tuple[list[str], Peak]:
    """Run a command to its end: its lines on stderr, and what it took."""
    begun, before = time.perf_counter(), os.times()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options)
    lines: list[str] = []
    assert process.stderr is not None
    reader = threading.Thread(target=lambda stream: lines.extend(stream.read().splitlines()), args=(process.stderr,))
    reader.start()
    memory, own = 0.0, 0.0
    while process.poll() is None:
        found = tree_memory(process.pid)
        memory, own = max(memory, found[0]), max(own, found[1])
        time.sleep(EVERY)
    reader.join()
    after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return lines, Peak(process.returncode, time.perf_counter() - begun, cpu, memory, own)


def tree_memory(pid: int) -> tuple[float, float]:
    """GB of a process and all below it: each page shared by several in equal parts, and those of no file alone."""
    memory = own = 0.0
    with contextlib.suppress(psutil.Error):
        whole = psutil.Process(pid)
        for process in [whole, *whole.children(recursive=True)]:
            with contextlib.suppress(psutil.Error, OSError):
                pages = _pages(process)
                memory, own = memory + pages[0], own + pages[1]
    return memory, own


def _pages(process: psutil.Process) -> tuple[float, float]:
    rollup = Path(f"/proc/{process.pid}/smaps_rollup")
    if not rollup.exists():
        size = process.memory_info().rss / 1e9
        return size, size
    found = dict(line.split(":", 1) for line in rollup.read_text().splitlines()[1:])
    return tuple(int(found[name].split()[0]) / 1e6 for name in ("Pss", "Pss_Anon"))  # type: ignore[return-value]
