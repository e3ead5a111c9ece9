"""Musical intensity over time: low in a quiet introduction, high in a chorus."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Float32, Times
from onbeat.music.hearing import LOWEST_TONE, TONES

RATE = 10.0  # [Hz]
SMOOTHING = 0.5  # [s] standard deviation: about a beat
LOUDNESS_EXPONENT = 0.3  # Stevens: loudness grows with power to the 0.3
MELODY_SHARE = 0.5


def normalised(values: Array, low: float = 5.0, high: float = 95.0) -> Array:
    """Values from their low to their high percentile mapped to 0…1; constant values to 0.5.

    >>> normalised(np.array([2.0, 2.0])).tolist()
    [0.5, 0.5]
    """
    bottom, top = np.percentile(values, [low, high]) if len(values) else (0.0, 0.0)
    if top - bottom < 0.02 * max(abs(top), 1e-12):
        return np.full(len(values), 0.5)
    return np.clip((values - bottom) / (top - bottom), 0.0, 1.0)


def melody_power(tones: Float32) -> Array:
    """Eq. 7 of Shiratori 2006: power of the spectral peaks between 250 Hz and 1 kHz, for each frame."""
    frequencies = LOWEST_TONE * 2.0 ** (np.arange(TONES) / 12)
    peaks = np.zeros_like(tones)
    inner = tones[:, 1:-1]
    peaks[:, 1:-1] = np.where((inner > tones[:, :-2]) & (inner >= tones[:, 2:]), inner, 0.0)
    return peaks[:, (frequencies >= 250.0) & (frequencies <= 1000.0)].sum(axis=1, dtype=np.float64)


def intensity(tones: Float32, loudness: Float32, rate: float, duration: float) -> tuple[Times, Array]:
    """Times at 10 Hz and intensity 0…1: the melody of Eq. 7 and the whole sound, both as loud as the ear has them."""
    times = np.arange(int(np.ceil(duration * RATE)) + 1) / RATE
    times = times[times <= duration]

    def scale(power: Array) -> Array:
        loud = gaussian_filter1d(np.maximum(power, 0.0), SMOOTHING * rate, mode="nearest") ** LOUDNESS_EXPONENT
        return loud / max(float(np.percentile(loud, 95)), 1e-12)

    both = MELODY_SHARE * scale(melody_power(tones)) + (1.0 - MELODY_SHARE) * scale(loudness.astype(np.float64))
    return times, normalised(np.interp(times, np.arange(len(both)) / rate, both))
