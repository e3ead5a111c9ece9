"""How well the sound at a moment fits a beat, a half-beat, or the time between: the observation of the beat tracker.

A learned activation can stand in for the onset strength: anything that is high at beats and low elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array

ZONE = 16  # a beat is heard in the first 1/16 of its interval (Böck, Krebs & Widmer 2014)
SOFT = 1.5  # onset strength at which the activation is a half
QUIET = 0.02  # least activation


@dataclass(frozen=True)
class Observation:
    """Running sums over frames of the logarithm of the likelihood, as a beat and as none.

    Parameters
    ----------
    beat, other : (N + 1,) sum of the log-likelihood of the frames before.
    """

    beat: Array
    other: Array


def activation(strength: Array) -> Array:
    """Onset strength (mean square 1) squashed to 0…1."""
    squared = strength**2
    return np.clip(squared / (squared + SOFT**2), QUIET, 1.0 - QUIET)


def observe(activations: Array) -> Observation:
    """Likelihoods of Böck, Krebs & Widmer 2014: a at beats, (1 − a)/(zone − 1) elsewhere."""
    beat = np.log(activations)
    other = np.log((1.0 - activations) / (ZONE - 1))
    zero = np.zeros(1)
    return Observation(np.concatenate([zero, np.cumsum(beat)]), np.concatenate([zero, np.cumsum(other)]))
