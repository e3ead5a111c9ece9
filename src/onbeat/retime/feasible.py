"""What a body cannot do: keyposes that are missed, why, and the speed that would do."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.errors import PlanError
from onbeat.retime.bspline import Knots, Spline
from onbeat.retime.controlpoints import fit
from onbeat.retime.demand import Demand
from onbeat.retime.measures import Measures
from onbeat.retime.reach import keyposes_of

MISSED = np.radians(0.5)
"""Error from which on a keypose is missed."""
LEAST = 0.2
"""Share of the speed under which none is looked for."""
_STEP, _HALVINGS = 0.93, 5


@dataclass(frozen=True)
class Missed:
    """A keypose that a joint does not get to.

    ``channel`` of the demand, ``time`` in the music's seconds, ``error`` in radians, and ``range``: whether it is out
    of the joint's range, so that no speed would do.
    """

    channel: int
    time: float
    error: float
    range: bool


def missed(demand: Demand, measures: Measures) -> list[Missed]:
    """The keyposes that are missed by more than half a degree or are out of range, in order of time."""
    asked = keyposes_of(demand)
    outside = np.abs(asked.aims - asked.wanted)
    error = np.maximum(measures.keypose_errors, outside)
    return [
        Missed(int(c), float(asked.times[k]), float(error[k, c]), bool(outside[k, c] > MISSED))
        for k, c in np.argwhere(error > MISSED)
    ]


def speed_that_would_do(demand: Demand, found: list[Missed]) -> float | None:
    """The share of the speed, 0 to 1, at which method ``qp`` misses no keypose that is in range.

    The channels that miss any are solved again, slower and slower, until none does; None where even a fifth of the
    speed is too much, 1 where nothing is missed for the speed's sake.

    Examples
    --------
    >>> from onbeat.retime.lock import TimeMap
    >>> from onbeat.retime.measures import measure
    >>> wish = Spline.through(np.repeat([0.0, 1.0], 30)[:, None], 30)
    >>> free = np.array([np.inf])
    >>> far = Demand(wish, -free, free, np.array([0.5]), free, free, np.array([0.5, 1.5]), TimeMap.steady(2.0))
    >>> share = speed_that_would_do(far, missed(far, measure(far, fit(far).trajectory)))
    >>> 0.45 < share < 0.55
    True
    """
    late = np.unique([one.channel for one in found if not one.range]).astype(np.int64)
    if not len(late):
        return 1.0
    part = _channels(demand, late)
    good, bad = _STEP, 1.0
    while not _met(slower(part, good)):
        good, bad = good * _STEP, good
        if good < LEAST:
            return None
    for _ in range(_HALVINGS):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if _met(slower(part, middle)) else (good, middle)
    return good


def slower(demand: Demand, share: float) -> Demand:
    """The same at a share of the speed: its knots are further apart."""
    knots = demand.wish.knots
    wish = Spline(Knots(knots.start / share, knots.step / share, knots.intervals), demand.wish.controls)
    return replace(demand, wish=wish, keyposes=demand.keyposes / share)


def _met(demand: Demand) -> bool:
    try:
        trajectory = fit(demand).trajectory
    except PlanError:
        return False
    asked = keyposes_of(demand)
    error = np.abs(trajectory(asked.times) - asked.aims)
    return not (error > MISSED).any()


def _channels(demand: Demand, which: Ints) -> Demand:
    def of(values: Array) -> Array:
        return values[..., which]

    return replace(
        demand,
        wish=demand.wish.with_controls(of(demand.wish.controls)),
        low=of(demand.low),
        high=of(demand.high),
        speed=of(demand.speed),
        acceleration=of(demand.acceleration),
        jerk=of(demand.jerk),
    )
