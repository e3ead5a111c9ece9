"""Which of the music's beats are danced: each, every second or third, or some between them; at a tempo to dance to."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from onbeat.live.beat.reading import Reading

SAME = 0.09  # log ratio within which two tempi are one
SLACK = 0.08  # log ratio by which the danced tempo may leave its range before another level is taken
PATIENCE = 6.0  # danced beats for which the downbeats have to lie between them, until the dance goes over to them
FACTORS = (
    1.0,
    2.0,
    0.5,
    3.0,
    1.0 / 3.0,
    4.0,
    0.25,
)  # danced beats last so many of the music's; the first are preferred


@dataclass(frozen=True)
class Danced:
    """Beats to dance on: those at ``time`` plus whole periods (s); the one at ``time`` at ``position`` (from 0)."""

    time: float
    period: float
    position: int
    meter: int


class Fold:
    """Folds the music's beats to a tempo to dance to, and stays with what it chose.

    Parameters
    ----------
    low, high : beats per minute to dance in.

    Examples
    --------
    >>> fold = Fold(70.0, 140.0)
    >>> fold.danced(Reading(2.0, 0.3, 2, 4), 1.9, 0.0)
    Danced(time=2.0, period=0.6, position=1, meter=2)
    >>> fold.danced(Reading(2.0, 0.6, 2, 4), 1.9, 0.6).period
    0.6
    """

    def __init__(self, low: float, high: float) -> None:
        self._low, self._high = log(low), log(high)
        self._factor = 1.0
        self._kept = False  # the danced beats were the music's own before it was heard twice as fast: they stay
        self._since: float | None = None

    def danced(self, reading: Reading, near: float, period: float) -> Danced:
        """The danced beat nearest to second ``near``; ``period`` is the danced one so far, 0 before there is any."""
        before, self._factor = self._factor, self._chosen(reading, period)
        if self._factor != before or period <= 0.0:
            self._kept = self._factor > before and period > 0.0
        factor = self._factor
        step = factor * reading.period
        time = reading.time if factor <= 1.0 else self._among(reading, near, period > 0.0)
        time += round((near - time) / step) * step
        return Danced(time, step, *self._place(reading, time))

    def _chosen(self, reading: Reading, period: float) -> float:
        """How many of the music's beats a danced one lasts."""
        factors = [f for f in FACTORS if f not in (3.0, 1.0 / 3.0) or reading.meter % 3 == 0 or f == self._factor]
        if period > 0.0:
            same = min(factors, key=lambda factor: abs(log(factor * reading.period / period)))
            if abs(log(same * reading.period / period)) < SAME and self._outside(same * reading.period) <= SLACK:
                return same
            if self._outside(self._factor * reading.period) <= SLACK:
                return self._factor
        return min(factors, key=lambda factor: self._outside(factor * reading.period))

    def _outside(self, period: float) -> float:
        """Log ratio by which a tempo is too slow or too fast, 0 inside."""
        tempo = log(60.0 / period)
        return max(self._low - tempo, tempo - self._high, 0.0)

    def _among(self, reading: Reading, near: float, going: bool) -> float:
        """The beat of the music nearest to ``near`` that is danced, where only some of them are."""
        count = round(self._factor)
        number = round((near - reading.time) / reading.period)
        off = (reading.position + number) % count if reading.meter % count == 0 else 0
        off = off - count if off > count / 2 else off
        if going and off and (self._kept or not self._overdue(near, PATIENCE * count * reading.period)):
            off = 0
        elif not off:
            self._since = None
        return reading.time + (number - off) * reading.period

    def _overdue(self, now: float, patience: float) -> bool:
        if self._since is None or now < self._since:
            self._since = now
        return now - self._since > patience

    def _place(self, reading: Reading, time: float) -> tuple[int, int]:
        """Position and meter of a danced beat."""
        factor, meter = self._factor, reading.meter
        beats = reading.beats_at(time)
        if factor <= 1.0:
            meter = round(meter / factor)
        elif meter % round(factor) == 0:
            meter = meter // round(factor)
        else:  # across the bars: as many danced beats as there are beats in one make some bars
            while round(beats) % round(factor):
                beats += reading.meter
        return round(beats / factor) % meter, meter
