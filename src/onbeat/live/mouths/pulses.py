"""Which pulse of MIDI clock is when: 24 to each beat foretold, never two at once, none left out.

Beats are counted from the first foretold; a new prediction moves the times of the pulses that are still to come. So
that a receiver stays in step whatever is foretold, pulses behind their time follow each other at twice the pace until
they have caught up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from onbeat.live.protocol import Status

PER_BEAT = 24
HASTE = 0.5
"""Share of a pulse's length that is at least between two."""
_LAST_POSITION = 2**14 - 1


@dataclass(frozen=True)
class Signal:
    """A message of MIDI's system: "songpos" with a position in sixteenths, the others without."""

    kind: Literal["clock", "start", "continue", "stop", "songpos"]
    position: int = 0


class Pulses:
    """Pulses that follow foretold beats, and start, continue and stop.

    It starts on a downbeat of music that is heard; it stops when nothing is heard, and goes on from the next bar of the
    song that it counts. Pulses come also while it stands, as long as beats are foretold. ``running`` is whether it does
    not stand.

    Examples
    --------
    >>> pulses = Pulses()
    >>> pulses.foretell(Status(0.9, "music", 120.0, 0.9, 4, 1, [1.0, 1.5], [], "", 1.0))
    []
    >>> [(pulses.next_at, [signal.kind for signal in pulses.take()]) for _ in range(2)]
    [(1.0, ['start', 'clock']), (1.0208333333333333, ['clock'])]
    """

    def __init__(self) -> None:
        self._beats: list[float] = []  # their times, from the last one passed on; the first is beat number _first
        self._first = 0
        self._period = 0.5  # [s] of a beat
        self._downbeat = 0  # number of a beat that begins a bar
        self._meter = 4
        self._pulse = 0  # number of the next
        self._last = -math.inf  # [s] when the last was
        self._heard = False
        self.running = False
        self._song: int | None = None  # pulses since the song began; none before

    def foretell(self, status: Status) -> list[Signal]:
        """Take the beats that are foretold now; what has to be said at once: a stop, or nothing."""
        beats = [beat for beat in status.next_beats if math.isfinite(beat)]
        self._heard = status.hearing == "music"
        self._beats = self._placed(beats, status) if beats else []
        if self.running and (status.hearing == "nothing" or not beats):
            self.running = False
            return [Signal("stop")]
        return []

    @property
    def next_at(self) -> float | None:
        """Second of the session at which the next pulse is; none where no beats are foretold."""
        if not self._beats:
            return None
        soonest = self._last + HASTE * self._period / PER_BEAT
        return max(self._time(self._pulse / PER_BEAT), soonest)

    def take(self) -> list[Signal]:
        """The next pulse and what comes right before it."""
        at = self.next_at
        if at is None:
            return []
        begun = self._begin() if self._heard and not self.running and self._on_downbeat else []
        self._pulse, self._last = self._pulse + 1, at
        if self.running and self._song is not None:
            self._song += 1
        return [*begun, Signal("clock")]

    @property
    def _on_downbeat(self) -> bool:
        beat, part = divmod(self._pulse, PER_BEAT)
        return part == 0 and (beat - self._downbeat) % self._meter == 0

    def _begin(self) -> list[Signal]:
        self.running = True
        bar = PER_BEAT * self._meter
        position = -(-(self._song or 0) // bar) * 4 * self._meter
        if self._song is None or position > _LAST_POSITION:
            self._song = 0
            return [Signal("start")]
        self._song = position * PER_BEAT // 4
        return [Signal("songpos", position), Signal("continue")]

    def _placed(self, beats: list[float], status: Status) -> list[float]:
        """Number the beats foretold now, as is nearest by what was foretold before; they and the one passed before."""
        passed: float | None = None
        if self._beats:
            self._first, passed = round(self._beat(beats[0])), self._time(round(self._beat(beats[0])) - 1)
        else:
            self._first = -(-self._pulse // PER_BEAT)
            self._pulse = self._first * PER_BEAT
        spans = [after - before for before, after in pairwise(beats) if after > before]
        self._period = spans[0] if spans else 60.0 / status.tempo if status.tempo > 0 else self._period
        self._meter = max(status.meter, 1)
        self._downbeat = self._first + (1 - status.next_position) % self._meter
        if passed is None or not 0.5 < (beats[0] - passed) / self._period < 2.0:
            return beats
        self._first -= 1
        return [passed, *beats]

    def _time(self, beat: float) -> float:
        """Second of a beat, at an even pace before, between and after those foretold."""
        place = min(max(beat - self._first, 0.0), len(self._beats) - 1.0)
        before = int(place)
        after = min(before + 1, len(self._beats) - 1)
        time = self._beats[before] + (place - before) * (self._beats[after] - self._beats[before])
        return time + (beat - self._first - place) * self._period

    def _beat(self, time: float) -> float:
        """The number of the beat, with its parts, at a second."""
        beats = self._beats
        if time <= beats[0] or len(beats) == 1:
            return self._first + (time - beats[0]) / self._period
        number = next((n for n in range(1, len(beats)) if time <= beats[n]), len(beats) - 1)
        span = max(beats[number] - beats[number - 1], 1e-6)
        return self._first + number + (time - beats[number]) / span
