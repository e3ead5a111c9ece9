"""Inside the limits by a convex programme over control points: onbeat's own method, ``qp``.

Not in the papers. Each channel for itself, the change d of its control points is the solution of

    minimise   Σ_frames (B d)² step + Σ_keyposes weight (the change there − what brings it inside its bounds)²
    subject to |Δ(c + d)| ≤ step · speed,  |Δ²(c + d)| ≤ step² · acceleration,  |Δ³(c + d)| ≤ step³ · jerk,
               low ≤ inner Bézier points of c + d ≤ high

The second differences are the acceleration's own corners and the third the jerk's steps; of the others the hull is
bounded, so that limits hold between samples as well. Where nothing is violated nothing is changed: programmes are
solved in windows about the violations, which are widened where their ends leave too little room. Cost grows with the
length of what has to be changed, and no faster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_matrix

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.quadratic import minimise
from onbeat.retime.bspline import Knots, basis
from onbeat.retime.demand import Answer, Demand, Progress, silent
from onbeat.retime.reach import keyposes_of
from onbeat.retime.windows import widened, windows

MARGIN = 1.2
"""Beats about a violation that may be changed at first, and by which a window grows where that is not enough."""
KEYPOSE, HOPELESS = 2000.0, 20.0
"""Beats of frames that one keypose weighs as much as; one that cannot be reached weighs less, for its neighbours'."""
TIGHTER = 1e-8
"""Taken off bounds, so that what the solver leaves of its tolerance is not past them."""
_PAIR, _BEND, _TWIST = np.array([-1.0, 1.0]), np.array([1.0, -2.0, 1.0]), np.array([-1.0, 3.0, -3.0, 1.0])
_INNER = (np.array([2.0, 1.0]) / 3, np.array([1.0, 2.0]) / 3)
_AT_KNOT = np.array([1.0, 4.0, 1.0]) / 6


@dataclass(frozen=True, eq=False)
class Rows:
    """Bounds on ``Σ_i shares_i c_{k+i}`` for every place k of a channel."""

    shares: Array
    lower: Array
    upper: Array


class Aims(NamedTuple):
    """Seconds (K,) of keyposes, by how much the channel has to change there, and what each weighs."""

    times: Times
    changes: Array
    weights: Array


def fit(demand: Demand, progress: Progress = silent) -> Answer:
    """The trajectory nearest to the wish that keeps position, velocity, acceleration and jerk.

    Raises
    ------
    PlanError
        If not even standing still keeps a channel's limits.
    """
    controls = demand.wish.controls.copy()
    asked = keyposes_of(demand)
    violated = demand.violated(controls) | _away(demand)
    margin = max(int(np.ceil(MARGIN * demand.beat / demand.wish.knots.step - 1e-6)), 3)
    for channel in np.flatnonzero(violated.any(axis=0)).tolist():
        progress(channel / demand.wish.channels)
        rows = rows_of(demand, channel)
        wanted, aims, feasible = (part[:, channel] for part in asked[1:])
        aims = Aims(asked.times, aims - wanted, demand.beat * np.where(feasible, KEYPOSE, HOPELESS))
        controls[:, channel] = _fitted(controls[:, channel], rows, violated[:, channel], margin, demand, aims, channel)
    progress(1.0)
    return Answer(demand.wish.with_controls(controls))


def _away(demand: Demand) -> np.ndarray:
    """(controls, n) true beside frames that are out of bounds."""
    return np.pad(demand.wish.samples != demand.target, ((1, 1), (0, 0)))


def rows_of(demand: Demand, channel: int) -> list[Rows]:
    """All bounds of a channel; those that are infinite are left out."""
    step, count = demand.wish.knots.step, len(demand.wish.controls)
    low, high = float(demand.low[channel]), float(demand.high[channel])
    out: list[Rows] = []
    if np.isfinite(low) or np.isfinite(high):
        gap = min(TIGHTER, (high - low) / 4)
        bounds = np.full(count - 1, low + gap), np.full(count - 1, high - gap)
        out += [Rows(shares, *bounds) for shares in _INNER]
    speed = demand.speed[:, channel] * step
    if np.isfinite(speed).any():
        speed = speed - np.minimum(TIGHTER, speed / 4)
        out.append(Rows(_PAIR, -speed, speed))
    for shares, most in ((_BEND, demand.acceleration[channel] * step**2), (_TWIST, demand.jerk[channel] * step**3)):
        if np.isfinite(most):
            most = np.full(count + 1 - len(shares), most - min(TIGHTER, most / 4))
            out.append(Rows(shares, -most, most))
    return out


def _fitted(
    controls: Array,
    rows: Sequence[Rows],
    violated: np.ndarray,
    margin: int,
    demand: Demand,
    aims: Aims,
    channel: int,
) -> Array:
    """One channel's control points inside its bounds."""
    spans, done, out = windows(violated, margin), 0, controls.copy()
    while done < len(spans):
        start, end = spans[done]
        change = solve(controls, start, end, rows, demand.wish.knots, aims)
        if change is not None:
            out[start:end] = controls[start:end] + change
            done += 1
        elif end - start == len(controls):
            raise PlanError(
                f"channel {channel}: no trajectory keeps its limits; look for bounds that exclude each other"
            )
        else:
            spans = widened(spans, done, margin, len(controls))
            done = next(k for k, (a, b) in enumerate(spans) if a <= start < b)
            out[slice(*spans[done])] = controls[slice(*spans[done])]
    return out


def solve(
    controls: Array, start: int, end: int, rows: Sequence[Rows], knots: Knots, aims: Aims, resting: bool = False
) -> Array | None:
    """The least change (end − start,) of the control points start … end that keeps all rows; None where there is none.

    Control points outside stay as they are, and with them position, velocity and acceleration at the window's ends.
    ``resting`` makes the last three the same, so that all is at rest behind them.
    """
    cost, linear = _cost(start, end, knots, aims)
    lower, upper = _bounds(controls, start, end, rows)
    matrix = _matrix(start, end, len(controls), tuple(tuple(row.shares.tolist()) for row in rows))
    equal = None
    if resting:
        places = np.array([-3, -2, -2, -1]) + (end - start)
        last = csc_matrix(([1.0, -1.0, 1.0, -1.0], ([0, 0, 1, 1], places)), shape=(2, end - start))
        equal = (last, -(last @ controls[start:end]))
    # A window that cannot be widened any more is worth more patience.
    most = 250 if end - start < len(controls) else 2500
    return minimise(cost, linear, matrix, (lower, upper), equal=equal, tolerance=TIGHTER / 2, gap=1e-7, iterations=most)


def _cost(start: int, end: int, knots: Knots, aims: Aims) -> tuple[csc_matrix, Array]:
    """Quadratic (upper triangle) and linear cost of a change of the control points start … end."""
    count = end - start
    bands = np.zeros((4, count))  # bands[q, j] stands at (j − q, j)
    for q in range(3):
        for i in range(q, 3):
            # Knot k is under control points k, k + 1, k + 2.
            first, last = max(i - start, 0), min(knots.intervals + 1 + i - start, count)
            bands[q, max(first, q) : last] += _AT_KNOT[i] * _AT_KNOT[i - q] * knots.step
    linear = np.zeros(count)
    interval, part = knots.places(aims.times)
    for place, values, aim, weight in zip(interval.tolist(), basis(part), aims.changes, aims.weights, strict=True):
        for a in range(4):
            j = place + a - start
            if not 0 <= j < count:
                continue
            linear[j] -= weight * aim * values[a]
            for q in range(min(a, j) + 1):
                bands[q, j] += weight * values[a] * values[a - q]
    return _banded(bands), linear


def _banded(bands: Array) -> csc_matrix:
    """The upper triangle whose q-th diagonal above the main one ends in each column at ``bands[q]``."""
    width, count = bands.shape
    columns = np.arange(count)
    kept = columns[:, None] >= np.arange(width)[::-1]
    indices = (columns[:, None] - np.arange(width)[::-1])[kept]
    starts = np.concatenate(([0], np.cumsum(kept.sum(axis=1))))
    return csc_matrix((bands[::-1].T[kept], indices, starts), shape=(count, count))


def _span(start: int, end: int, count: int, width: int) -> tuple[int, int]:
    """The rows of so many shares that touch control points start … end."""
    return max(start - width + 1, 0), min(end, count - width + 1)


def _bounds(controls: Array, start: int, end: int, rows: Sequence[Rows]) -> tuple[Array, Array]:
    """What is left of the bounds where the present control points are."""
    lower, upper = list[Array](), list[Array]()
    for row in rows:
        first, last = _span(start, end, len(controls), len(row.shares))
        now = np.convolve(controls[first : last + len(row.shares) - 1], row.shares[::-1], mode="valid")
        lower.append(row.lower[first:last] - now)
        upper.append(row.upper[first:last] - now)
    return np.concatenate(lower), np.concatenate(upper)


@lru_cache(maxsize=64)
def _matrix(start: int, end: int, count: int, kinds: tuple[tuple[float, ...], ...]) -> csc_matrix:
    """The rows that touch control points start … end, as a matrix on these."""
    columns = np.arange(start, end)
    indices, values, base = list[Array](), list[Array](), 0
    for shares in kinds:
        first, last = _span(start, end, count, len(shares))
        for i in reversed(range(len(shares))):
            row = columns - i
            indices.append(np.where((row >= first) & (row < last), row - first + base, -1))
            values.append(np.full(len(columns), shares[i]))
        base += last - first
    table, kept = np.stack(indices, axis=1), np.stack(indices, axis=1) >= 0
    starts = np.concatenate(([0], np.cumsum(kept.sum(axis=1))))
    return csc_matrix((np.stack(values, axis=1)[kept], table[kept], starts), shape=(base, end - start))
