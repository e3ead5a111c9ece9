"""A dance on a robot's upper body in another time: the method of 2007, ours, and what others do, on the same wish."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, sosfiltfilt

from onbeat._shapes import Array, Bools, Ints
from onbeat.errors import PlanError
from onbeat.limits.named import robot_limits
from onbeat.reproduce.p2.takes import Solo
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Demand, silent
from onbeat.retime.layers2007 import literal
from onbeat.retime.lock import TimeMap
from onbeat.retime.measures import Measures, measure
from onbeat.retime.pollard2002 import follow
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import Table

ROBOT = "hrp4c"
"""Of the robots whose limits are public the nearest to HRP-2: by the same makers, and its speed binds."""
SPEEDS = (1.0, 1.2)
"""Of the paper's experiments."""
PUBLISHED, PRINTED, OURS = "layers2007", "as printed", "qp"
METHODS = (PUBLISHED, OURS, "pollard2002", "uniform")
"""Names of ``onbeat.retime.methods``, as they are drawn."""
FINE = 4.0
"""Hz above which a joint's velocity is detail."""
SLACK = 100.0
"""1/s², a stiffness of Pollard's filter beside the one that onbeat found best: the paper does not tell its own."""
APART = 0.5
"""Seconds from a limit that is past within which a method may have to change something."""


@dataclass(frozen=True, eq=False)
class Scaled:
    """What a method makes of a wish.

    Parameters
    ----------
    method : its name.
    measures : of its trajectory, on the channels of the upper body.
    detail : share of the fine velocity away from limits that is as in the wish, 0…1; NaN where there is none.
    done : share of the dance that is over when the music is.
    result : the whole of it; None for the method as printed.
    """

    method: str
    measures: Measures
    detail: float
    done: float
    result: Retimed | None


@dataclass(frozen=True, eq=False)
class Asked:
    """A wish, and what all methods make of it.

    Parameters
    ----------
    speed : how much faster than it was danced.
    past : how many of the ``joints`` the wish takes past a limit.
    fastest : the wish's highest velocity, in parts of the limit.
    slack : the detail that Pollard's filter keeps with a stiffness of ``SLACK``.
    scaled : by method; without the one as printed where that fails.
    """

    speed: float
    joints: int
    past: int
    fastest: float
    slack: float
    scaled: Mapping[str, Scaled]


def ask(table: Table, solo: Solo, speed: float) -> Asked:
    """All methods on a wish at a speed, inside the robot's limits."""
    limits, warp = robot_limits(ROBOT), TimeMap.steady(speed)
    found = {method: retime(table, warp, limits, solo.beats, solo.keyposes, method=method) for method in METHODS}
    demand = found[OURS].demand
    scaled = {method: _scaled(method, demand, one.answer.trajectory, one) for method, one in found.items()}
    with suppress(PlanError):  # where 0 rad is out of a joint's range
        scaled[PRINTED] = _scaled(PRINTED, demand, literal(demand, silent).trajectory, None)
    past = np.asarray(demand.violated(demand.wish.controls, derivatives=False).any(axis=0))
    fastest = float((np.abs(demand.wish.differences(1)) / demand.speed).max())
    slack = detail_kept(demand, follow(demand, stiffness=SLACK).trajectory)
    return Asked(speed, len(past), int(past.sum()), fastest, slack, scaled)


def _scaled(method: str, demand: Demand, trajectory: Spline, result: Retimed | None) -> Scaled:
    done = 1.0
    if method == "uniform":
        done = 1.0 / max(1.0, float((np.abs(demand.wish.differences(1)) / demand.speed).max()))
    return Scaled(method, measure(demand, trajectory), detail_kept(demand, trajectory), done, result)


def detail_kept(demand: Demand, trajectory: Spline) -> float:
    """Share of the wish's fine velocity that a trajectory has, where the wish is away from all its limits.

    One minus the energy of the difference above ``FINE`` by the wish's, over the joints that are past a limit at some
    time and the moments ``APART`` from it.
    """
    past = demand.violated(demand.wish.controls, derivatives=False)
    step, busy = demand.wish.knots.step, np.flatnonzero(np.asarray(past.any(axis=0)))
    if not len(busy) or 2 * FINE * step >= 1:
        return float("nan")
    quiet = ~np.stack([_widened(past[1:-1, channel], round(APART / step)) for channel in busy], axis=1)
    if not quiet.any():
        return float("nan")
    was, now = (_fine(curve, demand, busy) for curve in (demand.wish, trajectory))
    energy = float(np.square(was[quiet]).sum())
    return 1.0 - float(np.square((now - was)[quiet]).sum()) / energy if energy > 0 else float("nan")


def _fine(curve: Spline, demand: Demand, channels: Ints) -> Array:
    high = butter(4, FINE, "high", fs=1 / demand.wish.knots.step, output="sos")
    return np.asarray(sosfiltfilt(high, curve(demand.wish.knots.times, 1)[:, channels], axis=0))


def _widened(past: Bools, margin: int) -> Bools:
    return np.convolve(past, np.ones(2 * margin + 1), "same") > 0
