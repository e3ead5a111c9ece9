"""The embedded troupe made hard to recognise: dancers who are not quite themselves, in others' bodies, off the beat.

The troupe as written dances every cycle alike, and any nearest neighbour knows it again. A real dancer is never twice
the same; how much not so is one number here, and measurements sweep it. What is danced is made hard by
``VARIATIONS``: six tasks that share their course but for one hand in one keypose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from onbeat._shapes import Times
from onbeat.examples.choreography import LEAD
from onbeat.examples.dancers import DANCERS, Dancer
from onbeat.examples.figures import Figure
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import TEMPO, Performance, perform
from onbeat.examples.rehearsal import rehearse
from onbeat.examples.troupe import FIGURES
from onbeat.recognition.segments import Segments, segments_of

JITTER, NOISE = 0.06, (0.02, 0.004)
"""At hardness 1: seconds by which keyposes are early or late; radians and metres of noise on every frame."""
STYLE = ("amplitude", "stride", "lag", "softness", "hold", "overshoot", "bounce", "bow", "crouch", "lift", "sway",
         "ornaments", "wrist")  # fmt: skip
"""The numbers of a dancer that vary from take to take."""
RATE = 30.0
VARIATIONS = tuple(
    replace(FOLK_DANCE, name=name, hands={**FOLK_DANCE.hands, **other})
    for name, other in (
        ("as ever", {}),
        ("out at 1", {1: "hip side | low side"}),
        ("up at 4", {4: "across | side up"}),
        ("down at 5", {5: "chest | side low"}),
        ("up at 6", {6: "side up | across"}),
        ("ahead at 8", {8: "punch | high front"}),
    )
)
"""The folk dance and five variations of it: one hand elsewhere in one of its eight keyposes."""


def hard_troupe(
    hardness: float,
    rng: np.random.Generator,
    figures: Sequence[Figure] = FIGURES[:6],
    takes: int = 4,
) -> Segments:
    """One segment, a whole cycle, of each take of each figure by each of the eight dancers.

    Parameters
    ----------
    hardness : 0 as written, each in the own body. Above, every take is danced in a body drawn from all eight, each
        number of the dancer's style varies by ``hardness`` times its spread among the dancers, keyposes come early or
        late by up to ``hardness · JITTER`` and frames are noisy by ``hardness · NOISE``.
    rng : the same generator gives the same segments.
    figures : the tasks.
    takes : how many of each; ``cycle`` of the segments.

    Examples
    --------
    >>> some = hard_troupe(0.5, np.random.default_rng(0), FIGURES[:1], takes=1)
    >>> len(some), some.task[0], some.person[:3]
    (8, 'folk dance', ('Aiko', 'Bruno', 'Carla'))
    >>> sorted(set(hard_troupe(0.5, np.random.default_rng(0), VARIATIONS, takes=1).task))[:3]
    ['ahead at 8', 'as ever', 'down at 5']
    """
    beat = 60.0 / TEMPO
    made = [
        (_take(dancer, figure, hardness, rng)[0], (LEAD * beat, (LEAD + figure.beats) * beat), take)
        for figure in figures
        for dancer in DANCERS
        for take in range(takes)
    ]
    clips, spans, cycles = zip(*made, strict=True)
    return segments_of(
        [clip.motion for clip in clips], spans, [clip.task for clip in clips], [clip.person for clip in clips], cycles
    )


def hard_pieces(hardness: float, rng: np.random.Generator, pieces: int = 6, takes: int = 4) -> Segments:
    """The first pieces of the folk dance, each from a keypose to the next: tasks as the paper had them.

    They are shorter than whole figures and begin and end alike, which makes the tasks hard, too. They are cut where
    the dance's keyposes should be; where the take has them is up to the dancer.

    Parameters
    ----------
    hardness, rng, takes : see :func:`hard_troupe`.
    pieces : how many, up to one fewer than the dance has keyposes.

    Examples
    --------
    >>> some = hard_pieces(0.5, np.random.default_rng(0), takes=1)
    >>> len(some), some.task[:2], round(float(some.durations.min()), 2)
    (48, ('piece 1', 'piece 2'), 0.58)
    """
    takes_of = [(*_take(dancer, FOLK_DANCE, hardness, rng), take) for dancer in DANCERS for take in range(takes)]
    made = [
        (clip.motion, (keyposes[piece], keyposes[piece + 1]), f"piece {piece + 1}", clip.person, take)
        for clip, keyposes, take in takes_of
        for piece in range(pieces)
    ]
    return segments_of(*zip(*made, strict=True))


def _take(dancer: Dancer, figure: Figure, hardness: float, rng: np.random.Generator) -> tuple[Performance, Times]:
    """A take, and the seconds at which its keyposes should be."""
    if hardness > 0:
        dancer = _unlike(dancer, hardness, rng)
    clip = perform(dancer, [figure], 1.0, 1, rng, RATE)
    noise = (hardness * NOISE[0], hardness * NOISE[1])
    return rehearse(clip, rng, hardness * JITTER, noise), clip.keyposes


def _unlike(dancer: Dancer, hardness: float, rng: np.random.Generator) -> Dancer:
    """The dancer on another day, in somebody's body."""
    every = np.array([[getattr(one, name) for name in STYLE] for one in DANCERS], np.float64)
    values = np.array([getattr(dancer, name) for name in STYLE]) + hardness * every.std(axis=0) * rng.normal(size=13)
    kept = np.clip(values, every.min(axis=0), every.max(axis=0))
    build = DANCERS[int(rng.integers(len(DANCERS)))].build
    return replace(dancer, build=build, **dict(zip(STYLE, kept.tolist(), strict=True)))
