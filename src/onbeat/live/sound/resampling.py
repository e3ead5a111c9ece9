"""Another rate for sound that streams by, a few samples late whatever the block size.

A windowed sinc: output ``k`` is the input at ``k * rate / to``, weighed over 16 zero crossings to either side.
Resamplers made for files gather up to a tenth of a second before they give anything; a dancer cannot wait for it.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from onbeat._shapes import Float32

ZEROS = 16  # crossings to either side of a sample
PHASES = 512  # places between two samples for which weights are kept; between those they are interpolated
SHAPE = 8.0  # of the Kaiser window
PASSED = 0.93  # of half the lower rate


class Resampler:
    """Brings samples from one rate to another.

    Parameters
    ----------
    rate, to : samples per second.

    Examples
    --------
    >>> doubled = Resampler(8000, 16000)
    >>> doubled.push(np.ones(100, np.float32)).shape, round(doubled.latency, 4)
    ((168,), 0.002)
    """

    def __init__(self, rate: int, to: int) -> None:
        self._rate, self._to = rate, to
        wide = max(rate / to, 1.0)
        self._half = math.ceil(ZEROS * wide)
        self._weights = _weights(self._half, PASSED / wide)
        self._held = np.zeros(self._half - 1, np.float32)
        self._first = 1 - self._half  # number of the first sample that is held
        self._next = 0  # number of the next output
        self.push(np.zeros(0, np.float32))  # compiled, or loaded, before it is urgent

    @property
    def latency(self) -> float:
        """Seconds of sound that are held back."""
        return self._half / self._rate

    def push(self, samples: Float32) -> Float32:
        """All output (m,) that the next samples (n,) make possible."""
        held = np.concatenate((self._held, samples))
        behind = self._first + len(held) - self._half  # the last output lies before this one
        count = max((behind * self._to - 1) // self._rate + 1 - self._next, 0)
        out = np.empty(count, np.float32)
        _interpolate(held, self._weights, self._half, self._first, self._next, self._rate, self._to, out)
        self._next += count
        used = self._next * self._rate // self._to - self._half + 1 - self._first
        self._held = held[used:].copy()
        self._first += used
        return out

    def flush(self) -> Float32:
        """What is held back, as if silence came next."""
        return self.push(np.zeros(self._half, np.float32))


def _weights(half: int, cutoff: float) -> Float32:
    """(PHASES + 1, 2 · half) of the samples from ``half − 1`` before to ``half`` behind each place between two."""
    away = np.arange(1 - half, half + 1) - np.linspace(0.0, 1.0, PHASES + 1)[:, None]
    window = np.i0(SHAPE * np.sqrt(np.maximum(1.0 - (away / half) ** 2, 0.0)))
    weights = np.sinc(cutoff * away) * window
    return (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)


@numba.njit(cache=True, nogil=True)
def _interpolate(
    held: Float32, weights: Float32, half: int, first: int, number: int, rate: int, to: int, out: Float32
) -> None:
    for k in range(len(out)):
        place = (number + k) * rate
        begin = place // to - half + 1 - first
        phase = (place % to) * PHASES / to
        row = int(phase)
        share = phase - row
        total = 0.0
        for tap in range(2 * half):
            low = weights[row, tap]
            total += held[begin + tap] * (low + share * (weights[row + 1, tap] - low))
        out[k] = total
