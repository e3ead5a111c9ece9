"""How well a trajectory does what was demanded: limits between samples, error, keyposes, and how rough it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Times, frozen
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Demand
from onbeat.retime.reach import keyposes_of

RATE = 1000.0
"""Hz at which limits are looked at."""
TOLERANCE = 1e-6
"""rad and rad/s past a limit that do not count."""
PLATEAU = 0.995
"""Share of the highest velocity from which on a joint runs at it."""


@dataclass(frozen=True, eq=False)
class Measures:
    """Figures of one trajectory, a channel each (n,) where nothing else is said.

    Parameters
    ----------
    position_excess, velocity_excess : rad and rad/s by which the limits are past at most, 0 where they are kept.
    position_share, velocity_share : shares of the time, 0 to 1.
    rms : rad, from the wish.
    peak_acceleration : rad/s².
    plateaus : share of the time at the highest velocity.
    keyposes : (K,) their seconds.
    keypose_errors : (K, n) rad, from the wish, or from the bound where that is past it.
    feasible : (K, n) whether the keypose is inside the bounds and could be reached from its neighbours at full speed.
    """

    position_excess: Array
    velocity_excess: Array
    position_share: Array
    velocity_share: Array
    rms: Array
    peak_acceleration: Array
    plateaus: Array
    keyposes: Times
    keypose_errors: Array
    feasible: Bools

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            object.__setattr__(self, name, frozen(getattr(self, name), bool if name == "feasible" else np.float64))

    @property
    def violations(self) -> tuple[int, int]:
        """How many channels are ever past a limit of position, and of velocity."""
        return tuple(int((e > TOLERANCE).sum()) for e in (self.position_excess, self.velocity_excess))  # type: ignore[return-value]

    @property
    def worst_keypose(self) -> float:
        """rad, the largest error at a keypose that is feasible; 0 where there is none."""
        return float(np.max(self.keypose_errors, where=self.feasible, initial=0.0))


def measure(demand: Demand, trajectory: Spline) -> Measures:
    """The figures of a trajectory, looked at a thousand times a second between its knots.

    Examples
    --------
    >>> from onbeat.retime.lock import TimeMap
    >>> wish = Spline.through(np.linspace(0, 1, 31)[:, None], 30)
    >>> free = np.array([np.inf])
    >>> slow = Demand(wish, -free, free, np.array([0.8]), free, free, np.zeros(0), TimeMap.steady(2.0))
    >>> float(measure(slow, wish).velocity_excess[0].round(6))
    0.2
    """
    knots = demand.wish.knots
    times = knots.start + np.arange(int(np.floor((knots.end - knots.start) * RATE)) + 1) / RATE
    place, velocity = trajectory(times), np.abs(trajectory(times, 1))
    interval = knots.places(times)[0] + 1
    # A knot interval lies between two pairs of control points; where their bounds differ the wider one is its own.
    bound = np.maximum(
        demand.speed[interval],
        np.maximum(demand.speed[interval - 1], demand.speed[np.minimum(interval + 1, len(demand.speed) - 1)]),
    )
    past = np.maximum(np.maximum(demand.low - place, place - demand.high), 0.0)
    fast = np.maximum(velocity - bound, 0.0)
    asked = keyposes_of(demand)
    return Measures(
        past.max(axis=0),
        fast.max(axis=0),
        (past > TOLERANCE).mean(axis=0),
        (fast > TOLERANCE).mean(axis=0),
        np.sqrt(np.square(trajectory.samples - demand.wish.samples).mean(axis=0)),
        np.abs(trajectory.differences(2)).max(axis=0),
        (velocity >= PLATEAU * bound).mean(axis=0),
        asked.times,
        np.abs(trajectory(asked.times) - asked.aims),
        asked.feasible,
    )
