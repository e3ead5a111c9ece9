"""Beat k at beat k: a smooth map from the music's time to the dance's own.

The map is a cubic B-spline on knots a quarter of a beat apart, the smoothest that is on every beat:

    minimise   Σ (third differences of the control points / step)² + Σ_beats (what the map misses)²
    subject to |map(music beat k) − dance beat k| ≤ a third of a frame,  rate ≥ a tenth of the mean

so that where the tempo is steady it is exactly linear, and where it changes speed and acceleration of the dance do not
jump. (Straight lines from beat to beat are on the beats too, but kick every joint on each of them.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.quadratic import minimise
from onbeat.retime.bspline import Knots, Spline, differences

TOLERANCE = 0.004
"""Seconds of the music by which a beat may be missed for smoothness' sake."""
SLOWEST = 0.1
"""The least rate of the map, as a share of its mean rate."""
DENSITY = 4
"""Knots a beat."""
NEAREST = 1e-3
"""Seconds, or beats, that beats are apart at least."""
MOST_KNOTS = 200_000
"""Of a map: fourteen hours at an even pulse."""
FARTHEST = 1e9
"""Seconds."""
BEYOND = 4
"""Beats by which the map goes on at either end, at the last rate; past them it is linear."""


@dataclass(frozen=True, eq=False)
class TimeMap:
    """A rising smooth map of seconds to seconds (or to beats), linear past its ends.

    Examples
    --------
    >>> faster = TimeMap.steady(1.2)
    >>> faster(np.array([0.5, 1.0])).round(6).tolist(), faster.inverse(np.array([1.2])).round(6).tolist()
    ([0.6, 1.2], [1.0])
    """

    spline: Spline

    @classmethod
    def steady(cls, rate: float, at: float = 0.0) -> TimeMap:
        """The map of a constant rate that takes 0 to ``at``; a rate that is not above 0 is a ``PlanError``."""
        if not 0 < rate < np.inf:
            raise PlanError(f"a rate of {rate}; a number above 0 is needed")
        ends = np.array([[at], [at + rate]])
        return cls(Spline.through(ends, 1.0))

    def __call__(self, times: Times, derivative: int = 0) -> Array:
        """Values (N,), or derivatives, at times (N,)."""
        times = np.asarray(times, dtype=np.float64)
        inside = np.clip(times, self.spline.knots.start, self.spline.knots.end)
        if derivative == 0:
            return self.spline(inside)[:, 0] + self.spline(inside, 1)[:, 0] * (times - inside)
        out = self.spline(inside, derivative)[:, 0]
        return out if derivative == 1 else np.where(times == inside, out, 0.0)

    def inverse(self, values: Times) -> Array:
        """The times (N,) at which the map has these values, by Newton's steps from the nearest knots."""
        values = np.asarray(values, dtype=np.float64)
        if not np.isfinite(values).all():
            raise PlanError(f"time {int(np.argmin(np.isfinite(values)))} is not a number")
        knots = self.spline.knots.times
        at = self(knots)
        times = np.interp(values, at, knots)
        for _ in range(20):
            times = times - (self(times) - values) / np.maximum(self(times, 1), 1e-9)
        return times


def lock(music: Times, dance: Times, tolerance: float = TOLERANCE) -> TimeMap:
    """The smoothest map that takes each music beat (K,) to the dance's beat (K,) of the same place; seconds.

    Raises
    ------
    PlanError
        If there are fewer than two beats or not as many of both, if they do not rise, or if no smooth map meets them.

    Examples
    --------
    >>> beats = np.arange(8) * 0.5
    >>> faster = lock(beats / 1.2, beats)
    >>> faster(np.array([0.5, 1.0])).round(6).tolist()
    [0.6, 1.2]
    """
    music, dance = np.asarray(music, dtype=np.float64), np.asarray(dance, dtype=np.float64)
    _check(music, dance)
    music, dance = _extended(music), _extended(dance)
    step = float(np.median(np.diff(music))) / DENSITY
    if music[-1] - music[0] > MOST_KNOTS * step:
        raise PlanError(
            f"beats of the music are {step * DENSITY:.3g} s apart on the whole, but go on for "
            f"{music[-1] - music[0]:.3g} s; look for beats that are missing, or are there twice"
        )
    knots = Knots(float(music[0]), step, int(np.ceil((music[-1] - music[0]) / step)))
    rate = (dance[-1] - dance[0]) / (music[-1] - music[0])
    rows, lower, upper = _constraints(knots, music, dance, rate, tolerance)
    count = knots.controls
    bend, on_beats = differences(count, 3), knots.design(music)
    # The straight line is taken out: what is left is small, and nought where the tempo is steady.
    line = dance[0] + rate * step * (np.arange(count) - 1.0)
    shift = rows @ line
    cost = bend.T @ bend / step**2 + on_beats.T @ on_beats
    pull = on_beats.T @ (on_beats @ line - dance)
    found = minimise(cost, pull, rows, (lower - shift, upper - shift), tolerance=1e-10)
    if found is None:
        raise PlanError("no smooth map takes these beats to each other; look for a beat too many or too few")
    return TimeMap(Spline(knots, (line + found)[:, None]))


def _check(music: Times, dance: Times) -> None:
    if np.ndim(music) != 1 or np.ndim(dance) != 1 or len(music) != len(dance) or len(music) < 2:
        raise PlanError(
            f"{np.size(music)} beats of the music and {np.size(dance)} of the dance; as many of both are needed, 2+"
        )
    for name, beats in (("music", music), ("dance", dance)):
        good = np.abs(beats) < FARTHEST
        if not good.all():
            at = int(np.argmin(good))
            raise PlanError(f"beat {at} of the {name} is at {beats[at]} s; a number is needed")
        near = np.diff(beats) < NEAREST
        if near.any():
            at = int(np.argmax(near)) + 1
            raise PlanError(f"beat {at} of the {name}, at {beats[at]:.3f} s, is not after the one before it")


def _extended(beats: Times) -> Times:
    """The beats with ``BEYOND`` more before and after, as far apart as the nearest are on the whole."""
    first, last = (float(np.median(np.diff(part))) for part in (beats[: BEYOND + 1], beats[-BEYOND - 1 :]))
    steps = np.arange(1, BEYOND + 1)
    return np.concatenate((beats[0] - first * steps[::-1], beats, beats[-1] + last * steps))


def _constraints(
    knots: Knots, music: Times, dance: Times, rate: float, tolerance: float
) -> tuple[csr_array, Array, Array]:
    """Rows on the control points, and their lower and upper bounds: the beats met, and the rate above its least."""
    on_beats, rates = knots.design(music), differences(knots.controls, 1) / knots.step
    slack = np.full(len(music), tolerance * rate)
    lower = np.concatenate((dance - slack, np.full(knots.controls - 1, SLOWEST * rate)))
    upper = np.concatenate((dance + slack, np.full(knots.controls - 1, np.inf)))
    return csr_array(vstack((on_beats, rates))), lower, upper
