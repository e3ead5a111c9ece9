"""The library of the embedded troupe, kept after it is first made."""

from __future__ import annotations

from functools import partial
from importlib.metadata import version

from onbeat.examples import embedded_motions
from onbeat.moves.cache import build_from
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.steps import Step

TROUPE = 1  # to be raised when the troupe's dances change


def embedded_library(seed: int = 0, *, mirror: bool = True, step: Step | None = None) -> MoveLibrary:
    """The moves of the procedural troupe, ready to dance."""
    key = f"troupe {TROUPE} of onbeat {version('onbeat')}, seed {seed}"
    return build_from(partial(embedded_motions, seed), key, mirror=mirror, step=step)
