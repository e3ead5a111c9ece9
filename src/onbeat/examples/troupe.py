"""The embedded troupe: eight dancers, a folk dance and sixteen other figures, at three speeds, with ground truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from onbeat.examples.body import Build
from onbeat.examples.dancers import DANCERS
from onbeat.examples.figures import Figure
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform
from onbeat.examples.repertoire import REPERTOIRE

FIGURES = (FOLK_DANCE, *REPERTOIRE)
"""All figures; each is a task."""
SPEEDS = (1.0, 1.2, 1.5)
"""Times the tempo of ``performer.TEMPO``."""
LIBRARY_BODY = Build(1.72)
LIBRARY_SPEEDS = (1.0, 1.2, 1.0, 1.5, 1.2)


def troupe(fps: float = 60.0, seed: int = 0) -> tuple[Performance, ...]:
    """Every dancer's performance of every figure at every speed: one figure a clip, in repeated cycles.

    The same ``fps`` and ``seed`` give the same bytes. All bodies have the same joints by the same names; their bones
    differ in length.
    """
    rng = np.random.default_rng(seed)
    return tuple(
        perform(dancer, [figure], speed, cycles_of(figure), rng, fps)
        for figure in FIGURES
        for dancer in DANCERS
        for speed in SPEEDS
    )


def cycles_of(figure: Figure) -> int:
    """How often the troupe repeats a figure in a clip: three times the folk dance, of the others 16 beats or more."""
    return 3 if figure is FOLK_DANCE else max(2, 16 // figure.beats)


def dance_library(fps: float = 60.0, seed: int = 0, body: Build | None = LIBRARY_BODY) -> list[Performance]:
    """A small and varied part of the troupe's material, about five minutes: figures chained into clips of 14–27 s.

    Every figure is danced four times, by dancers of different styles, next to different figures and at different
    speeds. All dancers borrow one ``body``, so that clips join without retargeting; with None each keeps its own.

    Examples
    --------
    >>> clips = dance_library()
    >>> len(clips), round(sum(clip.motion.duration for clip in clips) / 60, 1)
    (17, 5.3)
    """
    rng = np.random.default_rng(seed)
    clips: list[Performance] = []
    for number, figures in enumerate(_programme(rng)):
        dancer = DANCERS[number % len(DANCERS)]
        if body is not None:
            dancer = replace(dancer, build=body)
        speed = LIBRARY_SPEEDS[number % len(LIBRARY_SPEEDS)]
        clips.append(perform(dancer, _filled(figures), speed, 1, rng, fps))
    return clips


def _programme(rng: np.random.Generator) -> list[list[Figure]]:
    """All figures four times in mixed order, four to a clip and none twice in one."""
    while True:
        order = [FIGURES[i] for _ in range(4) for i in rng.permutation(len(FIGURES))]
        clips = [order[first : first + 4] for first in range(0, len(order), 4)]
        if all(len({figure.name for figure in clip}) == 4 for clip in clips):
            return clips


def _filled(figures: Sequence[Figure]) -> list[Figure]:
    """Short figures repeated so that each fills eight beats."""
    return [figure for figure in figures for _ in range(max(1, 8 // figure.beats))]
