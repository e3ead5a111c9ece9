"""The keyposes of a clip of which no music is known: where it rests by its own pulse."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import PlanError
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion.motion import Motion


def own_keyposes(motion: Motion) -> Times:
    """Keyposes (K,) in seconds at the beats that a motion keeps by itself; none where it keeps none.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 2, np.random.default_rng(0))
    >>> len(own_keyposes(clip.motion)) >= len(clip.keyposes), len(own_keyposes(clip.motion[:2]))
    (True, 0)
    """
    try:
        return find_keyposes(motion, motion_beats(motion)).times
    except PlanError:
        return np.zeros(0)
