"""Segments of a dance from keypose to keypose: the pieces that are recognised and retimed."""

from __future__ import annotations

from typing import NamedTuple

from onbeat.keyposes.extract import Keyposes


class Segment(NamedTuple):
    """A stretch between two keyposes: seconds, and the indices of the beats they are on."""

    start: float
    end: float
    first_beat: int
    last_beat: int

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.end - self.start


def segments(keyposes: Keyposes, span: int = 1) -> list[Segment]:
    """The stretches from each keypose to the one ``span`` keyposes later.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> from onbeat.keyposes.extract import find_keyposes
    >>> import numpy as np
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> [part.last_beat - part.first_beat for part in segments(find_keyposes(clip.motion, clip.beats))]
    [1, 1, 2, 1, 1, 2, 2, 2]
    """
    times, beats = keyposes.times.tolist(), keyposes.beats.tolist()
    pairs = zip(range(len(times) - span), range(span, len(times)), strict=True)
    return [Segment(times[a], times[b], beats[a], beats[b]) for a, b in pairs]
