"""How late things were, counted in a memory that does not grow."""

from __future__ import annotations

STEP = 1e-4
"""Seconds that one count stands for."""
STEPS = 10_000


class Lateness:
    """Counts of seconds, each 0.1 ms wide, up to a second; what is later counts as that.

    Examples
    --------
    >>> late = Lateness()
    >>> for seconds in (0.001, 0.001, 0.002, 0.03):
    ...     late.add(seconds)
    >>> late.count, round(late.quantile(0.5), 4), late.within(0.01), late.worst
    (4, 0.0011, 0.75, 0.03)
    """

    def __init__(self) -> None:
        self._counts = [0] * STEPS
        self.count = 0
        self.worst = 0.0

    def add(self, seconds: float) -> None:
        """Count one; early is as good as at its time."""
        self._counts[min(max(int(seconds / STEP), 0), STEPS - 1)] += 1
        self.count += 1
        self.worst = max(self.worst, seconds)

    def quantile(self, share: float) -> float:
        """Seconds within which this share, 0…1, of them were, rounded up; 0 where there are none."""
        wanted, seen = share * self.count, 0
        for step, count in enumerate(self._counts):
            seen += count
            if count and seen >= wanted:
                return (step + 1) * STEP
        return 0.0

    def within(self, seconds: float) -> float:
        """The share of them that was not later than this; 1 where there are none."""
        return sum(self._counts[: round(seconds / STEP)]) / self.count if self.count else 1.0
