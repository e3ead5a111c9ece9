"""What a source of sound is to those who listen, and the way from a device's thread to theirs."""

from __future__ import annotations

import threading
from collections import deque
from typing import Literal, Protocol

from onbeat._shapes import Float32
from onbeat.live.sound.trouble import Trouble

State = Literal["sound", "lost", "ended", "waiting"]
"""Sound comes; the device is gone and looked for; there is no more; it has not begun."""
Block = tuple[Float32, int]
"""Samples (n, channels) and their rate."""


class Listener(Protocol):
    """A source of sound."""

    @property
    def state(self) -> State:
        """How it is."""
        ...

    @property
    def latency(self) -> float:
        """Seconds since the newest sample sounded, when it can first be read; as far as it is known."""
        ...

    def start(self) -> None:
        """Begin.

        Raises
        ------
        OnbeatError
            If there is nothing to hear; the message says why.
        """
        ...

    def read(self) -> list[Block]:
        """All sound since the last call, in order; never waits."""
        ...

    def notes(self) -> list[str]:
        """What people should know, since the last call."""
        ...

    def close(self) -> None:
        """End, and give the device back."""
        ...


class Handover:
    """Blocks on their way from one thread to another: a few seconds of them, the oldest left out, and notes.

    Parameters
    ----------
    seconds : of sound that wait at the most.

    Examples
    --------
    >>> import numpy as np
    >>> way = Handover(seconds=1.0)
    >>> for _ in range(5):
    ...     way.put(np.zeros((4000, 1), np.float32), 8000)
    >>> len(way.take()), way.notes()
    (2, ['nobody listened in time: the oldest sound is left out'])
    """

    def __init__(self, seconds: float = 2.0) -> None:
        self._most = seconds
        self._lock = threading.Lock()
        self._blocks = deque[Block]()
        self._seconds, self._left_out = 0.0, 0.0
        self._notes = list[str]()
        self._late = Trouble(
            "nobody listened in time: the oldest sound is left out", "all sound is listened to again", 0.0, 0.0
        )

    def put(self, block: Float32, rate: int) -> None:
        """Add a block, which nobody changes any more."""
        with self._lock:
            self._blocks.append((block, rate))
            self._seconds += len(block) / rate
            while self._seconds > self._most + 1e-9 and len(self._blocks) > 1:
                old, its_rate = self._blocks.popleft()
                self._seconds -= len(old) / its_rate
                self._left_out += len(old) / its_rate

    def take(self) -> list[Block]:
        """All blocks that wait, the oldest first."""
        with self._lock:
            blocks, self._blocks = list(self._blocks), deque[Block]()
            if said := self._late.hear(self._left_out, self._seconds):
                self._notes.append(said)
            self._seconds, self._left_out = 0.0, 0.0
        return blocks

    def say(self, note: str) -> None:
        """Add a note."""
        with self._lock:
            self._notes.append(note)

    def notes(self) -> list[str]:
        """All notes since the last call."""
        with self._lock:
            notes, self._notes = self._notes, []
        return notes
