"""Dances of 8, 12, 10 and 33 keyposes in a cycle: the folk dance, and three put together from the troupe's figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from onbeat.errors import PlanError
from onbeat.examples.dancers import Dancer
from onbeat.examples.figures import STANCE, Figure, Pose, Step
from onbeat.examples.folk_dance import FOLK_DANCE
from onbeat.examples.performer import Performance, perform
from onbeat.examples.repertoire import (
    ARM_WAVES,
    BOW,
    GRAPEVINE,
    KICK,
    OFFERING,
    STAR,
    STEP_TOUCH,
    SWAY,
    TURN,
)

CLAP_AND_BOW = Figure(
    name="clap and bow",
    beats=8,
    hands={
        0: "low side | low side",
        2: "clap low | clap low",
        3: "open | open",
        4: "clap high | clap high",
        6: "belly | belly",
    },
    through={5: "open | open"},
    steps=(
        Step(2, "R", 0.26, 0.10),
        Step(3, "L", -0.05, 0.08, "tap"),
        Step(4, "L", -STANCE, 0.10),
        Step(6, "R", STANCE, 0.0),
        Step(8, "L", -STANCE, 0.0, "close"),
    ),
    trunk={
        0: Pose(bow=0.04),
        2: Pose(bow=0.22, sink=0.03, nod=0.1),
        3: Pose(bow=0.02, lean=0.04),
        4: Pose(bow=-0.05, nod=-0.14),
        6: Pose(bow=0.28, sink=0.03, nod=0.12),
    },
    bounce=0.030,
)
"""Five keyposes in eight beats."""
DANCES: Mapping[str, tuple[Figure, ...]] = {
    "folk dance": (FOLK_DANCE,),
    "harvest dance": (OFFERING, STEP_TOUCH, TURN),
    "river dance": (SWAY, STAR, BOW),
    "festival dance": (FOLK_DANCE, KICK, CLAP_AND_BOW, GRAPEVINE, ARM_WAVES, OFFERING),
}
"""The figures of one cycle of each dance; 8, 12, 10 and 33 keyposes."""


def keyposes_of(dance: str) -> int:
    """How many keyposes a cycle of a dance has.

    Raises
    ------
    PlanError
        If there is no such dance.

    Examples
    --------
    >>> [keyposes_of(name) for name in DANCES]
    [8, 12, 10, 33]
    """
    return sum(len(figure.keyposes) for figure in _figures(dance))


def perform_dance(
    dancer: Dancer, dance: str, speed: float, cycles: int, rng: np.random.Generator, fps: float = 60.0
) -> Performance:
    """One clip: all figures of a dance in order, ``cycles`` times over, at ``speed`` times ``performer.TEMPO``.

    Raises
    ------
    PlanError
        If there is no such dance.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> clip = perform_dance(DANCERS[0], "river dance", 1.0, 2, np.random.default_rng(0))
    >>> clip.task, clip.cycles, len(clip.keyposes)
    ('river dance', 2, 20)
    """
    clip = perform(dancer, _figures(dance) * cycles, speed, 1, rng, fps)
    named = clip.motion.replace(name=f"{dancer.name} {dance} {speed:g}x")
    return replace(clip, motion=named, task=dance, cycles=cycles)


def _figures(dance: str) -> tuple[Figure, ...]:
    if dance not in DANCES:
        raise PlanError(f"no dance {dance!r}; there are {', '.join(DANCES)}")
    return DANCES[dance]
