"""Loudness made comparable: bands against the loud passages nearby, so that gain and fades do not matter."""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32

RANGE = 5.0  # [log10 power] under the loud passages, below which a sound is as good as none
FORGIVING = 0.3  # [log10 power / s] that the loud passages are forgotten by
QUIETEST = -8.0  # [log10 power] that the loud passages have at the least
RISE_LAG = 2  # frames over which a rise is measured


@numba.njit(cache=True)
def _leaking_peak(tops: Float32, forgotten: float, level: float) -> Float32:
    """Highest value so far, forgotten by ``forgotten`` a frame."""
    result = np.empty_like(tops)
    for frame in range(len(tops)):
        level = max(float(tops[frame]), level - forgotten)
        result[frame] = level
    return result


def loud_level(tops: Float32, rate: float) -> Float32:
    """Level (N,) of the loud passages before and after each frame, from the loudest band ``tops`` (N,)."""
    forgotten = FORGIVING / rate
    before = _leaking_peak(tops, forgotten, QUIETEST)
    after = _leaking_peak(np.ascontiguousarray(tops[::-1]), forgotten, QUIETEST)[::-1]
    return np.maximum(before, after)


def loud_level_so_far(tops: Float32, rate: float, level: float = QUIETEST) -> Float32:
    """Level (N,) of the loud passages up to each frame; ``level`` goes on from earlier frames.

    >>> loud_level_so_far(np.array([-2.0, -3.0, -1.0], np.float32), 1.2).tolist()
    [-2.0, -2.25, -1.0]
    """
    return _leaking_peak(tops, FORGIVING / rate, level)


def relative(bands: Array | Float32, level: Array | Float32) -> Float32:
    """Bands (N, B) against a level (N,): 0 for silence, 2 for the loudest."""
    above = np.maximum(bands.astype(np.float32) - np.maximum(level, QUIETEST)[:, None].astype(np.float32) + RANGE, -4.0)
    return np.log10(1.0 + np.float32(10.0) ** above) * np.float32(2.0 / RANGE)


def with_rises(levels: Float32, before: Float32) -> Float32:
    """Levels (N, B) and their rises against the louder of three bands two frames before: (N, 2, B).

    ``before`` (2, B) are the two frames that came before the first.
    """
    whole = np.concatenate([before, levels])[: len(levels)]
    edge = np.pad(whole, ((0, 0), (1, 1)))
    highest = np.maximum(np.maximum(edge[:, :-2], edge[:, 2:]), whole)
    return np.stack([levels, np.maximum(levels - highest, 0.0)], axis=1)
