"""Method ``qp`` as it goes: two seconds ahead, again and again, and never past a limit.

A plan is a spline over the next seconds whose first three control points are those that are being danced, so that
position, velocity and acceleration go on without a step. Wherever the wish itself keeps the limits from there, it is
the plan. Elsewhere the programme of ``controlpoints.py`` is solved with one more demand: at its end the channel is at
rest. So there is always a way on: what is left of the last plan, and then standing still. Should a new wish allow none,
the old plan is danced to its end; a limit is past never.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.retime.bspline import Knots, Spline
from onbeat.retime.controlpoints import HOPELESS, KEYPOSE, Aims, rows_of, solve
from onbeat.retime.demand import Demand
from onbeat.retime.lock import TimeMap
from onbeat.retime.reach import keyposes_of

AHEAD = 2.0
"""Seconds."""
STEP = 0.02
"""Seconds between knots."""
FRESH = 0.5
"""Share of the horizon after which a plan is made again even if what is wished has not changed."""
_STILL = TimeMap.steady(1.0)


class Horizon:
    """Channels that are planned a few seconds ahead.

    Parameters
    ----------
    low, high, speed, acceleration, jerk : (n,) bounds, as in ``Demand``.
    start : (n,) values at which all rest at second ``time``; inside the bounds.
    time : seconds.
    ahead, step : seconds of a plan, and between its knots.

    Examples
    --------
    >>> free = np.array([np.inf])
    >>> arm = Horizon(-free, free, np.array([1.0]), np.array([10.0]), free, np.zeros(1))
    >>> for _ in range(20):
    ...     _ = arm.plan(lambda times: np.full((len(times), 1), 0.5))
    ...     arm.advance(5)
    >>> arm.values(np.array([2.0])).round(4).tolist()
    [[0.5]]
    """

    def __init__(
        self,
        low: Array,
        high: Array,
        speed: Array,
        acceleration: Array,
        jerk: Array,
        start: Array,
        time: float = 0.0,
        ahead: float = AHEAD,
        step: float = STEP,
    ) -> None:
        self.bounds = (low, high, speed, acceleration, jerk)
        self.knots = Knots(time, step, max(round(ahead / step), 8))
        self.controls = np.tile(np.clip(start, low, high), (self.knots.controls, 1))
        self._age = np.full(len(self.controls[0]), self.knots.intervals)

    def values(self, times: Times) -> Array:
        """(N, n) of the plan at times within it."""
        return Spline(self.knots, self.controls)(times)

    def plan(self, wish: Callable[[Times], Array], keyposes: Times | None = None, changed: bool = True) -> Bools:
        """Plan anew; true (n,) where a programme was solved.

        Parameters
        ----------
        wish : values (N, n) that are wished at times (N,).
        keyposes : seconds at which the wish is to be met.
        changed : whether the wish is another one than at the last plan, where both tell of the same time.
        """
        wanted = Spline.through(wish(self.knots.times), 1 / self.knots.step, self.knots.start)
        ahead = np.concatenate((self.controls[:3], wanted.controls[3:]))
        demand = Demand(Spline(self.knots, ahead), *self.bounds, np.zeros(0) if keyposes is None else keyposes, _STILL)
        busy = demand.violated(ahead)[2:].any(axis=0) | ~self._can_rest(ahead)
        self.controls[:, ~busy] = ahead[:, ~busy]
        self._age[~busy] = self.knots.intervals
        again = busy & (changed | (self._age >= FRESH * self.knots.intervals))
        for channel in np.flatnonzero(again).tolist():
            self._solve(demand, channel)
        return again

    def _solve(self, demand: Demand, channel: int) -> None:
        wanted, aims, feasible = (part[:, channel] for part in keyposes_of(demand)[1:])
        asked = Aims(keyposes_of(demand).times, aims - wanted, np.where(feasible, KEYPOSE, HOPELESS))
        rows = rows_of(demand, channel)
        now = demand.wish.controls[:, channel]
        change = solve(now, 3, len(now), rows, self.knots, asked, resting=True)
        if change is not None:
            self.controls[3:, channel] = now[3:] + change
            self._age[channel] = 0

    def _can_rest(self, controls: Array) -> Bools:
        """Whether each channel can be brought to rest behind the last control points without leaving its bounds."""
        low, high, _, acceleration, _ = self.bounds
        slower = acceleration * self.knots.step**2
        run = controls[-1] - controls[-2]
        steps = np.where(np.isfinite(slower), np.floor(np.abs(run) / slower), 0.0)
        with np.errstate(invalid="ignore"):
            way = np.where(steps > 0, steps * np.abs(run) - slower * steps * (steps + 1) / 2, 0.0)
        end = controls[-1] + np.sign(run) * np.maximum(way, 0.0)
        return (end >= low) & (end <= high)

    def advance(self, knots: int) -> None:
        """Let time go on by so many knots; what is behind the plan is braking, then rest."""
        slower = self.bounds[3] * self.knots.step**2
        tail = list[Array]()
        last, run = self.controls[-1], self.controls[-1] - self.controls[-2]
        for _ in range(knots):
            run = np.sign(run) * np.maximum(np.abs(run) - slower, 0.0)
            last = last + run
            tail.append(last)
        self.controls = np.concatenate((self.controls[knots:], np.stack(tail)))
        self.knots = Knots(self.knots.start + knots * self.knots.step, self.knots.step, self.knots.intervals)
        self._age += knots
