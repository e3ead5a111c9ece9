"""The beats to dance on, as the music comes in: predicted, counted, at a tempo to dance to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Float32, Ints, Times
from onbeat.errors import AudioError
from onbeat.live.beat.bar import Bar
from onbeat.live.beat.fold import Fold
from onbeat.live.beat.grid import Grid
from onbeat.live.beat.loudness import Loudness
from onbeat.live.beat.outside import Clock, Taps
from onbeat.live.beat.reading import Reading
from onbeat.live.beat.trust import Trust
from onbeat.live.protocol import RATE, BeatSaid, Clocked, Hearing
from onbeat.music.causal import CausalTracker
from onbeat.music.tempo import DANCE_FASTEST, DANCE_SLOWEST, FASTEST, SLOWEST

EAR_RATE = 44100
TICK = 1.0 / RATE
START = 100.0  # [BPM] until a tempo is heard
AGREED = 0.4  # share of the tracker's readings, below which it is not followed
NEAR = 2.0  # [s] from now, beyond which a pulse or tap is none
NUDGE = 0.5  # share of the way to a tap that one alone moves the beats


@dataclass(frozen=True, eq=False)
class Heard:
    """What is known at the end of a tick.

    Parameters
    ----------
    time : seconds.
    said : beats of the music that are said now, each once.
    hearing : whether there is music, its tempo is held through a break, or there is none.
    tempo : of the dance, in beats per minute.
    confidence : 0…1, how likely the next beat is right.
    meter : danced beats in a bar.
    level : loudest sample of the tick.
    intensity : of the music, in deviations from the usual of the last minutes, about −2…2.
    first : number of the danced beat at ``times[0]``; numbers count up without a gap for the whole session.
    times : (13,) seconds of the danced beats: the last that is over, and those to come.
    positions : (13,) of those beats in the bar, from 1.
    """

    time: float
    said: tuple[BeatSaid, ...]
    hearing: Hearing
    tempo: float
    confidence: float
    meter: int
    level: float
    intensity: float
    first: int
    times: Times
    positions: Ints


class Pulse:
    """Hears the beats to dance on, tick by tick.

    Parameters
    ----------
    low, high : beats per minute to dance in; slower and faster music is danced at double or half its tempo.

    Raises
    ------
    AudioError
        If they are no such range.

    Examples
    --------
    >>> pulse = Pulse()
    >>> heard = pulse.hear(np.zeros(441, np.float32))
    >>> heard.hearing, heard.first, len(heard.times)
    ('nothing', 0, 13)
    """

    def __init__(self, low: float = DANCE_SLOWEST, high: float = DANCE_FASTEST) -> None:
        if not SLOWEST <= low < high <= FASTEST:
            raise AudioError(
                f"{low:g} to {high:g} beats per minute to dance in; expected two rising numbers "
                f"from {SLOWEST:g} to {FASTEST:g}"
            )
        self._tracker = CausalTracker(EAR_RATE)
        self._trust, self._loudness = Trust(), Loudness()
        self._clock, self._taps = Clock(), Taps()
        self._fold, self._bar = Fold(low, high), Bar()
        self._grid = Grid(60.0 / min(max(START, low), high))
        self._ticks = 0
        self._source = ""  # who keeps time
        self._danced = False  # there is a tempo that goes on
        self._quiet: Float32 = np.zeros(EAR_RATE // RATE, np.float32)

    @property
    def time(self) -> float:
        """Seconds heard so far."""
        return self._ticks / RATE

    def hear(self, samples: Float32 | None) -> Heard:
        """Take the next tick: 441 samples of ±1, mono, 44.1 kHz; None where the source gave nothing.

        Raises
        ------
        AudioError
            If there are more or fewer samples; nothing is taken then.
        """
        tick = self._quiet if samples is None else np.asarray(samples, np.float32)
        if tick.shape != self._quiet.shape:
            raise AudioError(f"a tick of shape {tick.shape}; expected {self._quiet.shape}: 10 ms, mono, at 44100 Hz")
        self._ticks += 1
        beats = self._tracker.push(self._loudness.hear(tick, TICK, self._trust.hearing == "music"))
        self._trust.hear(self._tracker.agreement, self._tracker.evidence, self._tracker.is_music, TICK)
        number, before = self._grid.number, self._source
        self._grid.go_to(self.time)
        self._source, reading = self._reading()
        self._danced = self._danced and self._trust.hearing != "nothing"
        if reading:
            self._follow(reading, self._source != before)
        if self._outside:
            self._trust.believe()
            return self._told(self._counted() if self._grid.number > number else ())
        said = [BeatSaid(beat.time, beat.position, beat.confidence, beat.emitted_at) for beat in beats]
        return self._told(tuple(said) if self._trust.hearing == "music" else ())

    @property
    def _outside(self) -> bool:
        return self._source in ("clock", "taps")

    def _counted(self) -> tuple[BeatSaid, ...]:
        """The danced beat that is over now, where somebody else keeps time."""
        position = int(self._bar.positions(self._grid.number, 1)[0])
        return (BeatSaid(self._grid.last, position, 1.0, self.time),)

    def clocked(self, event: Clocked) -> None:
        """A pulse of another machine's clock: while they come, they are the beats."""
        if abs(event.time - self.time) < NEAR:
            self._clock.hear(event)

    def tap(self, time: float) -> None:
        """A person's tap: it draws the beats nearer; from the third in a row on they are the beats."""
        if not abs(time - self.time) < NEAR:
            return
        self._taps.hear(time)
        if self._taps.reading(self.time) is None:
            self._grid.shift(NUDGE, time, self.time)

    def _reading(self) -> tuple[str, Reading | None]:
        """Who keeps time now, and what they say; nobody while the tempo is held, or nothing is heard."""
        clock = self._clock.reading(self.time)
        if clock:
            return "clock", clock
        taps = self._taps.reading(self.time)
        if taps:
            return "taps", taps
        return ("music", self._tracked()) if self._trust.hearing == "music" else ("", None)

    def _tracked(self) -> Reading | None:
        following = self._tracker.next_beats(1)
        if not len(following) or self._tracker.agreement < AGREED:
            return None
        time, period, meter = float(following[0]), 60.0 / self._tracker.tempo, self._tracker.meter
        return Reading(time, period, round(self._tracker.position + (time - self.time) / period) % meter, meter)

    def _follow(self, reading: Reading, anew: bool) -> None:
        grid = self._grid
        danced = self._fold.danced(reading, grid.next, grid.period if self._danced else 0.0)
        self._danced = True
        if anew:
            grid.leap(danced, self.time)
        else:
            grid.follow(danced, self.time, TICK)
        self._bar.hear(danced, grid.number + 1, anew)

    def _told(self, said: tuple[BeatSaid, ...]) -> Heard:
        grid, times = self._grid, self._grid.foretold()
        return Heard(
            time=self.time,
            said=said,
            hearing=self._trust.hearing,
            tempo=60.0 / grid.period,
            confidence=1.0 if self._outside else self._tracker.confidence,
            meter=self._bar.meter,
            level=self._loudness.level,
            intensity=self._loudness.intensity,
            first=grid.number,
            times=times,
            positions=self._bar.positions(grid.number, len(times)),
        )
