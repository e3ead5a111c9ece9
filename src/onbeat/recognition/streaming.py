"""Recognising while it is danced: frames and beats go in as they come, a segment's answer comes out when it has ended.

A segment ends at a keypose, and a keypose is known a little later: the body has to have risen from its rest again
(:data:`SETTLED` beats). What is a rest is told by the mean energy of the last seconds that are kept, where a whole
motion would be told by its own; segments between the same keyposes get the same answers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import MetricError
from onbeat.keyposes.extract import CLOSEST, Options, find_keyposes
from onbeat.motion.motion import Motion
from onbeat.recognition.recogniser import Prediction, Recogniser
from onbeat.recognition.segments import segments_of

SETTLED = 2.0
"""Beats after which nothing that comes later moves a keypose."""
MEMORY, LONGEST = 30.0, 120.0
"""Seconds that are kept at least, and at most: a segment that lasts longer is forgotten."""
_EDGE = 1e-6  # seconds
_USUAL = Options()


class Ended(NamedTuple):
    """A segment that has ended: its seconds since the first frame, and what it is taken for."""

    start: float
    end: float
    prediction: Prediction


class Listener:
    """Recognises the segments of a motion as they end.

    Parameters
    ----------
    recogniser : what was learned.
    span : keyposes a segment: from each keypose to the one so many later.
    options : how keyposes are looked for.
    memory : seconds that are kept at least.

    Raises
    ------
    MetricError
        If ``span`` is less than 1, or ``memory`` not between 5 s and ``LONGEST``.
    """

    def __init__(self, recogniser: Recogniser, span: int, options: Options = _USUAL, memory: float = MEMORY) -> None:
        if span < 1:
            raise MetricError(f"a span of {span} keyposes; 1 or more is needed")
        if not 5.0 <= memory <= LONGEST:
            raise MetricError(f"a memory of {memory} s; 5 to {LONGEST:g} s is needed")
        self._recogniser, self._span, self._options, self._memory = recogniser, span, options, memory
        self._chunks: list[Motion] = []
        self._first = 0  # frames that were let go
        self._beats = np.zeros(0)
        self._looked = -np.inf  # second of the last beat that was decided about
        self._keyposes: list[float] = []

    @property
    def now(self) -> float:
        """Seconds from the first frame to the last that came."""
        return (self._first + self._held - 1) / self._chunks[0].fps if self._chunks else 0.0

    @property
    def held(self) -> float:
        """Seconds that are kept."""
        return self._held / self._chunks[0].fps if self._chunks else 0.0

    def push(self, frames: Motion, beats: Times | Sequence[float] = ()) -> list[Ended]:
        """Take the next frames and the beats that have become known; give the segments that have ended.

        Parameters
        ----------
        frames : the next of the motion, of the same body and rate as those before.
        beats : seconds since the first frame, later than all before; they may be told ahead of the frames.

        Raises
        ------
        MetricError
            If the frames are of another body or rate, or beats do not increase.
        """
        self._take(frames, np.asarray(beats, np.float64))
        return self._decided(SETTLED)

    def finish(self) -> list[Ended]:
        """The segments that end at the last keyposes, when no more frames will come."""
        return self._decided(0.0)

    @property
    def _held(self) -> int:
        return sum(len(chunk) for chunk in self._chunks)

    def _take(self, frames: Motion, beats: Times) -> None:
        if self._chunks and (
            frames.fps != self._chunks[0].fps or frames.skeleton.names != self._chunks[0].skeleton.names
        ):
            raise MetricError(
                f"frames of {len(frames.skeleton)} joints at {frames.fps:g} a second after some of "
                f"{len(self._chunks[0].skeleton)} at {self._chunks[0].fps:g}; take a new listener for another body"
            )
        together = np.concatenate((self._beats, beats))
        if not np.isfinite(together).all() or (np.diff(together) <= 0).any():
            raise MetricError("beats have to be increasing seconds, later than those before")
        self._chunks.append(frames)
        self._beats = together

    def _decided(self, settled: float) -> list[Ended]:
        """Look for keyposes where a beat more is settled, and recognise what ends at them."""
        if len(self._beats) < 3 or not self._chunks:
            return []
        period = float(np.median(np.diff(self._beats)))
        horizon = self.now - settled * period
        ripe = self._beats[(self._beats > self._looked) & (self._beats <= horizon)]
        if not len(ripe):
            return []
        self._looked = float(ripe[-1])
        motion, start = self._motion()
        found = self._found(motion, start, period)
        ended = [one for time in found if (one := self._ends_at(time, motion, start)) is not None]
        self._forget(period)
        return ended

    def _motion(self) -> tuple[Motion, float]:
        """What is held as one motion, and the second at which it begins."""
        if len(self._chunks) > 1:
            parts = self._chunks
            translations = None
            if all(part.translations is not None for part in parts):
                translations = np.concatenate([part.translations for part in parts if part.translations is not None])
            self._chunks = [
                Motion(
                    parts[0].skeleton,
                    np.concatenate([part.rotations for part in parts]),
                    np.concatenate([part.root_positions for part in parts]),
                    parts[0].fps, parts[0].name, translations,
                )
            ]  # fmt: skip
        return self._chunks[0], self._first / self._chunks[0].fps

    def _found(self, motion: Motion, start: float, period: float) -> list[float]:
        """Seconds of the keyposes that are new, at beats that are settled."""
        beats = self._beats - start
        inside = beats[(beats >= 0.0) & (beats <= (len(motion) - 1) / motion.fps)]
        if len(inside) < 2:
            return []
        found = find_keyposes(motion, inside, options=self._options)
        last = self._keyposes[-1] if self._keyposes else -np.inf
        return [
            time
            for time, beat in zip((found.times + start).tolist(), found.beats.tolist(), strict=True)
            if found.song_beats[beat] + start <= self._looked + _EDGE and time > last + CLOSEST * period
        ]

    def _ends_at(self, time: float, motion: Motion, start: float) -> Ended | None:
        """The segment that ends at a keypose, if it has begun within what is kept."""
        self._keyposes.append(time)
        if len(self._keyposes) <= self._span or self._keyposes[-1 - self._span] < start - _EDGE:
            return None
        begun = self._keyposes[-1 - self._span]
        segment = segments_of(
            [motion], [(max(begun - start, 0.0), time - start)], [""], [""], [0], moments=self._recogniser.moments
        )
        return Ended(begun, time, self._recogniser.predict(segment)[0])

    def _forget(self, period: float) -> None:
        """Let go what no segment needs any more."""
        self._keyposes = self._keyposes[-self._span :]
        oldest = self._keyposes[0] - period if self._keyposes else self.now
        kept = max(min(self.now - self._memory, oldest), self.now - LONGEST)
        motion, _ = self._motion()
        gone = min(max(int(kept * motion.fps) - self._first, 0), len(motion) - 1)
        if gone:
            self._chunks = [motion[gone:]]
            self._first += gone
        self._beats = self._beats[self._beats >= kept - period]
