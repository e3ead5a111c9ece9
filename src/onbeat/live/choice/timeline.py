"""What the conductor knows of a dance's own timeline, whoever dances it, and how the music's beats lie on it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from onbeat._shapes import Ints, Times

KEPT = 64
"""Beats that are remembered."""


class Timeline(Protocol):
    """A dance that grows at its end: stretches of clips are added, and cut off again where they are not danced yet."""

    @property
    def end(self) -> float:
        """Second up to which it is known."""
        ...

    @property
    def settled(self) -> float:
        """Second before which nothing changes any more."""
        ...

    @property
    def margin(self) -> float:
        """Seconds after what is settled from which on a cut may lie."""
        ...

    def settle(self, before: float) -> None:
        """What comes before a second will not change any more."""
        ...

    def add(self, clip: int, from_s: float, to_s: float, rate: float = 1.0) -> None:
        """A stretch of a clip at the end."""
        ...

    def cut(self, at: float) -> None:
        """Forget all after a second."""
        ...

    def forget(self, before: float) -> None:
        """What comes before a second is not asked for again."""
        ...


@dataclass(frozen=True, eq=False)
class Ahead:
    """The beats to come, in seconds of the dance's own timeline.

    Parameters
    ----------
    first : number of the first of them.
    times : (K,) seconds, rising.
    positions : (K,) in the bar, from 1.
    meter : beats in a bar.
    intensity : of the music, as a z-score.
    """

    first: int
    times: Times
    positions: Ints
    meter: int
    intensity: float

    @property
    def period(self) -> float:
        """Seconds between beats."""
        return float(np.median(np.diff(self.times)))

    def after(self, second: float) -> Ahead:
        """Those that are not before a second."""
        skip = int(np.searchsorted(self.times, second - 1e-9))
        return Ahead(self.first + skip, self.times[skip:], self.positions[skip:], self.meter, self.intensity)


@dataclass
class Anchors:
    """Which second of the dance is to be on which beat.

    Examples
    --------
    >>> anchors = Anchors()
    >>> anchors.put(4, 2.0), anchors.put(5, 2.5), anchors.put(6, 2.4)
    (True, True, False)
    >>> anchors.pairs(5, np.array([10.0, 10.6]))
    (array([10.]), array([2.5]))
    """

    seconds: dict[int, float] = field(default_factory=dict[int, float])

    def put(self, beat: int, second: float) -> bool:
        """Put a beat on a second; false where it would not come after the beat before it."""
        if self.seconds:
            last = max(self.seconds)
            if beat <= last or second <= self.seconds[last] + 1e-3:
                return False
        self.seconds[beat] = second
        while len(self.seconds) > KEPT:
            del self.seconds[min(self.seconds)]
        return True

    def cut(self, at: float) -> None:
        """Forget those after a second of the dance."""
        self.seconds = {beat: second for beat, second in self.seconds.items() if second <= at + 1e-9}

    def clear(self) -> None:
        """Forget all."""
        self.seconds = {}

    def next_after(self, second: float) -> list[tuple[int, float]]:
        """Beats and seconds after a second, in order."""
        return sorted((beat, at) for beat, at in self.seconds.items() if at > second)

    def pairs(self, first: int, times: Times) -> tuple[Times, Times]:
        """The music's seconds and the dance's, of the beats ``first``, ``first + 1``, … at the music's times (K,)."""
        both = [
            (float(times[beat - first]), second)
            for beat, second in sorted(self.seconds.items())
            if 0 <= beat - first < len(times)
        ]
        music, dance = np.array([pair[0] for pair in both]), np.array([pair[1] for pair in both])
        return music, dance
