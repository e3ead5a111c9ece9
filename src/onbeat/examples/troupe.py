"""The embedded troupe: eight dancers, a folk dance and a dozen other figures, at three speeds, with ground truth."""

from __future__ import annotations

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform

SPEEDS = (1.0, 1.2, 1.5)
"""Times the tempo of ``performer.TEMPO``."""


def troupe(fps: float = 60.0, seed: int = 0) -> tuple[Performance, ...]:
    """Every dancer's performance of every figure at every speed, one figure a clip."""
    rng = np.random.default_rng(seed)
    return tuple(
        perform(dancer, [figure], speed, cycles=3 if figure.beats > 8 else 2, rng=rng, fps=fps)
        for figure in (FOLK_DANCE,)
        for dancer in DANCERS
        for speed in SPEEDS
    )


def dance_library(fps: float = 60.0, seed: int = 0) -> list[Performance]:
    """A small and varied part of the troupe's material, figures chained into clips of 8–25 s."""
    rng = np.random.default_rng(seed)
    return [perform(dancer, [FOLK_DANCE], 1.0, cycles=2, rng=rng, fps=fps) for dancer in DANCERS]
