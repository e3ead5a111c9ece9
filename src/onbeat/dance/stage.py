"""Keeping the dancer on the stage.

Clips of dancers who travel, put end to end, walk off. At every join the next move, and all after it, may be turned a
little more or less about the point that stays; the blend takes the turn up. Turned always towards the middle, a dance
keeps to a modest ground without a foot sliding.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions, Times

MOST = np.radians(10.0)
"""Radians a join may turn the dance by."""
AHEAD = 6.0
"""Seconds of the dance to come whose mean place is turned towards the middle."""
CALM = 0.8
"""Metres from the middle within which nothing is turned; the turn is full at twice that."""


def steering(pivots: Positions, joins: Times, path: Positions, times: Times, most: float = MOST) -> Array:
    """(K,) radians by which each join should turn what follows about its pivot.

    Parameters
    ----------
    pivots : (K, 3) metres, the points that stay, where the joins turn nothing.
    joins : (K,) seconds of the joins.
    path : (N, 3) metres, the dancer's path where the joins turn nothing, beginning at the middle.
    times : (N,) seconds of its points.
    most : radians a join may turn by.
    """
    ground = path[:, 0] + 1j * path[:, 1]
    sums = np.concatenate(([0.0], np.cumsum(ground)))
    first, last = np.searchsorted(times, joins), np.searchsorted(times, joins + AHEAD)
    ahead = (sums[last] - sums[first]) / np.maximum(last - first, 1)
    turn, shift = 1.0 + 0.0j, 0.0 + 0.0j  # what the joins so far do to the ground: z → turn z + shift
    turns = np.zeros(len(joins))
    for k, pivot in enumerate((pivots[:, 0] + 1j * pivots[:, 1]).tolist()):
        here, there = turn * pivot + shift, turn * complex(ahead[k]) + shift
        out = max(abs(here), abs(there)) / CALM - 1.0
        angle = float(np.angle(-here * np.conj(there - here))) if out > 0 else 0.0
        turns[k] = np.clip(angle, -most, most) * min(out, 1.0)
        step = np.exp(1j * turns[k])
        turn, shift = turn * step, here + (shift - here) * step
    return turns
