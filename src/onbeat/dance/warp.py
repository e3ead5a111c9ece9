"""A small monotone time warp that puts stops on their beats, inside rate and speed limits.

The warp τ takes dance time to plan time. It is piecewise linear on knots ``KNOT`` seconds apart, and is the solution of
a quadratic programme over its values at the knots:

    minimise   Σ_pairs (τ(b) − p)² / σ²  +  Σ_k (rate_{k+1} − rate_k)² · smooth  +  Σ_k (rate_k − 1)² · ease
    subject to τ(0) = 0, τ(T) = T and low_k ≤ rate_k ≤ high_k

where a stop at plan time p is to be seen at its beat b. Rate bounds hold everywhere, because the rate is constant
between knots. (Monotone cubic interpolation of the pairs, the usual way, does not keep them.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, eye_array

from onbeat._shapes import Array, Times
from onbeat.dance.plan import DancePlan
from onbeat.errors import PlanError
from onbeat.quadratic import minimise

SLOWEST, FASTEST = 0.75, 1.35
"""Playback rates between which the dance stays, the plan's own rates included."""
SPEED = 1.08
"""How much faster than in its plan the fastest hand may become."""
KNOT = 1 / 15
REACH = 0.14
"""Seconds from which a stop may be drawn to a beat."""
SETTLED = 0.045
"""Seconds within which a stop is on its beat; pairs that cannot come so near are given up for the others' sake."""
SIGMA = 0.015  # s; how exactly stops are wanted on beats, against the smoothness of the rate
SMOOTH = 2.0  # [1]; of the change of rate from knot to knot
EASE = 0.05  # [1]; of the rate's difference from 1


@dataclass(frozen=True)
class Warp:
    """A monotone map from dance time to plan time.

    Examples
    --------
    >>> slow = Warp(np.array([0.0, 2.0]), np.array([0.0, 2.0]))
    >>> float(slow(np.array([0.5]))[0]), float(slow.rates[0])
    (0.5, 1.0)
    """

    knots: Times
    values: Times

    def __call__(self, times: Times) -> Times:
        """Plan times at dance times."""
        return np.interp(times, self.knots, self.values)

    def inverse(self, times: Times) -> Times:
        """Dance times at plan times."""
        return np.interp(times, self.values, self.knots)

    @property
    def rates(self) -> Array:
        """Plan seconds a dance second, between knots."""
        return np.diff(self.values) / np.diff(self.knots)


def pair_stops(stops: Times, beats: Times, reach: float | None = None) -> list[tuple[int, int]]:
    """Pairs (stop, beat) in order, one to one, within ``reach`` seconds: as many and as near as can be.

    Maximises ``Σ (1 − (d / reach)²)`` over order-preserving pairings, by dynamic programming over neighbours.

    Examples
    --------
    >>> pair_stops(np.array([0.4, 0.55, 1.1]), np.array([0.5, 1.0, 1.5]))
    [(1, 0), (2, 1)]
    """
    reach = REACH if reach is None else reach
    n, m = len(stops), len(beats)
    best = np.zeros((n + 1, m + 1))
    gain = np.maximum(1 - ((stops[:, None] - beats[None, :]) / reach) ** 2, 0) if n and m else np.zeros((n, m))
    for i in range(1, n + 1):
        best[i] = best[i - 1]
        near = np.flatnonzero(gain[i - 1])
        for j in near.tolist():
            best[i, j + 1] = max(best[i, j + 1], best[i - 1, j] + gain[i - 1, j])
        best[i] = np.maximum.accumulate(best[i])
    pairs: list[tuple[int, int]] = []
    i, j = n, m
    while i and j:
        if best[i, j] == best[i - 1, j]:
            i -= 1
        elif best[i, j] == best[i, j - 1]:
            j -= 1
        else:
            i, j = i - 1, j - 1
            pairs.append((i, j))
    return pairs[::-1]


def fit_warp(plan: DancePlan, stops: Times, beats: Times, speed_times: Times, speeds: Array, rounds: int = 4) -> Warp:
    """The warp that brings stops (plan seconds) onto beats (dance seconds).

    Parameters
    ----------
    plan : for its duration and the playback rates of its moves.
    stops : seconds at which the unwarped dance stops.
    beats : seconds at which it should.
    speed_times, speeds : (N,) seconds and m/s, the faster hand of the unwarped dance.
    rounds : times the pairs are made again from what the last warp could reach.

    Raises
    ------
    PlanError
        If the programme has no solution: a move's rate is itself outside the bounds.
    """
    count = max(2, round(plan.duration / KNOT) + 1)
    knots = np.linspace(0.0, plan.duration, count)
    low, high = _bounds(plan, knots, speed_times, speeds)
    warp = Warp(knots, knots)
    dropped: set[tuple[int, int]] = set()
    for _ in range(rounds):
        shown = warp.inverse(stops)
        pairs = [pair for pair in pair_stops(shown, beats) if pair not in dropped]
        if not pairs:
            break
        chosen = np.array(pairs)
        warp = _solve(knots, low, high, beats[chosen[:, 1]], stops[chosen[:, 0]])
        missed = np.abs(warp(beats[chosen[:, 1]]) - stops[chosen[:, 0]]) > SETTLED
        dropped.update(pair for pair, late in zip(pairs, missed.tolist(), strict=True) if late)
    return warp


def _bounds(plan: DancePlan, knots: Times, speed_times: Times, speeds: Array) -> tuple[Array, Array]:
    """(K−1,) lowest and highest rate of each knot interval."""
    starts = np.array([move.at_s for move in plan.moves])
    rates = np.array([move.rate for move in plan.moves])
    # All that may be shown between two knots: the warp moves nothing by more than REACH.
    early, late = knots[:-1] - REACH, knots[1:] + REACH
    first = np.maximum(np.searchsorted(starts, early, side="right") - 1, 0)
    last = np.searchsorted(starts, late, side="right")
    low = np.array([SLOWEST / rates[a:b].min() for a, b in zip(first.tolist(), last.tolist(), strict=True)])
    high = np.array([FASTEST / rates[a:b].max() for a, b in zip(first.tolist(), last.tolist(), strict=True)])
    if len(speeds):
        begin = np.maximum(np.searchsorted(speed_times, early) - 1, 0).tolist()
        end = np.maximum(np.searchsorted(speed_times, late) + 1, np.array(begin) + 1).tolist()
        fastest = np.array([speeds[a:b].max(initial=1e-3) for a, b in zip(begin, end, strict=True)])
        high = np.minimum(high, SPEED * float(np.max(speeds)) / fastest)
    return np.minimum(low, 1.0), np.maximum(high, 1.0)


def _solve(knots: Times, low: Array, high: Array, beats: Times, stops: Times) -> Warp:
    count, step = len(knots), float(knots[1] - knots[0])
    rate = (eye_array(count - 1, count, k=1) - eye_array(count - 1, count)) / step
    bend = (eye_array(count - 2, count - 1, k=1) - eye_array(count - 2, count - 1)) @ rate
    place = np.clip(beats / step, 0, count - 1 - 1e-9)
    left = place.astype(np.int64)
    rows = np.arange(len(beats))
    part = place - left
    at = csc_matrix(
        (np.concatenate((1 - part, part)), (np.tile(rows, 2), np.concatenate((left, left + 1)))),
        shape=(len(beats), count),
    )
    square = at.T @ at / SIGMA**2 + SMOOTH * bend.T @ bend + EASE * rate.T @ rate
    linear = -(at.T @ stops) / SIGMA**2 - EASE * (rate.T @ np.ones(count - 1))
    ends = csc_matrix(([1.0, 1.0], ([0, 1], [0, count - 1])), shape=(2, count))
    values = minimise(
        square,
        np.asarray(linear),
        rate,
        (low, high),
        equal=(ends, np.array([0.0, knots[-1]])),
        box=(knots - REACH, knots + REACH),
        creeping=True,  # the cost of a long dance is too great for the last digits of its gap
    )
    if values is None:
        raise PlanError("no time warp keeps its limits; play the plan as it is with --no-warp")
    rates = np.clip(np.diff(values) / step, low, high)  # what the solver leaves of its tolerance
    values = np.concatenate(([0.0], np.cumsum(rates * step)))
    return Warp(knots, values + (knots[-1] - values[-1]) * knots / knots[-1])
