"""Dancers of the folk dance, whom the tests of keypose spaces share."""

from __future__ import annotations

from functools import cache

import numpy as np

from onbeat.examples.dancers import DANCERS
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform
from onbeat.keyposes.lowdim import LowDimensional, low_dimensional


@cache
def dancers(count: int = 8, cycles: int = 3, fps: float = 30.0) -> tuple[Performance, ...]:
    """The same clips whenever they are asked for."""
    rng = np.random.default_rng(0)
    return tuple(perform(dancer, [FOLK_DANCE], 1.0, cycles, rng, fps) for dancer in DANCERS[:count])


@cache
def spaces_of(count: int = 3, dims: int = 3) -> LowDimensional:
    """Their dances in few dimensions, of the true keyposes."""
    clips = dancers(count)
    return low_dimensional(
        [clip.motion for clip in clips],
        [clip.keyposes for clip in clips],
        [clip.person for clip in clips],
        dims=dims,
        cycle=8,
    )
