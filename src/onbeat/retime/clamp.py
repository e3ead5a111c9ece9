"""What most tools do: positions clipped, and steps from frame to frame clamped to the highest velocity.

Run forward and backward in time and averaged, so that it does not lag; a strong baseline for the error, and a rough one
for the acceleration, which it does not know.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Answer, Demand, Progress, silent


def clamp(demand: Demand, progress: Progress = silent) -> Answer:
    """The mean of clamped ways forward and backward."""
    del progress
    step, target = demand.wish.knots.step, demand.target
    most = np.minimum(demand.speed[1:-2], demand.speed[2:-1]) * step if len(target) > 2 else demand.speed[1:-1] * step
    mean = (_clamped(target, most) + _clamped(target[::-1], most[::-1])[::-1]) / 2
    return Answer(demand.wish.with_controls(Spline.through(mean, 1 / step).controls))


def _clamped(target: Array, most: Array) -> Array:
    out = target.copy()
    for frame in range(1, len(target)):
        step = most[min(frame, len(most)) - 1]
        out[frame] = np.clip(target[frame], out[frame - 1] - step, out[frame - 1] + step)
    return out
