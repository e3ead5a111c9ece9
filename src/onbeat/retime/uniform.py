"""Slower until it fits: all of the dance at one lower rate; the beats are lost."""

from __future__ import annotations

import numpy as np

from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Answer, Demand, Progress, silent


def slow_down(demand: Demand, progress: Progress = silent) -> Answer:
    """The wish slowed by the least factor that keeps every velocity, positions clipped; it ends before it is over."""
    del progress
    knots = demand.wish.knots
    past = np.abs(demand.wish.differences(1)) / demand.speed
    rate = 1.0 / max(1.0, float(past.max()))
    samples = demand.wish(knots.start + rate * (knots.times - knots.start))
    clipped = np.clip(samples, demand.low, demand.high)
    return Answer(demand.wish.with_controls(Spline.through(clipped, 1 / knots.step).controls))
