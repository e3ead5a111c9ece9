"""Given choreographies, danced one after the other or by name, beat on beat.

A choreography is played at the rate at which its beats are as far apart as the music's, or half or twice as far where
that is nearer; the clock of the follower does the rest. Where the tempo has gone away from that rate, the next phrase
is played at a new one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Times, frozen
from onbeat.errors import PlanError
from onbeat.live.choice.pickers import Choice, Piece
from onbeat.live.choice.timeline import Ahead

LEAST_LEAD = 0.3
"""Seconds from where a choreography is entered to its first beat, at least: it is joined there."""
SLOWEST, FASTEST = 0.6, 1.6
"""Rates at which a choreography may be played."""
DRIFTED = 0.12
"""Share by which the rate may be off before the next phrase has another."""
PERIODS = (0.2, 3.0)
"""Seconds between beats of a dance."""
KEYPOSE_NEAR = 0.25
"""Of a beat: a keypose so near is what is put on it."""


@dataclass(frozen=True, eq=False)
class Choreography:
    """A whole dance that is known.

    Parameters
    ----------
    name : as people ask for it.
    clip : its place among the clips of the timeline.
    duration : seconds.
    beats : (B,) seconds, two or more.
    meter : beats of a bar; the first beat begins one.
    keyposes : (K,) seconds.

    Raises
    ------
    PlanError
        If there are less than two beats inside, they do not rise, or are no beats of a dance.
    """

    name: str
    clip: int
    duration: float
    beats: Times
    meter: int = 4
    keyposes: Times | tuple[()] = ()

    def __post_init__(self) -> None:
        beats = np.asarray(self.beats, dtype=np.float64)
        beats = beats[(beats >= 0) & (beats <= self.duration)]
        if len(beats) < 2 or (np.diff(beats) <= 0).any():
            raise PlanError(
                f"{self.name} has {len(beats)} beats that rise; two or more are needed to dance it on music"
            )
        object.__setattr__(self, "beats", frozen(beats))
        if not PERIODS[0] <= self.period <= PERIODS[1]:
            raise PlanError(
                f"the beats of {self.name} are {self.period:.3g} s apart; {PERIODS[0]:g} to {PERIODS[1]:g} s are danced"
            )

    @property
    def period(self) -> float:
        """Seconds between beats."""
        return float(np.median(np.diff(self.beats)))

    def marks(self) -> Times:
        """(B,) seconds that are put on the beats: the keypose near each, or the beat itself."""
        keyposes = np.asarray(self.keyposes, dtype=np.float64)
        if not len(keyposes):
            return self.beats
        nearest = keyposes[np.abs(keyposes[None] - self.beats[:, None]).argmin(axis=1)]
        near = np.abs(nearest - self.beats) <= KEYPOSE_NEAR * self.period
        marks = np.where(near, nearest, self.beats)
        return np.where(np.append(True, np.diff(marks) > 0.3 * self.period), marks, self.beats)

    def folded(self, period: float, fastest: float = FASTEST) -> tuple[float, int, int]:
        """The rate at which it is on beats of so many seconds: rate, music's beats to a step of own beats, that step.

        Of the rates up to ``fastest`` the one nearest to 1.

        Examples
        --------
        >>> steps = Choreography("steps", 0, 9.0, np.arange(0, 9, 0.5))
        >>> steps.folded(0.5), steps.folded(1.1), steps.folded(0.26)
        ((1.0, 1, 1), (0.9090909090909091, 1, 2), (0.9615384615384615, 2, 1))
        """
        ways = [(self.period / period, 1, 1), (2 * self.period / period, 1, 2), (self.period / (2 * period), 2, 1)]
        return min(ways, key=lambda way: (way[0] > fastest, abs(np.log(way[0]))))


class Repertoire:
    """Dances choreographies in their order, again and again, or those that are asked for.

    Parameters
    ----------
    dances : one or more.
    phrase : own beats of a piece.
    fastest : rate at which they may be played.
    """

    def __init__(self, dances: Sequence[Choreography], phrase: int = 8, fastest: float = FASTEST) -> None:
        if not dances:
            raise PlanError("no choreography to dance")
        self._dances, self._phrase, self._fastest = tuple(dances), phrase, fastest
        self._marks = [dance.marks() for dance in dances]
        self._now, self._asked = -1, False
        self._own, self._beat, self._rate, self._fold = 0.0, 0, 1.0, (1, 1)
        self._number = 0  # of the music's beat that the own beat ``_beat`` is on

    @property
    def names(self) -> tuple[str, ...]:
        """Of all choreographies."""
        return tuple(dance.name for dance in self._dances)

    def ask(self, name: str) -> bool:
        """Dance one from the next beginning on; the next of them for an empty name."""
        if name and name not in self.names:
            return False
        self._now = self.names.index(name) if name else (self._now + 1) % len(self._dances)
        self._asked = True
        return True

    def begin(self, at: float, ahead: Ahead) -> Choice:
        """Enter a choreography so that its bars begin on the music's."""
        if not self._asked:
            self._now = (self._now + 1) % len(self._dances)
        self._asked = False
        return self._enter(at, ahead)

    def go_on(self, at: float, ahead: Ahead, seconds: float) -> Choice:
        """The next phrase, or the next choreography where this one is over."""
        dance = self._dances[self._now]
        last = len(dance.beats) - 1
        if self._beat >= last:
            return self.begin(at, ahead)
        self._adapt(ahead)
        until = min(self._beat + self._phrase, last)
        return self._piece(self._own, until, at)

    def _enter(self, at: float, ahead: Ahead) -> Choice:
        dance = self._dances[self._now]
        marks = self._marks[self._now]
        self._rate, *fold = dance.folded(ahead.period, self._fastest)
        self._rate = float(np.clip(self._rate, SLOWEST, self._fastest))
        self._fold = (fold[0], fold[1])
        coming = ahead.after(at + LEAST_LEAD)
        down = np.flatnonzero(coming.positions == 1)
        which = int(down[0]) if len(down) else 0
        lead = self._rate * float(coming.times[which] - at)
        bars = np.arange(0, len(marks), dance.meter)
        inside = bars[marks[bars] >= lead]
        if not len(inside):  # shorter than the way to the downbeat
            which, lead = 0, self._rate * float(coming.times[0] - at)
            inside = np.flatnonzero(marks >= lead)
        beat = int(inside[0]) if len(inside) else 0
        self._beat, self._number = beat, coming.first + which
        start = max(float(marks[beat]) - lead, 0.0)
        return self._piece(start, min(beat + self._phrase, len(marks) - 1), at, enter=True)

    def _adapt(self, ahead: Ahead) -> None:
        """Another rate, where the music's tempo has gone away from the present one."""
        dance = self._dances[self._now]
        music, own = self._fold
        rate = float(np.clip(dance.period * own / (ahead.period * music), SLOWEST, self._fastest))
        if abs(np.log(rate / self._rate)) > DRIFTED:
            self._rate = rate

    def _piece(self, start: float, until: int, at: float, enter: bool = False) -> Choice:
        """From an own second up to an own beat, and half-way to the next where the dance is over there."""
        dance, marks = self._dances[self._now], self._marks[self._now]
        over = until == len(marks) - 1
        to = min(float(marks[until]) + 0.5 * dance.period * over, dance.duration)
        music, own = self._fold
        begin = self._beat if enter else self._beat + 1
        beats = list[tuple[int, float]]()
        for beat in range(begin, until + 1):
            steps = beat - self._beat
            if steps % own == 0:
                beats.append((self._number + steps // own * music, (float(marks[beat]) - start) / self._rate))
        self._number += (until - self._beat) // own * music
        self._beat += (until - self._beat) // own * own
        self._own = to
        self._beat = max(self._beat, until) if over else self._beat
        return Choice((Piece(dance.clip, start, to, self._rate),), tuple(beats), dance.name)
