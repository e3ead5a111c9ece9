"""When a live tracker says a beat: it follows one reading of the music and leaves it only for a much likelier one."""

from __future__ import annotations

from math import log

from onbeat.music.streaming.forward import ForwardFilter, Guess

FIRST = 0.03  # share of the chains that the first reading needs
SWITCH = 3.0  # log of another reading's share over that of the one followed, summed over looks, to change over
LOOK = 4  # frames between two looks for another reading
SURE = 0.5  # share from which on a reading is trusted
HEARD = 0.2  # share of the chains with a beat just now, at which an unsure tracker says it
LEAST_GAP = 0.6  # of a period, between two beats
LEAD = 2.0  # frames from the last one heard to a beat that is said


class Announcer:
    """Follows the filter and says each beat once.

    Attributes
    ----------
    period : frames between beats; 0 while there is no reading.
    next_at : frame of the next beat.
    share : of all chains, those that agree.
    """

    def __init__(self, lead: float = LEAD, switch: float = SWITCH, first: float = FIRST) -> None:
        self._lead, self._switch, self._first = lead, switch, first
        self.period = 0.0
        self.next_at = 0.0
        self.share = 0.0
        self._said = float("-inf")
        self._doubt = 0.0

    def follow(self, filter: ForwardFilter) -> float | None:
        """Take the filter's newest frame; the frame (a fraction) of the beat that is said now, if any."""
        now = filter.frames - 1
        if self.period:
            self._take(filter.near(self.period, self.next_at - now), now)
        if now % LOOK == 0:
            best = filter.best()
            self._doubt = max(self._doubt + log(max(best.share, 1e-9) / max(self.share, 1e-9)), 0.0)
            if self._doubt > self._switch if self.period else best.share > self._first:
                self._doubt = 0.0
                self._take(filter.near(best.period, best.ahead), now)
        if not self.period:
            return None
        due = self._due(now)
        return self._sudden(filter, now) if due is None else due

    def _take(self, guess: Guess, now: int) -> None:
        self.period, self.next_at, self.share = guess.period, now + guess.ahead, guess.share
        while self.next_at - self._said < LEAST_GAP * self.period:
            self.next_at += self.period

    def _due(self, now: int) -> float | None:
        if self.next_at - now > self._lead:
            return None
        self._said = self.next_at
        self.next_at += self.period
        return self._said

    def _sudden(self, filter: ForwardFilter, now: int) -> float | None:
        """A beat that is heard while the reading is unsure, and that it did not foretell."""
        if self.share > SURE or now - 1 - self._said < LEAST_GAP * self.period or filter.begun(3) < HEARD:
            return None
        self._said = float(now - 1)
        while self.next_at - self._said < LEAST_GAP * self.period:
            self.next_at += self.period
        return self._said
