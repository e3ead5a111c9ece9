"""A line on stderr every ten seconds, where it is no screen: what is done now, and how far it is."""

from __future__ import annotations

import sys
import threading
import time

EVERY = 10.0
"""Seconds between two lines, and before the first: work that is done sooner says nothing."""


class Heartbeat:
    """Tells what it was told last, from a thread of its own: work that takes long is seldom asked how far it is.

    Parameters
    ----------
    every : seconds between two lines.

    Examples
    --------
    >>> beat = Heartbeat(every=60.0)
    >>> beat.start()
    >>> beat.say("moves", 0.25, "reading a.bvh")
    >>> beat.stop()  # in less than a minute: nothing is said
    >>> beat.line(30.0)
    'onbeat: moves, reading a.bvh: 25% after 30 s'
    """

    def __init__(self, every: float | None = None) -> None:
        self._every = EVERY if every is None else every
        self._now: tuple[str, float, str] | None = None
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._beat, name="heartbeat", daemon=True)

    def start(self) -> None:
        """Begin to count the seconds."""
        self._thread.start()

    def say(self, stage: str, share: float, detail: str = "") -> None:
        """What is done now, how much of it is done, 0…1, and with which part of it."""
        self._now = stage, share, detail

    def stop(self) -> None:
        """No line comes after this."""
        self._stopped.set()
        if self._thread.is_alive():
            self._thread.join()

    def line(self, seconds: float) -> str:
        """What is said after so many seconds; nothing as long as nothing is done."""
        if self._now is None:
            return ""
        stage, share, detail = self._now
        return f"onbeat: {stage}{detail and f', {detail}'}: {share:.0%} after {seconds:.0f} s"

    def _beat(self) -> None:
        begin = time.monotonic()
        while not self._stopped.wait(min(self._every, threading.TIMEOUT_MAX)):
            if line := self.line(time.monotonic() - begin):
                print(line, file=sys.stderr, flush=True)  # noqa: T201
