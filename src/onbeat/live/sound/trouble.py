"""Something that goes wrong for a while: said once when it begins, and once when it is over."""

from __future__ import annotations

import math

CLEAR = 2.0
"""Seconds without a trouble, after which it is over."""


class Trouble:
    """Watches one amount.

    Parameters
    ----------
    begins, over : what is said.
    high : it begins when the size of the smoothed amount is above this,
    low : and is over when that has been at most this for two seconds.
    smooth : seconds, time constant of the smoothing; 0 for none.

    Examples
    --------
    >>> rain = Trouble("it rains", "the rain is over", high=0.0, low=0.0)
    >>> [rain.hear(amount, 1.0) for amount in (0, 3, 3, 0, 0, 0)]
    [None, 'it rains', None, None, 'the rain is over', None]
    """

    def __init__(self, begins: str, over: str, high: float, low: float, smooth: float = 0.0) -> None:
        self._begins, self._over = begins, over
        self._high, self._low, self._smooth = high, low, smooth
        self._level, self._clear = 0.0, 0.0
        self.on = False

    def hear(self, amount: float, seconds: float) -> str | None:
        """Take the amount over the next seconds; what is to be said, if anything."""
        weight = 1.0 - math.exp(-seconds / self._smooth) if self._smooth else 1.0
        self._level += weight * (amount - self._level)
        size = abs(self._level)
        self._clear = self._clear + seconds if size <= self._low else 0.0
        if size > self._high and not self.on:
            self.on = True
            return self._begins
        if self.on and self._clear >= CLEAR:
            self.on = False
            return self._over
        return None
