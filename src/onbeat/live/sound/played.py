"""A song that is played to the ears at its own pace.

Whoever reads gets just the samples whose time has come, in order, none left out. Who reads late catches up by half a
second at a time; after more than two seconds the song has waited, as a player that is paused.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable

from onbeat._shapes import Float32
from onbeat.errors import AudioError
from onbeat.live.sound.listener import Block, Handover, State

TOLD = 0.5
"""Seconds that the song has waited from which on that is said."""
AT_ONCE = 0.5
"""Seconds of song that one reading gives at the most."""
PATIENCE = 2.0
"""Seconds that the song may be behind the clock; by more it waits."""
Clock = Callable[[], float]
"""Seconds that rise."""


class Pace:
    """How far a song should be.

    Parameters
    ----------
    speed_up : seconds of song per second of the clock.
    clock : seconds that rise.

    Examples
    --------
    >>> seconds = iter([100.0, 100.25, 110.0, 110.25])
    >>> pace = Pace(1.0, lambda: next(seconds))
    >>> pace.begin()
    >>> pace.until(0.0), pace.until(0.25), pace.waited, pace.until(0.75)
    (0.25, 0.75, 7.75, 1.25)
    """

    def __init__(self, speed_up: float, clock: Clock) -> None:
        if not 0.0 < speed_up < math.inf:
            raise AudioError(f"a song sped up {speed_up:g} times; expected a number above 0, 1 for its own pace")
        self._speed_up, self._clock = speed_up, clock
        self._begun = 0.0
        self.waited = 0.0
        """Seconds of the clock for which the song has waited."""

    def begin(self) -> None:
        """Now is second 0 of the song."""
        self._begun = self._clock()

    def until(self, given: float) -> float:
        """Seconds of song up to which it may be given, of which ``given`` have been."""
        elapsed = self._clock() - self._begun
        late = elapsed - given / self._speed_up
        if late > PATIENCE:
            self._begun += late - PATIENCE
            self.waited += late - PATIENCE
            elapsed -= late - PATIENCE
        return min(elapsed * self._speed_up, given + AT_ONCE)


class Played(ABC):
    """A song that is played, wherever its samples are from.

    Parameters
    ----------
    speed_up : seconds of song per second of the clock.
    loop : whether it begins again at its end.
    clock : seconds that rise.
    """

    state: State = "waiting"
    """Whether it has begun, or is over."""
    latency = 0.0
    """A song's samples are given when they sound."""

    def __init__(self, speed_up: float, loop: bool, clock: Clock) -> None:
        self._loop = loop
        self._pace = Pace(speed_up, clock)
        self._way = Handover()
        self._rate, self._given, self._slow = 0, 0, False
        self.seconds = 0.0
        """Length of the song."""

    @property
    def position(self) -> float:
        """Seconds of the song given so far; in a loop, of this round."""
        given = self._given / self._rate if self._rate else 0.0
        return given % self.seconds if self._loop and self.seconds > 0.0 else given

    def read(self) -> list[Block]:
        """The samples (n, channels) whose time has come since the last call, half a second at the most."""
        if self.state != "sound":
            return []
        if self._over():  # told only now, when all that was given before has been heard
            self.state = "ended"
            return []
        until = self._pace.until(self._given / self._rate)
        block = self._next(max(math.floor(until * self._rate + 1e-6) - self._given, 0))
        self._given += len(block)
        if self._pace.waited >= TOLD and not self._slow:
            self._slow = True
            self._way.say(f"this machine was too busy for a moment: the song has waited {self._pace.waited:.1f} s")
        return [(block, self._rate)] if len(block) else []

    def notes(self) -> list[str]:
        """What people should know, since the last call."""
        return self._way.notes()

    def close(self) -> None:
        """End."""
        self.state = "ended"

    def _begin(self) -> None:
        self._given = 0
        self._pace.begin()
        self.state = "sound"

    @abstractmethod
    def _next(self, count: int) -> Float32: ...

    @abstractmethod
    def _over(self) -> bool: ...
