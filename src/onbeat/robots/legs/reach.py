"""How far a root's path can be followed by legs whose feet have their places.

Between a pose of the root that the legs reach and one at which they stand at ease, some share of the way is within
reach (what legs reach is, near enough, a region without holes around the pose at ease). The largest share is found for
each frame by bisection, and a smooth path of shares is laid below them.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d, minimum_filter1d

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.robots.legs.ik import Legs

MISSED = 1e-5
"""Metres and radians by which a foot may miss its place."""
EASE = 0.3
"""Seconds over which the path turns away from what is out of reach."""
HALVINGS = 7


def reachable(legs: Legs, wanted: Array, ease: Array, places: Positions, turns: Rotations, fps: float) -> Array:
    """The configurations (F, 7 + n) nearest to ``wanted`` whose legs reach the feet, with the legs solved.

    Parameters
    ----------
    legs : of the robot.
    wanted : (F, 7 + n); the legs' angles are not read.
    ease : (F, 7) places and quaternions of the root from which the feet are surely reached.
    places, turns : (F, 2, 3) and (F, 2, 4) of the feet.
    fps : frames per second.
    """
    out, away = legs.standing(wanted, places, turns)
    missed = away > MISSED
    if not missed.any():
        return out
    shares = np.ones(len(wanted))
    chosen = wanted[missed], ease[missed], places[missed], turns[missed]
    shares[missed] = _largest_shares(legs, *chosen)
    return legs.standing(towards(ease, wanted, below(shares, fps)), places, turns)[0]


def towards(ease: Array, wanted: Array, shares: Array) -> Array:
    """``wanted`` (F, 7 + n) with its root only a share (F,) of the way from ``ease`` (F, 7)."""
    out = wanted.copy()
    out[:, :3] = ease[:, :3] + shares[:, None] * (wanted[:, :3] - ease[:, :3])
    out[:, 3:7] = rot.slerp(ease[:, 3:7], wanted[:, 3:7], shares)
    return out


def below(values: Array, fps: float, width: float = EASE) -> Array:
    """A smooth path (F,) that is nowhere above the values: the least of those around, averaged over as many."""
    around = max(1, round(width * fps))
    least = minimum_filter1d(values, 2 * around + 1, mode="nearest")
    return gaussian_filter1d(least, around / 3, truncate=3.0, mode="nearest")


def _largest_shares(legs: Legs, wanted: Array, ease: Array, places: Positions, turns: Rotations) -> Array:
    low, high = np.zeros(len(wanted)), np.ones(len(wanted))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        good = legs.standing(towards(ease, wanted, middle), places, turns)[1] <= MISSED
        low, high = np.where(good, middle, low), np.where(good, high, middle)
    return low
