"""A recogniser to which a step and its mirror image are one: all it sees is turned to lead with the right first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat.recognition.mirroring import joined
from onbeat.recognition.recogniser import Prediction, Recogniser
from onbeat.recognition.segments import Segments


@dataclass(frozen=True, eq=False)
class JoinedSides(Recogniser):
    """As :class:`onbeat.recognition.recogniser.Recogniser`, of segments joined by :func:`.mirroring.joined`.

    Examples
    --------
    >>> from onbeat.recognition.features import NEEDED
    >>> rng = np.random.default_rng(0)
    >>> names = (*NEEDED, "left_wrist", "right_wrist")
    >>> rest = np.array([[0, 0, 0], [-1, 0, 2], [1, 0, 2], [-1, 0, 0], [1, 0, 0], [-2, 0, 1], [2, 0, 1.0]])
    >>> places = np.tile(rest, (8, 8, 1, 1)) + rng.normal(size=(8, 8, 7, 3)) * 0.01
    >>> places[:4, :, 6] += np.linspace(0, 1, 8)[:, None] * [0, 0, 1]  # the right hand goes up
    >>> places[4:, :, 6] += np.linspace(0, 1, 8)[:, None] * [0, 1, 0]  # or to the front
    >>> some = Segments(places, np.ones(8), [*"uuuuffff"], [*"ABABABAB"], [0, 0, 1, 1] * 2, names, [0] * 7)
    >>> from onbeat.recognition.mirroring import mirrored
    >>> found = JoinedSides.train(some, rng).predict(mirrored(some))
    >>> "".join(one.task for one in found)
    'uuuuffff'
    """

    @classmethod
    def train(
        cls, segments: Segments, rng: np.random.Generator, *, across: bool = False, newcomers: bool = False
    ) -> Recogniser:
        """Learn from segments, or their mirror images, whichever lead with the right."""
        return super().train(joined(segments), rng, across=across, newcomers=newcomers)

    def predict(self, segments: Segments) -> list[Prediction]:
        """What each segment, or its mirror image, is taken for."""
        return super().predict(joined(segments))
