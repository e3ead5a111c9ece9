"""A bound on the best dance of all, whatever the joins: dear to nobody, and above any search.

No dance earns more than a stop on every beat and, at each moment of the song, the intensity of the library that suits
it best. This holds for stops that are ``TOGETHER`` (0.1 s) apart, as those are that are found: two of them beside one
beat earn less than one on it.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.dance.score import FINE, Music


def most_earned(music: Music, intensity: Array | Float32) -> Array:
    """(T,) the most that each song frame can earn: sums of it bound every dance.

    Parameters
    ----------
    music : the song's side of the score.
    intensity : of all frames of the library, as in ``score.Frames``.

    Examples
    --------
    >>> worth = np.full(12 * FINE, -0.5, np.float32)
    >>> worth[6 * FINE] = 0.5
    >>> music = Music(worth, np.array([0.0, 1.0, -1.0, 0.0], np.float32), 4)
    >>> most_earned(music, np.array([-2.0, 1.5])).tolist()
    [0.0, 1.5, 2.5, 0.0]
    """
    low, high = float(np.min(intensity)), float(np.max(intensity))
    now = music.intensity.astype(np.float64)
    earned = np.maximum(now * low, now * high)
    worth = music.beat_worth.astype(np.float64)
    beat = (worth[1:-1] > worth[:-2]) & (worth[1:-1] >= worth[2:]) & (worth[1:-1] > 0)
    at = np.flatnonzero(beat) + 1
    np.add.at(earned, np.clip(at // FINE - Music.PAD, 0, music.frames - 1), worth[at])
    return earned
