"""A recording as a source of ticks, at the pace of a clock or as fast as they are taken."""

from __future__ import annotations

import time
from collections.abc import Callable

from onbeat._shapes import Float32
from onbeat.live.protocol import RATE
from onbeat.live.record import Replay
from onbeat.live.session import NOTHING_TOLD, Told


class Recorded:
    """Ticks of a recording, each when its time has come.

    Parameters
    ----------
    replay : the recording.
    clock : seconds that rise.
    """

    def __init__(self, replay: Replay, clock: Callable[[], float] = time.perf_counter) -> None:
        self._ticks, self._count = replay.ticks(), len(replay)
        self._clock = clock
        self._began = 0.0
        self._given = 0
        self._told = NOTHING_TOLD
        self._silent = False

    def start(self) -> None:
        """Begin."""
        self._began = self._clock()

    def tick(self) -> Float32 | None:
        """The next tick if it is due; also None where the recording has no sound: then ``given`` says so."""
        self._silent = False
        if self.over or self._clock() - self._began < self._given / RATE:
            return None
        samples, self._told = next(self._ticks)
        self._given += 1
        self._silent = samples is None
        return samples

    def told(self) -> Told:
        """What was told in the tick."""
        told, self._told = self._told, NOTHING_TOLD
        return told

    def notes(self) -> list[str]:
        """Nothing."""
        return []

    @property
    def given(self) -> bool:
        """Whether the tick just given has no sound."""
        return self._silent

    @property
    def lost(self) -> bool:
        """Nothing is waited for but the time of the next tick."""
        return False

    @property
    def over(self) -> bool:
        """Whether all ticks were given."""
        return self._given >= self._count
