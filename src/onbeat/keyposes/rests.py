"""How long a body rests: a pose that is held across the beat is on the beat, not in the middle of the hold."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.keyposes.energy import RATE


def nearest_to_beat(times: Times, beats: Times, curve: Array, held: float, rate: float = RATE) -> Times:
    """For each minimum of an energy curve the moment of its rest that is nearest to its beat.

    Parameters
    ----------
    times : (K,) seconds of the minima; NaN is passed through.
    beats : (K,) seconds of their beats.
    curve : (N,) energy in units of its mean.
    held : by how much the energy may be over its minimum for the body to rest still.
    rate : samples per second of the curve.

    Examples
    --------
    >>> curve = np.abs(np.linspace(-2.0, 2.0, 481))  # at rest at 2 s
    >>> nearest_to_beat(np.array([2.0]), np.array([1.5]), curve, 0.12).round(3).tolist()
    [1.88]
    """
    moved = times.copy()
    for k in np.flatnonzero(~np.isnan(times)):
        at = int(np.clip(round(times[k] * rate), 0, len(curve) - 1))
        limit = float(curve[at]) + held
        first, last = _edge(curve, at, limit, -1) / rate, _edge(curve, at, limit, 1) / rate
        moved[k] = min(max(beats[k], min(first, times[k])), max(last, times[k]))
    return moved


def _edge(curve: Array, at: int, limit: float, step: int) -> float:
    """Where the curve goes over a limit, seen from a sample under it: a place between samples."""
    while 0 <= at + step < len(curve):
        following = float(curve[at + step])
        if following > limit:
            return at + step * (limit - float(curve[at])) / (following - float(curve[at]))
        at += step
    return float(at)
