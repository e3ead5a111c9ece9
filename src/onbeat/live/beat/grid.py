"""The danced beats, counted: a phase-locked loop that goes on by itself and moves gently to where they are heard."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Times, frozen
from onbeat.live.beat.fold import Danced

AHEAD = 12  # beats foretold
PHASE, PERIOD = 0.8, 1.2  # [s] time constants of corrections
MEAN = 0.7  # [s] time constant of the mean distance
FAR = 0.03  # [s] of mean distance, at which they go twice as fast
QUICKEST = 4.0  # times as fast at the most
LARGE = 0.14  # of a period: what is heard lies so far away, or is so much faster, that it is another reading
PATIENCE = 0.15  # [s] for which that has to last until it is believed
SHORTEST = 0.5  # of a period, between a beat that is over and the next


class Grid:
    """Counts beats and foretells them.

    Parameters
    ----------
    period : seconds between beats, before any is heard.

    Attributes
    ----------
    number, last : of the last beat that is over, and when it was.
    next : when the one after it is.
    period : seconds between those that follow.

    Examples
    --------
    >>> grid = Grid(0.5)
    >>> grid.go_to(0.7)
    >>> grid.number, grid.foretold(3).tolist()
    (1, [0.5, 1.0, 1.5])
    """

    def __init__(self, period: float) -> None:
        self.number, self.last, self.next, self.period = 0, 0.0, period, period
        self._other, self._mean = 0.0, 0.0  # [s] that another reading lasts; of the distance

    def go_to(self, now: float) -> None:
        """Let time go on."""
        while self.next <= now:
            self.number, self.last = self.number + 1, self.next
            self.next += self.period

    def follow(self, heard: Danced, now: float, passed: float) -> None:
        """Move towards the beats that are heard, ``passed`` seconds after the last move."""
        apart = heard.time - self.next
        apart -= round(apart / heard.period) * heard.period
        faster = heard.period / self.period - 1.0
        if max(abs(apart) / heard.period, abs(faster)) > LARGE:
            self._other += passed
            if self._other > PATIENCE:
                self.leap(heard, now)
            return
        self._other = 0.0
        self._mean += (apart - self._mean) * passed / MEAN
        quick = min(1.0 + (self._mean / FAR) ** 2, QUICKEST) * passed
        self.next = max(self.next + apart * quick / PHASE, now + 1e-6)
        self.period += faster * self.period * quick / PERIOD

    def leap(self, heard: Danced, now: float) -> None:
        """Go over to the beats that are heard at once; each keeps the number of the nearest."""
        self._other, self._mean = 0.0, 0.0
        time = heard.time + round((self.next - heard.time) / heard.period) * heard.period
        while time < self.last + SHORTEST * min(self.period, heard.period) or time <= now:
            time += heard.period
        self.next, self.period = time, heard.period

    def foretold(self, count: int = AHEAD + 1) -> Times:
        """The last beat that is over and those to come, in seconds."""
        times = np.empty(count)
        times[0] = self.last
        times[1:] = self.next + self.period * np.arange(count - 1)
        return frozen(times)

    def shift(self, share: float, time: float, now: float) -> None:
        """Move by a share of the way by which the nearest beat lies beside ``time``."""
        apart = (time - self.next) - round((time - self.next) / self.period) * self.period
        self.next = max(self.next + share * apart, now + 1e-6, self.last + SHORTEST * self.period)
