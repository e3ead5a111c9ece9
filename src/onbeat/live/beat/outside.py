"""Beats that come from outside: another machine's clock, and a person who taps."""

from __future__ import annotations

from collections import deque
from math import floor, isfinite

import numpy as np

from onbeat.live.beat.reading import Reading
from onbeat.live.protocol import Clocked

SPAN = 2.0  # [s] of pulses that are looked at
FEWEST = 4  # pulses, however slow
ENOUGH = 0.2  # beats that they have to span
LOST = 1.0  # [s] without a pulse, or three pulses of a slow one, after which the clock has stopped
SLOWEST, FASTEST = 2.0, 0.2  # [s] between beats
TAPS = 3  # that make a tempo
METER = 4


class Clock:
    """Another machine's clock: a line through its last pulses.

    Examples
    --------
    >>> clock = Clock()
    >>> for pulse in range(25):
    ...     clock.hear(Clocked(1.0 + pulse / 48, pulse / 24))
    >>> reading = clock.reading(1.6)
    >>> round(reading.time, 6), round(reading.period, 6), reading.position
    (1.5, 0.5, 1)
    """

    def __init__(self) -> None:
        self._pulses = deque[tuple[float, float]](maxlen=256)

    def hear(self, pulse: Clocked) -> None:
        """Take a pulse; one that is no number is passed over, one that jumps begins anew."""
        if not (isfinite(pulse.time) and isfinite(pulse.beat)):
            return
        if self._pulses:
            time, beat = self._pulses[-1]
            if not (time < pulse.time < time + 3.0 * SLOWEST and beat < pulse.beat <= beat + 1.5):
                self._pulses.clear()
        self._pulses.append((pulse.time, pulse.beat))
        while len(self._pulses) > FEWEST and pulse.time - self._pulses[0][0] > SPAN:
            self._pulses.popleft()

    def reading(self, now: float) -> Reading | None:
        """Its beats, or none when it does not go."""
        if len(self._pulses) < 2:
            return None
        times, beats = np.array(self._pulses).T
        between = float(times[-1] - times[0]) / (len(times) - 1)
        span = float(beats[-1] - beats[0])
        if span < ENOUGH or abs(now - times[-1]) > max(LOST, 3.0 * between):
            return None
        around = beats - beats.mean()
        period = float(around @ times / (around @ around))
        if not FASTEST <= period <= SLOWEST:
            return None
        beat = floor(float(beats[-1]))
        return Reading(float(times.mean()) + (beat - float(beats.mean())) * period, period, beat % METER, METER)


class Taps:
    """A person who taps the beat."""

    def __init__(self) -> None:
        self._times: list[float] = []

    def hear(self, time: float) -> None:
        """Take a tap; after a pause they begin anew."""
        if self._times and not FASTEST <= time - self._times[-1] <= SLOWEST:
            self._times = []
        self._times = [*self._times[-7:], time]

    def reading(self, now: float) -> Reading | None:
        """Their beats, from the third on and for two beats after the last."""
        times = np.array(self._times)
        if len(times) < TAPS:
            return None
        around = np.arange(len(times)) - (len(times) - 1) / 2.0
        period = float(around @ times / (around @ around))
        if now - times[-1] > 2.0 * period + 0.1:
            return None
        return Reading(float(times.mean()) + period * float(around[-1]), period, 0, METER)
