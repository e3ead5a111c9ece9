"""Whether what is heard is music: silence, a hum and noise are told from it by how much their bands move."""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.music.levels import FORGIVING

QUICK, SLOW = 0.05, 1.0  # [s] time constants of the levels that are compared
MOVING = 0.24  # [log10 power] root mean square of their difference, from which on sound moves like music
SOUNDING = 0.03  # share of the last seconds with sound
LOWEST = 16  # band, 160 Hz; noise in narrower ones moves by itself
REMEMBERED = 1.5  # [s] time constant of that share
FADING = 0.8  # [s] time constant at which a movement is forgotten
SPAN = 4.5  # [log10 power] under the loudest band, where levels end


class Presence:
    """Follows how much the bands move.

    Parameters
    ----------
    frame_rate : frames per second.
    """

    def __init__(self, frame_rate: float, bands: int) -> None:
        self._constants = np.array([1.0 / QUICK, 1.0 / SLOW, 1.0 / REMEMBERED, 1.0 / FADING, FORGIVING]) / frame_rate
        self._levels = np.zeros((2, bands))
        # Movement, share with sound, frames counted, level of the loud passages.
        self._state = np.array([0.0, 0.0, 0.0, -np.inf])

    def push(self, bands: Float32, sounding: Array) -> Array:
        """Movement at each frame (n,), in log10 power; 0 where too little sounds to tell."""
        moved = np.zeros(len(bands))
        _movement(bands, sounding, self._constants, self._levels, self._state, moved)
        return moved


@numba.njit(cache=True)
def _movement(bands: Float32, sounding: Array, constants: Array, levels: Array, state: Array, moved: Array) -> None:
    for frame in range(len(bands)):
        state[3] = max(bands[frame].max(), state[3] - constants[4])
        state[1] += (np.floor(sounding[frame]) - state[1]) * constants[2]
        if sounding[frame] > 0.0:
            state[2] += 1.0
            difference = 0.0
            for band in range(LOWEST, bands.shape[1]):
                level = max(bands[frame, band] - state[3] + SPAN, 0.0)
                for kind in range(2):
                    levels[kind, band] += (level - levels[kind, band]) * max(constants[kind], 1.0 / state[2])
                difference += (levels[0, band] - levels[1, band]) ** 2
            difference = np.sqrt(difference / (bands.shape[1] - LOWEST))
            state[0] = max(difference, state[0] * (1.0 - constants[3]))
        enough = state[1] > SOUNDING * min(state[2] * constants[2], 1.0) and sounding[frame] > 0.0
        moved[frame] = state[0] if enough else 0.0
