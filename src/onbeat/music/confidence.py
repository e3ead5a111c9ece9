"""How likely each beat is right: what the learned activation says of it and of those around, how even the beats are.

A logistic regression on songs of the pattern generator in ``training/``, by timbres that the network never heard.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Float32, Ints

NEAR = 2  # frames around a beat in which the activation is looked for
SPAN = 4  # beats before and after that speak for a beat
CUES = np.array([2.7, 3.0, -0.5])  # per unit of: activation at the beats around, at the beat itself; unevenness
BIAS = -1.8


def _around(values: Array) -> Array:
    """Mean over up to ``SPAN`` beats before and after each: (B,)."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    index = np.arange(len(values))
    begin, end = np.maximum(index - SPAN, 0), np.minimum(index + SPAN + 1, len(values))
    return (sums[end] - sums[begin]) / (end - begin)


def confidence_cues(log_odds: Array | Float32, beats: Ints) -> Array:
    """The cues of each beat (B, 3) from the activation's log odds (N,) and the beats' frames (B,)."""
    chance = 1.0 / (1.0 + np.exp(-maximum_filter1d(log_odds.astype(np.float64), 2 * NEAR + 1)))
    at = np.clip(beats, 0, len(chance) - 1)
    uneven = np.zeros(len(at))
    uneven[1:-1] = np.abs(np.diff(np.log(np.maximum(np.diff(at), 1))))
    return np.stack([_around(chance[at]), chance[at], _around(uneven)], axis=1)


def beat_confidence(log_odds: Array | Float32, beats: Ints) -> Array:
    """Chance (B,) that a true beat lies within 70 ms of each beat, 0…1.

    Parameters
    ----------
    log_odds : (N,) of a beat at each frame, by the learned activation.
    beats : (B,) frames, increasing.

    Examples
    --------
    >>> odds = np.full(500, -6.0)
    >>> odds[25::50] = 3.0
    >>> sure = beat_confidence(odds, np.arange(25, 500, 50))
    >>> unsure = beat_confidence(np.full(500, -3.0), np.arange(25, 500, 50))
    >>> bool((sure > unsure).all())
    True
    """
    if len(beats) < 2:
        return np.zeros(len(beats))
    return 1.0 / (1.0 + np.exp(-(confidence_cues(log_odds, beats) @ CUES + BIAS)))
