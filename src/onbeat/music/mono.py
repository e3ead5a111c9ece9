"""From channels to one: their mean, or one of them where they cancel each other out."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32

CANCELLED = 0.02
"""Share of the power of channels that have nothing to do with each other, below which their mean is no use."""
SILENCE = 1e-8
"""Power (-80 dB) below which nothing is said of a block."""


class Mono:
    """Mixes blocks of one sound, one after the other.

    Two channels of which one is the other upside down, as a swapped wire makes them, have a silent mean: from the first
    block on in which they cancel out, the louder of them is heard instead.

    Examples
    --------
    >>> left = np.sin(np.arange(2000, dtype=np.float32))
    >>> mono = Mono()
    >>> bool(np.array_equal(mono(np.stack([left, -left], axis=1)), left)), mono.one
    (True, 0)
    """

    def __init__(self) -> None:
        self.one: int | None = None
        """The channel that is heard alone, from 0; None while the mean is."""

    def __call__(self, block: Float32) -> Float32:
        """(N,) of a block (N, channels)."""
        mean = np.ascontiguousarray(block.mean(axis=1, dtype=np.float32))
        if self.one is None and block.shape[1] > 1:
            powers = np.square(block, dtype=np.float32).mean(axis=0, dtype=np.float64)
            apart = float(powers.sum()) / len(powers) ** 2  # power of the mean of channels that have nothing in common
            if powers.max() > SILENCE and float(np.square(mean).mean(dtype=np.float64)) < CANCELLED * apart:
                self.one = int(powers.argmax())
        return mean if self.one is None else np.ascontiguousarray(block[:, self.one])
