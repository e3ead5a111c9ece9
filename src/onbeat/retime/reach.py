"""Which keyposes a body can take at all: inside its bounds, and to be gone between at full speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.retime.demand import Demand

ANY = 1e12
"""rad a frame, in the place of no bound, of which no differences can be taken."""


class Asked(NamedTuple):
    """The keyposes within a demand's time.

    ``times`` (K,) seconds; ``wanted`` (K, n) the wish there, ``aims`` the same inside the bounds; ``feasible`` (K, n)
    whether the wish is inside, and could be reached at full speed from the aim before and left for the next.
    """

    times: Times
    wanted: Array
    aims: Array
    feasible: Bools


def keyposes_of(demand: Demand) -> Asked:
    """The keyposes of a demand, and which of them can be kept.

    Accelerating takes time as well, so what is called feasible may yet not be: it is a necessary condition.

    Examples
    --------
    >>> from onbeat.retime.bspline import Spline
    >>> from onbeat.retime.lock import TimeMap
    >>> wish, free = Spline.through(np.array([[0.0], [0.5], [1.0], [1.1], [1.2]]), 1.0), np.array([np.inf])
    >>> slow = Demand(wish, -free, free, np.array([0.2]), free, free, np.array([0.0, 2.0, 4.0]), TimeMap.steady(1.0))
    >>> keyposes_of(slow).feasible[:, 0].tolist()
    [False, False, True]
    """
    knots = demand.wish.knots
    times = demand.keyposes[(demand.keyposes >= knots.start) & (demand.keyposes <= knots.end)]
    wanted = demand.wish(times)
    aims = np.clip(wanted, demand.low, demand.high)
    return Asked(times, wanted, aims, (wanted == aims) & _reachable(demand, times, aims))


def _reachable(demand: Demand, times: Times, values: Array) -> Bools:
    """(K, n) whether values at times can be gone between at full speed, with the one before and the one after."""
    if len(times) < 2:
        return np.ones(values.shape, dtype=bool)
    knots = demand.wish.knots
    most = np.minimum(demand.speed[1:-1] * knots.step, ANY)
    run = np.concatenate((np.zeros((1, values.shape[1])), np.cumsum(most, axis=0)))
    at = np.clip((times - knots.start) / knots.step, 0, len(run) - 1)
    low = np.minimum(at.astype(np.int64), len(run) - 2)
    far = run[low] + (at - low)[:, None] * (run[low + 1] - run[low])
    fits = np.abs(np.diff(values, axis=0)) <= np.diff(far, axis=0)
    edge = np.ones((1, values.shape[1]), dtype=bool)
    return np.concatenate((edge, fits)) & np.concatenate((fits, edge))
