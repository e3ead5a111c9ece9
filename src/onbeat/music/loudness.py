"""Loudness as meters have it (ITU-R BS.1770): mean squares of the sound, weighted as the ear weights frequencies."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import uniform_filter1d

from onbeat._shapes import Array, Float32

# The two filters of BS.1770-4, Annex 1, at 48 kHz: numerator, denominator.
SHELF = (1.53512485958697, -2.69169618940638, 1.19839281085285), (1.0, -1.69065929318241, 0.73248077421585)
HIGH_PASS = (1.0, -2.0, 1.0), (1.0, -1.99004745483398, 0.99007225036621)
METER_RATE = 48000.0  # [Hz] of those filters
OFFSET = -0.691  # [dB] so that a full-scale sine of 997 Hz reads −3.01
HANN_SUM = 1.5  # bins over which a Hann window spreads the power of a sine
QUIETEST = 1e-10  # mean square, −100 dB


def perceptual_weighting(frequencies: Array) -> Array:
    """K-weighting of BS.1770 as a factor on power.

    >>> bool(abs(10.0 * np.log10(perceptual_weighting(np.array([997.0]))[0]) - 0.691) < 0.01)
    True
    """
    turn = np.exp(-2j * np.pi * np.minimum(frequencies, METER_RATE / 2.0) / METER_RATE)
    gain = np.ones(len(frequencies), dtype=np.complex128)
    for above, below in (SHELF, HIGH_PASS):
        gain *= (above[0] + above[1] * turn + above[2] * turn**2) / (below[0] + below[1] * turn + below[2] * turn**2)
    return np.abs(gain) ** 2


def mean_square(power: Float32, weights: Float32) -> Float32:
    """Weighted mean square (N,) of the sound in each Hann window, from its power (N, bins; a full-scale sine is 1)."""
    return (power @ weights) / np.float32(2.0 * HANN_SUM)


def short_term_loudness(power: Array | Float32, rate: float, seconds: float = 3.0) -> Array:
    """Loudness in LUFS (N,) over the ``seconds`` around each frame of weighted mean squares (N,)."""
    around = uniform_filter1d(power.astype(np.float64), max(round(seconds * rate), 1), mode="nearest")
    return OFFSET + 10.0 * np.log10(np.maximum(around, QUIETEST))
