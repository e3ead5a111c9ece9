"""TOPP-RA, a time-optimal planner, as a peer: where a joint is too slow it slows all of the dance, and the beats go.

It is no part of onbeat and is left out where it is not installed (``pip install toppra``).
"""

from __future__ import annotations

import numpy as np

from onbeat.retime.demand import Demand


def lag_of_toppra(demand: Demand) -> float | None:
    """Seconds by which the last beat is late when a dance goes along its path as fast as limits and music allow.

    The path is the wish over its own seconds, and its speed is bounded by 1, the music's, as one more joint is.
    """
    try:
        import toppra
        from toppra import algorithm, constraint
    except ImportError:
        return None
    toppra.setup_logging("ERROR")
    knots = demand.wish.knots
    seconds = knots.times - knots.start
    path = toppra.SplineInterpolator(seconds, np.column_stack((demand.wish.samples, seconds)))
    speed = np.column_stack((-demand.speed[0], demand.speed[0]))
    most = np.column_stack((-demand.acceleration, demand.acceleration))
    bounds = [
        constraint.JointVelocityConstraint(np.vstack((speed, [-1e-3, 1.0]))),
        constraint.JointAccelerationConstraint(np.vstack((most, [-1e3, 1e3]))),
    ]
    solver = algorithm.TOPPRA(bounds, path, gridpoints=seconds, parametrizer="ParametrizeConstAccel")
    found = solver.compute_trajectory(0, 0)
    if found is None:
        return float("nan")
    return float(found.duration - seconds[-1])
