"""Flashes on the beats: a ring that runs over the floor around the dancer, wider and stronger on downbeats."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.viewer.render.stage import Ring

FADE = 0.45
"""Seconds until a flash is gone."""
BEAT, DOWNBEAT = (58, 104, 168), (238, 92, 66)
"""Their colours, sRGB."""


@dataclass(frozen=True, eq=False)
class Flashes:
    """Flashes at ``times`` (B,) in seconds, rising; ``strong`` (B,) tells which are on downbeats."""

    times: Times
    strong: Bools

    @classmethod
    def on(cls, beats: Times, downbeats: Times) -> Flashes:
        """Flashes on beats; a beat within a millisecond of a downbeat is one.

        Examples
        --------
        >>> Flashes.on(np.array([0.5, 1.0, 1.5]), np.array([0.5])).strong.tolist()
        [True, False, False]
        """
        times = np.sort(np.asarray(beats, np.float64))
        gaps = np.abs(times[:, None] - np.asarray(downbeats, np.float64)[None, :])
        return cls(times, np.asarray((gaps < 1e-3).any(axis=1)))

    def rings(self, time: float, places: Array, frame: float) -> tuple[Ring, ...]:
        """The rings that are seen in a picture.

        Parameters
        ----------
        time : seconds; a flash begins in the picture nearest to its beat.
        places : (B, 2) metres, where on the floor each flash is.
        frame : seconds from one picture to the next.
        """
        first, last = np.searchsorted(self.times, (time - FADE, time + frame / 2))
        return tuple(
            _ring(time - float(self.times[i]), bool(self.strong[i]), places[i]) for i in range(int(first), int(last))
        )


def _ring(age: float, strong: bool, place: Array) -> Ring:
    """The ring ``age`` seconds after its beat: it widens fast, then slowly, and fades."""
    left = 1.0 - min(max(age / FADE, 0.0), 1.0)
    size = 0.72 if strong else 0.52
    radius = size * (0.55 + 0.45 * (1.0 - left * left))
    strength = (0.95 if strong else 0.65) * left
    x, y = place.tolist()
    return Ring(x, y, radius, (0.035 if strong else 0.022) + 0.02 * left, strength, DOWNBEAT if strong else BEAT)
