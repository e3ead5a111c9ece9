"""Recognition in two calls: learn from motions whose tasks and persons are known, and say what others are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from onbeat.motion.motion import Motion
from onbeat.recognition.recogniser import Prediction, Recogniser
from onbeat.recognition.segments import Segments, segments_of

Span = tuple[float, float]


def train_recogniser(
    motions: Sequence[Motion],
    tasks: Sequence[str],
    persons: Sequence[str] = (),
    spans: Sequence[Span] = (),
    *,
    seed: int = 0,
    across: bool = False,
) -> Recogniser:
    """Learn who dances what from motions, or stretches of them.

    Parameters
    ----------
    motions : S of them; for several stretches of one it comes again and again.
    tasks : (S,) what is danced; "" where it is not known.
    persons : (S,) who dances it; none where that is not to be learned.
    spans : (S,) start and end in seconds; without them each motion is taken whole.
    seed : of the choice among many segments.
    across : known may be as far away as a known task by a new person, not only another repetition by the same. Without
        it such a task is a guess: ``Prediction.perhaps`` and ``Prediction.said``.

    Raises
    ------
    MetricError
        If the lists are not equally long, nothing has a label, or a span is outside its motion.
    BodyError
        If a body lacks a role that every body needs.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clips = [perform(dancer, [FOLK_DANCE], 1.0, 1, np.random.default_rng(0)) for dancer in DANCERS[:3]]
    >>> motions = [clip.motion for clip in clips for _ in range(3)]
    >>> spans = [(clip.keyposes[k], clip.keyposes[k + 1]) for clip in clips for k in (1, 3, 5)]
    >>> knows = train_recogniser(motions, ["one", "two", "three"] * 3, spans=spans)
    >>> [told.task for told in recognise(knows, motions[:3], spans[:3])]
    ['one', 'two', 'three']
    """
    unknown = [""] * len(motions)
    seen = Counter[tuple[str, str]]()
    cycles: list[int] = []
    for pair in zip(tasks, persons or unknown, strict=False):
        cycles.append(seen[pair])
        seen[pair] += 1
    segments = _segments(motions, spans, tasks, persons or unknown, cycles)
    return Recogniser.train(segments, np.random.default_rng(seed), across=across, newcomers=True)


def recognise(recogniser: Recogniser, motions: Sequence[Motion], spans: Sequence[Span] = ()) -> list[Prediction]:
    """Who dances what in motions, or stretches of them, and what is new; examples at :func:`train_recogniser`.

    Parameters
    ----------
    recogniser : as it was trained, or read by ``onbeat.load_recogniser``.
    motions, spans : as of :func:`train_recogniser`.

    Raises
    ------
    MetricError
        If there is none, a span is outside its motion, or a body lacks what was learned.
    """
    unknown = [""] * len(motions)
    return recogniser.predict(_segments(motions, spans, unknown, unknown, [0] * len(motions)))


def _segments(
    motions: Sequence[Motion], spans: Sequence[Span], tasks: Sequence[str], persons: Sequence[str], cycles: list[int]
) -> Segments:
    whole = [(0.0, (len(motion) - 1) / motion.fps) for motion in motions]
    return segments_of(motions, spans or whole, tasks, persons, cycles)
