"""The conductor: keeps the dance's timeline ahead of what is danced, and says which second of it is on which beat.

It dances while music is heard, through breaks too, and rests otherwise; what to dance a picker chooses. Pickers plan on
beats that are foretold; when these move, the seconds stay anchored to the numbers of the beats, so that a stop that was
chosen for a beat stays on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Times
from onbeat.live.beat.pulse import Heard
from onbeat.live.choice.pickers import Choice, Picker, Piece
from onbeat.live.choice.timeline import Ahead, Anchors, Timeline

KNOWN = 2.6
"""Seconds ahead of what is danced, up to which the timeline is to be known at least."""
GO_ON = 2.0
"""Seconds that are chosen at once."""
PATIENCE = 1.2
"""Seconds that a cut may wait for a beat, to lie on it; a change of choreography waits for a bar."""
FAR = 12.0
"""Seconds ahead of what is danced, up to which beats are told to pickers: at the tempo of the last foretold."""
RESTING = "resting"


@dataclass(frozen=True)
class Rest:
    """The clip of standing at ease, which begins where it ends, and the second in which all begins."""

    clip: int
    duration: float


class Conductor:
    """Puts stretches of clips on a timeline as the music is heard.

    Parameters
    ----------
    line : the dance's timeline, empty.
    picker : who chooses.
    rest : what is shown when there is nothing to dance to.
    """

    def __init__(self, line: Timeline, picker: Picker, rest: Rest) -> None:
        self.line, self.picker, self.rest = line, picker, rest
        self.anchors = Anchors()
        self.dancing = RESTING
        self.changed = False
        self._dances = False
        self._wanted = True
        self._asked = False
        self._rested = 0.0
        self._relax(KNOWN + GO_ON)

    @property
    def resting(self) -> bool:
        """Whether it is not dancing."""
        return not self._dances

    def command(self, do: str, value: str = "") -> str | None:
        """Do as somebody wishes; what is wrong with the wish, if anything."""
        if do in ("rest", "dance"):
            self._wanted = do == "dance"
            return None
        if not self.picker.ask(value if do == "play" else ""):
            return f"nothing is called {value!r}; there is {', '.join(self.picker.names[:12])}"
        self._asked, self._wanted = True, True
        return None

    def conduct(self, heard: Heard, music: float, own: float) -> None:
        """See that the timeline is known far enough, of the right things.

        Parameters
        ----------
        heard : the music.
        music, own : second of the music, and of the timeline, up to which all is danced.
        """
        self.changed = False
        self.line.settle(own)
        self.line.forget(own - 4.0)
        dance = self._wanted and (heard.hearing == "music" or (heard.hearing == "held" and not self.resting))
        if not dance:
            if not self.resting:
                self._stop(own)
        elif self.resting:
            self._start(heard, music, own)
        elif self._asked:
            self._change(heard, music, own)
        self._extend(heard, music, own)

    def expected(self, heard: Heard, music: float, own: float) -> tuple[Times, Times]:
        """The music's seconds and the timeline's that go together from now on, two or more of each, both rising."""
        times, seconds = self.anchors.pairs(heard.first, heard.times)
        if not len(times):
            return np.array([music, music + 1.0]), np.array([own, own + 1.0])
        if len(times) == 1:
            return np.append(times, times + 1.0), np.append(seconds, seconds + 1.0)
        return times, seconds

    def ahead(self, heard: Heard, music: float, own: float) -> Ahead:
        """The foretold beats on the timeline: those that are anchored where they are, others as far on as in music."""
        times = _on_the_line(self.anchors, heard, music, own)
        period = float(np.median(np.diff(heard.times)))
        more = np.arange(1, max(int((own + FAR - times[-1]) / period) + 1, 1))
        positions = (heard.positions[-1] - 1 + more) % heard.meter + 1
        return Ahead(
            heard.first,
            np.concatenate((times, times[-1] + more * period)),
            np.concatenate((heard.positions, positions)),
            heard.meter,
            heard.intensity,
        )

    def _extend(self, heard: Heard, music: float, own: float) -> None:
        while self.line.end < own + KNOWN:
            if self.resting:
                self._relax(GO_ON)
            else:
                at = self.line.end
                self._take(self.picker.go_on(at, self.ahead(heard, music, own), GO_ON), at)

    def _start(self, heard: Heard, music: float, own: float) -> None:
        self._cut(own + self.line.margin)
        self.anchors.clear()
        self._begin(heard, music, own)

    def _change(self, heard: Heard, music: float, own: float) -> None:
        """Change over on the next downbeat, or the next beat where none comes soon."""
        coming = self.anchors.next_after(own + self.line.margin)
        soon = [(beat, at) for beat, at in coming if at < own + self.line.margin + 2 * PATIENCE]
        down = [at for beat, at in soon if self._position(heard, beat) == 1]
        self._cut(down[0] if down else soon[0][1] if soon else own + self.line.margin)
        self._begin(heard, music, own)

    def _stop(self, own: float) -> None:
        """Come to rest after the next beat that is danced."""
        coming = [at for _, at in self.anchors.next_after(own + self.line.margin)]
        self._cut(coming[0] if coming and coming[0] < own + PATIENCE else own + self.line.margin)
        self.anchors.clear()
        self.dancing, self._dances, self._rested = RESTING, False, 0.0
        self._relax(GO_ON)

    def _begin(self, heard: Heard, music: float, own: float) -> None:
        self._asked = False
        at = self.line.end
        self._take(self.picker.begin(at, self.ahead(heard, music, own)), at)

    def _cut(self, at: float) -> None:
        self.line.cut(min(at, self.line.end))
        self.anchors.cut(self.line.end)
        self.changed = True

    def _take(self, choice: Choice, at: float) -> None:
        for piece in choice.pieces:
            self.line.add(piece.clip, piece.from_s, piece.to_s, piece.rate)
        for beat, second in choice.beats:
            self.anchors.put(beat, at + second)
        self.dancing, self._dances = choice.name, True

    def _relax(self, seconds: float) -> None:
        """Some more of standing at ease."""
        while seconds > 1e-6:
            part = min(seconds, self.rest.duration - self._rested)
            piece = Piece(self.rest.clip, self._rested, self._rested + part)
            self.line.add(piece.clip, piece.from_s, piece.to_s)
            self._rested = (self._rested + part) % self.rest.duration
            seconds -= part

    @staticmethod
    def _position(heard: Heard, beat: int) -> int:
        place = beat - heard.first
        return int(heard.positions[place]) if 0 <= place < len(heard.positions) else 0


def _on_the_line(anchors: Anchors, heard: Heard, music: float, own: float) -> Times:
    """Seconds of the timeline of the beats that are heard: anchored ones, between them evenly, outside as in music."""
    inside = [
        (b - heard.first, at) for b, at in sorted(anchors.seconds.items()) if 0 <= b - heard.first < len(heard.times)
    ]
    if not inside:
        return own + (heard.times - music)
    places, seconds = (np.array(part, dtype=np.float64) for part in zip(*inside, strict=True))
    numbers = np.arange(len(heard.times))
    first, last = int(places[0]), int(places[-1])
    times = np.interp(numbers, places, seconds)
    times[:first] += heard.times[:first] - heard.times[first]
    times[last + 1 :] += heard.times[last + 1 :] - heard.times[last]
    return times
