"""Musical intensity over time: low in a quiet introduction, high in a chorus.

The default, :func:`perceived_intensity`, is what a dancer hears; :func:`intensity` has Eq. 7 of Shiratori 2006 in it.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Float32, Times
from onbeat.music.hearing import LOWEST_TONE, TONES
from onbeat.music.profile import Profile

RATE = 10.0  # [Hz]
SMOOTHING = 0.5  # [s] standard deviation: about a beat
LOUDNESS_EXPONENT = 0.3  # Stevens: loudness grows with power to the 0.3
MELODY_SHARE = 0.5
NEWS_SHARE = 0.3  # of new sound beside loudness: of two passages as loud, the one with more attacks is more intense


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


def perceived_intensity(profile: Profile) -> tuple[Times, Array]:
    """Times at 10 Hz and intensity 0…1: loudness as meters weight it (BS.1770) and the ear grows it, and new sound.

    Both are held against their own loud passages, so that the volume of the whole song changes nothing; within a song,
    what is louder is more intense.
    """
    loud = _evened(profile.power, profile.rate) ** LOUDNESS_EXPONENT
    news = _evened(profile.news, profile.rate)
    both = (1.0 - NEWS_SHARE) * _to_loud_passages(loud) + NEWS_SHARE * _to_loud_passages(news)
    times = _grid(profile.duration)
    return times, normalised(np.interp(times, np.arange(len(both)) / profile.rate, both))


def _grid(duration: float) -> Times:
    times = np.arange(int(np.ceil(duration * RATE)) + 1) / RATE
    return times[times <= duration]


def _evened(values: Array | Float32, rate: float) -> Array:
    return gaussian_filter1d(np.maximum(values.astype(np.float64), 0.0), SMOOTHING * rate, mode="nearest")


def _to_loud_passages(values: Array) -> Array:
    return values / max(float(np.percentile(values, 95)), 1e-12)


def intensity(tones: Float32, loudness: Float32, rate: float, duration: float) -> tuple[Times, Array]:
    """Times at 10 Hz and intensity 0…1: the melody of Eq. 7 and the whole sound, both as loud as the ear has them."""
    times = _grid(duration)
    melody, whole = (
        _to_loud_passages(_evened(power, rate) ** LOUDNESS_EXPONENT) for power in (melody_power(tones), loudness)
    )
    both = MELODY_SHARE * melody + (1.0 - MELODY_SHARE) * whole
    return times, normalised(np.interp(times, np.arange(len(both)) / rate, both))
