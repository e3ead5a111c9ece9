"""MIDI clock in: the beat of another machine, its pulses' jitter taken out."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from onbeat.live.mouths.midi_ports import Port, open_input
from onbeat.live.mouths.pulses import PER_BEAT
from onbeat.live.protocol import Clocked

TRUST = 0.12
"""Share of a pulse's lateness that is believed; cables and buses are late by milliseconds, in turn."""
PACE_TRUST = 0.008
"""Share of it that goes into the pace."""
LOST = 2.5
"""Pulses beyond whose length it is another clock, or another tempo; drivers hand over two or three at once."""
SLOWEST = 0.25
"""Seconds between two pulses beyond which there was a break."""


class SteadyPulses:
    """Times of pulses that come late and early by turns, made even: a second-order filter of time and pace.

    Examples
    --------
    >>> steady = SteadyPulses()
    >>> times = [steady.push(0.02 * n + (0.002 if n % 2 else 0.0)) for n in range(100)]
    >>> round(times[99] - times[98], 3)
    0.02
    """

    def __init__(self) -> None:
        self._time: float | None = None
        self._period: float | None = None

    def push(self, time: float) -> float:
        """The time that a pulse was meant for which came at ``time``, in seconds."""
        if self._time is None:
            self._time = time
        elif self._period is None:
            since = time - self._time
            self._period = since if 0 < since < SLOWEST else None
            self._time = time
        else:
            late = time - self._time - self._period
            if abs(late) > LOST * self._period:
                self._time, self._period = time, None
            else:
                self._time += self._period + TRUST * late
                self._period += PACE_TRUST * late
        return self._time


class ClockCount:
    """Messages of MIDI clock as beats: pulses are counted from start, or from the position of the song.

    A clock that never says start counts from its first pulse.

    Examples
    --------
    >>> count = ClockCount()
    >>> count.push("start", 0, 1.0), count.push("clock", 0, 1.0), count.push("clock", 0, 1.02)
    (None, Clocked(time=1.0, beat=0.0), Clocked(time=1.02, beat=0.041666666666666664))
    """

    def __init__(self) -> None:
        self._pulse = 0
        self._running = True
        self._steady = SteadyPulses()

    def push(self, kind: str, position: int, time: float) -> Clocked | None:
        """What a message that came at ``time`` tells: a pulse's beat; nothing of others, or while it stands."""
        if kind == "clock":
            return self._count(time)
        if kind == "start":
            self._pulse, self._running = 0, True
        elif kind == "continue":
            self._running = True
        elif kind == "stop":
            self._running = False
        elif kind == "songpos":
            self._pulse = position * PER_BEAT // 4
        return None

    def _count(self, time: float) -> Clocked | None:
        steady = self._steady.push(time)
        if not self._running:
            return None
        self._pulse += 1
        return Clocked(steady, (self._pulse - 1) / PER_BEAT)


class ClockIn:
    """Hears another machine's clock.

    Parameters
    ----------
    port : its name; see :func:`onbeat.live.mouths.midi_ports.open_input`.
    heard : is called with each pulse, on the port's thread.
    now : the second of the session that it is.
    opened : what opens a port by its name and calls back with its messages.

    Raises
    ------
    MissingExtraError
        If mido, or what it plays on, is not installed.
    OnbeatError
        If there is no such port.
    """

    def __init__(
        self,
        port: str,
        heard: Callable[[Clocked], None],
        now: Callable[[], float],
        opened: Callable[[str, Callable[[Any], None]], Port] = open_input,
    ) -> None:
        self._heard, self._now = heard, now
        self._count = ClockCount()
        self._lock = threading.Lock()
        self._port = opened(port, self._take)

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _take(self, message: Any) -> None:
        with self._lock:
            clocked = self._count.push(message.type, getattr(message, "pos", 0), self._now())
        if clocked is not None:
            self._heard(clocked)
