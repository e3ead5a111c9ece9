"""Sound played faster or slower at its own pitch, by overlap and add of windows that fit (WSOLA).

W. Verhelst, M. Roelands: An overlap-add technique based on waveform similarity (WSOLA) for high quality time-scale
modification of speech, ICASSP 1993.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import fftconvolve

from onbeat._shapes import Array, Float32

WINDOW, SEARCH = 0.06, 0.012
"""Seconds of a window, and by how much it may be moved to fit to the one before."""


def stretched(samples: Float32, rate: int, speed: float) -> Float32:
    """Samples (N, channels) so many times as fast, (N / speed, channels); their pitch stays.

    Examples
    --------
    >>> tone = np.sin(np.arange(8000) * 2 * np.pi * 440 / 8000).astype(np.float32)[:, None]
    >>> stretched(tone, 8000, 2.0).shape
    (4000, 1)
    """
    wanted = round(len(samples) / speed)
    if speed == 1.0 or not wanted:
        return samples
    half, reach = round(WINDOW * rate / 2), round(SEARCH * rate)
    padded = np.pad(samples, ((half + reach, 3 * half + 2 * reach), (0, 0)))
    mono = padded.mean(axis=1, dtype=np.float64)
    window = np.hanning(2 * half + 1)[:-1, None].astype(np.float32)
    out = np.zeros((wanted + 2 * half, samples.shape[1]), np.float32)
    follows: int | None = None  # where the last window would go on
    for place in range(0, wanted + half, half):
        at = round(place * speed) + reach  # its middle is heard when it is due
        at = min(max(at, reach), len(padded) - 2 * half - reach)
        begin = at if follows is None else at + _fit(mono, follows, at, half, reach)
        out[place : place + 2 * half] += (window * padded[begin : begin + 2 * half])[: len(out) - place]
        follows = begin + half
    return out[half : half + wanted]


def _fit(mono: Array, follows: int, at: int, half: int, reach: int) -> int:
    """By how much a window at ``at`` is to be moved to be most like what would follow."""
    goal = mono[follows : follows + half]
    if len(goal) < half:
        return 0
    around = mono[at - reach : at + reach + half]
    likeness = fftconvolve(around, goal[::-1], mode="valid")
    power = np.sqrt(np.maximum(fftconvolve(around**2, np.ones(half), mode="valid"), 1e-9))
    return int(np.argmax(likeness / power)) - reach
