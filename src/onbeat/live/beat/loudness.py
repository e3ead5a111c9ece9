"""How loud a tick is, and how intense the music is against what was heard in the last minutes."""

from __future__ import annotations

from math import log10

import numba
import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.loudness import HIGH_PASS, OFFSET, QUIETEST, SHELF

SHORT = 0.5  # [s] time constant of loudness, and of intensity once more
MEMORY = 60.0  # [s] time constant of what is usual
LEAST = 2.0  # [dB] deviation of loudness that is taken for a difference
BOUND = 2.5
AUDIBLE = -70.0  # [LUFS] below which meters do not count (BS.1770)


@numba.njit(cache=True, nogil=True)
def _heard(samples: Float32, filters: Array, state: Array, clean: Float32) -> tuple[float, float]:
    """Loudest sample and weighted mean square; ``clean`` has 0 for what is no number."""
    loudest, power = 0.0, 0.0
    for index in range(len(samples)):
        value = float(samples[index])
        if not np.isfinite(value):
            value = 0.0
        value = min(max(value, -100.0), 100.0)
        clean[index] = value
        loudest = max(loudest, abs(value))
        for stage in range(2):
            kernel, held = filters[stage], state[stage]
            out = kernel[0] * value + held[0]
            held[0] = kernel[1] * value - kernel[4] * out + held[1]
            held[1] = kernel[2] * value - kernel[5] * out
            value = out
        power += value * value
    return loudest, power / max(len(samples), 1)


class Loudness:
    """Follows loudness (the filters of BS.1770, whose corners lie 8 % lower at 44.1 kHz).

    Attributes
    ----------
    level : loudest sample of the tick.
    intensity : standard deviations above what is usual, about −2…2.

    Examples
    --------
    >>> loudness = Loudness()
    >>> loudness.hear(np.full(441, np.nan, np.float32), 0.01, True).any(), loudness.level
    (np.False_, 0.0)
    """

    def __init__(self) -> None:
        self._filters = np.array([SHELF[0] + SHELF[1], HIGH_PASS[0] + HIGH_PASS[1]])
        self._state = np.zeros((2, 2))
        self._power = 0.0
        self._mean, self._square, self._seconds = 0.0, 0.0, 0.0
        self.level, self.intensity = 0.0, 0.0

    def hear(self, samples: Float32, seconds: float, music: bool) -> Float32:
        """Take a tick; its samples, with 0 where they are no numbers. Only music makes what is usual."""
        clean = np.zeros_like(samples)
        self.level, power = _heard(samples, self._filters, self._state, clean)
        self._power += (power - self._power) * seconds / SHORT
        loud = OFFSET + 10.0 * log10(max(self._power, QUIETEST))
        if music and loud > AUDIBLE:
            self._remember(loud, seconds)
        self.intensity += (self._above(loud, music) - self.intensity) * seconds / SHORT
        return clean

    def _remember(self, loud: float, seconds: float) -> None:
        self._seconds += seconds
        share = max(seconds / MEMORY, seconds / self._seconds)
        self._mean += share * (loud - self._mean)
        self._square += share * (loud**2 - self._square)

    def _above(self, loud: float, music: bool) -> float:
        if not music or not self._seconds:
            return 0.0
        deviation = max(self._square - self._mean**2, LEAST**2) ** 0.5
        return min(max((loud - self._mean) / deviation, -BOUND), BOUND)
