"""The filter of Pollard et al. (2002) that the paper of 2007 compares with.

Positions are scaled into their range first. Then a controlled follower runs along the trajectory, once forward and once
backward in time, with its velocity clamped, and the mean of both is taken, so that neither lags:

    v⁺ = clamp(v + step (2√k (θ̇ − v) + k (θ − θ_filtered)), ±v_max)

It knows no music: keyposes are where the clamped follower happens to be.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Answer, Demand, Progress, silent

STIFFNESS = 800.0
"""k, 1/s². Of 10 to 10,000 the one with the least rms error on arms of real dances (``benchmarks/retime.py``)."""


def follow(demand: Demand, progress: Progress = silent, stiffness: float = STIFFNESS) -> Answer:
    """The mean of a clamped follower's ways forward and backward."""
    del progress
    step = demand.wish.knots.step
    wanted = scaled_into_range(demand.wish.samples, demand.low, demand.high)
    speed = demand.speed[1:-1]
    forward = _follow(wanted, speed, step, stiffness)
    backward = _follow(wanted[::-1], speed[::-1], step, stiffness)[::-1]
    return Answer(demand.wish.with_controls(Spline.through((forward + backward) / 2, 1 / step).controls))


def scaled_into_range(values: Array, low: Array, high: Array) -> Array:
    """Channels (F, n) whose extent is wider than their bounds are shrunk, then all are shifted inside.

    Examples
    --------
    >>> scaled_into_range(np.array([[0.0], [4.0]]), np.array([-1.0]), np.array([1.0])).tolist()
    [[-1.0], [1.0]]
    """
    least, most = values.min(axis=0), values.max(axis=0)
    extent, room = most - least, high - low
    shrink = np.where(extent > room, room / np.where(extent > 0, extent, 1.0), 1.0)
    out = least + (values - least) * shrink
    return out + np.maximum(low - out.min(axis=0), 0.0) - np.maximum(out.max(axis=0) - high, 0.0)


def _follow(wanted: Array, speed: Array, step: float, stiffness: float) -> Array:
    rates = np.gradient(wanted, step, axis=0) if len(wanted) > 1 else np.zeros_like(wanted)
    out = np.empty_like(wanted)
    place, velocity = wanted[0], np.clip(rates[0], -speed[0], speed[0])
    damping = min(2 * np.sqrt(stiffness) * step, 1.0)
    for frame in range(len(wanted)):
        out[frame] = place
        pull = damping * (rates[frame] - velocity) + stiffness * step * (wanted[frame] - place)
        most = speed[min(frame, len(speed) - 1)]
        velocity = np.clip(velocity + pull, -most, most)
        place = place + step * velocity
    return out
