"""The tempo as it wanders: at each beat, from a straight line through the beats around it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Times

AROUND = 8  # beats that the line runs through: two bars of four


class TempoCurve(NamedTuple):
    """Local tempo: ``bpm`` (B,) beats a minute at ``times`` (B,) seconds."""

    times: Times
    bpm: Array

    def at(self, times: Times) -> Array:
        """Tempo at any times, by linear interpolation; 0 where there is none."""
        return np.interp(times, self.times, self.bpm) if len(self.times) else np.zeros(len(times))


def tempo_curve(beats: Times, around: int = AROUND) -> TempoCurve:
    """Beats a minute at each beat: 60 over the slope of the least-squares line through the ``around`` beats near it.

    At the ends the line runs through the first and the last of them. Fewer than two beats have no tempo.

    >>> tempo_curve(np.array([0.0, 0.5, 1.0, 1.5])).bpm.round(6).tolist()
    [120.0, 120.0, 120.0, 120.0]
    """
    count = min(around, len(beats))
    if count < 2:
        return TempoCurve(np.zeros(0), np.zeros(0))
    place = np.arange(count) - (count - 1) / 2.0
    slopes = np.convolve(beats, place[::-1] / (place @ place), mode="valid")  # seconds a beat
    nearest = np.clip(np.arange(len(beats)) - count // 2, 0, len(slopes) - 1)
    return TempoCurve(np.array(beats), 60.0 / np.maximum(slopes[nearest], 1e-6))
