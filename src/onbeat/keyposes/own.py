"""The time of a clip of which no music is known: the pulse that it keeps by itself, and where it rests by that."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import PlanError
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.motion.motion import Motion


class OwnTime(NamedTuple):
    """``beats`` (B,) and ``keyposes`` (K,) of a motion, in seconds of its own."""

    beats: Times
    keyposes: Times


def own_time(motion: Motion, beats: Times | None = None, keyposes: Times | None = None) -> OwnTime:
    """The beats and keyposes of a motion as far as they are told, and else as they are found in it.

    Parameters
    ----------
    motion : the dance.
    beats : (B,) seconds; without them those of its own pulse.
    keyposes : (K,) seconds; without them they are found on the beats.

    Raises
    ------
    PlanError
        If the beats do not cover the motion, or it keeps no pulse and none are told.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> own_time(clip.motion).keyposes.round(1).tolist()[:3]
    [1.1, 1.7, 2.3]
    """
    beats = motion_beats(motion) if beats is None else np.asarray(beats, np.float64)
    found = find_keyposes(motion, beats).times if keyposes is None else np.asarray(keyposes, np.float64)
    return OwnTime(beats, found)


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
        return own_time(motion).keyposes
    except PlanError:
        return np.zeros(0)
