"""A small monotone time warp that puts stops on their beats, inside rate and speed limits.

The warp τ takes dance time to plan time. It is piecewise linear on knots ``KNOT`` seconds apart, and is the solution of
a quadratic programme over its values at the knots:

    minimise   Σ_pairs (τ(b) − p)² / σ²  +  Σ_k (rate_{k+1} − rate_k)² · smooth  +  Σ_k (rate_k − 1)² · ease
    subject to τ(0) = 0, τ(T) = T and low_k ≤ rate_k ≤ high_k

where a stop at plan time p is to be seen at its beat b. Rate bounds hold everywhere, because the rate is constant
between knots. (Monotone cubic interpolation of the pairs, the usual way, does not keep them.)
"""

from __future__ import annotations

from collections.abc import Sequence
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
LOOSE = 0.05
"""By how much bounds are wider than rates that are held, for the solver's sake."""
WIDER = (1.0, 1.1, 1.25, 1.5, 2.0)
"""How much further than usual rates may go between parts that are held, tried in this order."""
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


@dataclass(frozen=True, eq=False)
class Held:
    """A part of the dance whose time is to be bent as it was.

    Parameters
    ----------
    begin, end : seconds of the dance.
    warp : dance time to plan time there.
    """

    begin: float
    end: float
    warp: Warp


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


def fit_warp(
    plan: DancePlan,
    stops: Times,
    beats: Times,
    speed_times: Times,
    speeds: Array,
    rounds: int = 4,
    held: Sequence[Held] = (),
) -> Warp:
    """The warp that brings stops (plan seconds) onto beats (dance seconds).

    Parameters
    ----------
    plan : for its duration and the playback rates of its moves.
    stops : seconds at which the unwarped dance stops.
    beats : seconds at which it should.
    speed_times, speeds : (N,) seconds and m/s, the faster hand of the unwarped dance.
    rounds : times the pairs are made again from what the last warp could reach.
    held : parts that are warped as they were; others must then bend more where they cannot reach them otherwise.

    Raises
    ------
    PlanError
        If the programme has no solution: a move's rate is itself outside the bounds.
    """
    count = max(2, round(plan.duration / KNOT) + 1)
    knots = np.linspace(0.0, plan.duration, count)
    low, high = _bounds(plan, knots, speed_times, speeds)
    warp, fixed = Warp(knots, knots), _fixed(knots, held)
    if held:
        low, high = _reaching(knots, low, high, fixed)
    dropped: set[tuple[int, int]] = set()
    for _ in range(rounds):
        shown = warp.inverse(stops)
        pairs = [pair for pair in pair_stops(shown, beats) if pair not in dropped]
        if not pairs and not held:
            break
        chosen = np.array(pairs, np.int64).reshape(-1, 2)
        warp = _solve(knots, low, high, beats[chosen[:, 1]], stops[chosen[:, 0]], fixed)
        missed = np.abs(warp(beats[chosen[:, 1]]) - stops[chosen[:, 0]]) > SETTLED
        dropped.update(pair for pair, late in zip(pairs, missed.tolist(), strict=True) if late)
    return spliced(warp, held)


def spliced(warp: Warp, held: Sequence[Held]) -> Warp:
    """The warp with its held parts to the knot, for theirs may lie elsewhere."""
    knots, values = warp.knots, warp.values
    for part in held:
        own = part.warp.knots[(part.warp.knots > part.begin) & (part.warp.knots < part.end)]
        own = np.concatenate(([part.begin], own, [part.end]))
        before, after = knots < part.begin - 1e-9, knots > part.end + 1e-9
        values = np.concatenate((values[before], part.warp(own), values[after]))
        knots = np.concatenate((knots[before], own, knots[after]))
    return Warp(knots, values)


def _fixed(knots: Times, held: Sequence[Held]) -> Array:
    """(K,) the plan time of each knot in a held part or beside it, NaN of all others."""
    fixed = np.full(len(knots), np.nan)
    step = knots[1] - knots[0]
    for part in held:
        inside = (knots > part.begin - step) & (knots < part.end + step) & (knots <= part.warp.knots[-1])
        fixed[inside] = part.warp(knots[inside])
    fixed[0], fixed[-1] = 0.0, knots[-1]
    return fixed


def _reaching(knots: Times, low: Array, high: Array, fixed: Array) -> tuple[Array, Array]:
    """The bounds of rates, widened where they are held and, if need be, as far as the parts between need to be."""
    rates = np.diff(fixed) / np.diff(knots)
    inside = np.isfinite(rates)
    for wider in WIDER:
        least = np.where(inside, np.fmin(low, rates) - LOOSE, low / wider)
        most = np.where(inside, np.fmax(high, rates) + LOOSE, high * wider)
        if _reaches(knots, least, most, fixed):
            return least, most
    raise PlanError("no time warp goes from one kept stretch to the next; keep stretches that are farther apart")


def _reaches(knots: Times, low: Array, high: Array, fixed: Array) -> bool:
    """Whether a warp with rates between ``low`` and ``high`` can pass through all that is fixed."""
    least = most = 0.0
    steps = np.diff(knots).tolist()
    for k, (step, slow, fast) in enumerate(zip(steps, low.tolist(), high.tolist(), strict=True), 1):
        least, most = max(least + step * slow, knots[k] - REACH), min(most + step * fast, knots[k] + REACH)
        if least > most + 1e-9 or (np.isfinite(fixed[k]) and not least - 1e-6 <= fixed[k] <= most + 1e-6):
            return False
        if np.isfinite(fixed[k]):
            least = most = float(fixed[k])
    return True


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


def _solve(knots: Times, low: Array, high: Array, beats: Times, stops: Times, fixed: Array) -> Warp:
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
    settled = np.flatnonzero(np.isfinite(fixed))
    there = csc_matrix((np.ones(len(settled)), (np.arange(len(settled)), settled)), shape=(len(settled), count))
    reach = np.full(count, REACH)
    reach[settled[1:-1]] *= 2  # what is settled needs no bounds
    values = minimise(
        square,
        np.asarray(linear),
        rate,
        (low, high),
        equal=(there, fixed[settled]),
        box=(knots - reach, knots + reach),
        creeping=True,  # the cost of a long dance is too great for the last digits of its gap
    )
    if values is None:
        raise PlanError("no time warp keeps its limits; play the plan as it is with --no-warp")
    rates = np.clip(np.diff(values) / step, low, high)  # what the solver leaves of its tolerance
    values = np.concatenate(([0.0], np.cumsum(rates * step)))
    values = values + (knots[-1] - values[-1]) * knots / knots[-1]
    values[settled[1:-1]] = fixed[settled[1:-1]]
    return Warp(knots, values)
