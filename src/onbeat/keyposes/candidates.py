"""Candidates for keyposes: where the energy is low near a beat (keyposes 2009, Sec. 3.1, Fig. 1).

A candidate is the local minimum of the energy near a beat, if it is under T1, or if the energy beside it is higher by
more than T2: on both sides, for a keypose lies between movements; the paper leaves open on which. Both thresholds are
in units of the mean energy, so that one choice serves any body and rate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.signal import peak_prominences

from onbeat._shapes import Array, Bools, Ints, Times
from onbeat.keyposes.energy import RATE

WINDOW = 0.5
"""Of the time between two beats, how far from a beat a minimum may lie: each belongs to the beat it is nearest to."""


LEAST_RISE = 0.2
"""Of the mean energy: bumps lower than this are swaying, not moving, and the minima between them are one rest."""


class Thresholds(NamedTuple):
    """T1, under which a minimum counts, and T2, a rise beyond which it counts; in units of the mean energy."""

    t1: float
    t2: float


class Minima(NamedTuple):
    """Local minima of an energy curve.

    Parameters
    ----------
    times : (M,) seconds, finer than the sampling.
    values : (M,) energy there.
    rises : (M,) how much higher the lower one of the two local maxima beside it is: the body moves before and after.
    climbs : (M,) how much higher the higher one is.
    """

    times: Times
    values: Array
    rises: Array
    climbs: Array

    def chosen(self, which: Bools) -> Minima:
        """Some of them."""
        return Minima(*(column[which] for column in self))


def minima(curve: Array, rate: float = RATE, least: float = LEAST_RISE) -> Minima:
    """The local minima inside a curve (N,), of those with lower bumps than ``least`` between them the lowest.

    A flat valley is one minimum, in its middle.

    Examples
    --------
    >>> t = np.arange(0, 3, 1 / 120)
    >>> found = minima(1 - np.cos(2 * np.pi * t))
    >>> found.times.round(2).tolist(), found.rises.round(2).tolist()
    ([1.0, 2.0], [2.0, 2.0])
    """
    turns = np.flatnonzero(np.concatenate([[True], np.diff(curve) != 0.0]))  # the first sample of each level
    slope = np.sign(np.diff(curve[turns]))
    falls = np.flatnonzero((slope[:-1] < 0) & (slope[1:] > 0)) + 1
    if not len(falls):
        return Minima(*np.zeros((4, 0)))
    ends = np.concatenate([turns[1:], [len(curve)]])[falls] - 1
    at = (turns[falls] + ends) // 2
    kept = peak_prominences(-curve, at)[0] >= least
    at, begins, ends = at[kept], turns[falls][kept], ends[kept]
    times = np.where(ends > begins, (begins + ends) / 2.0, at + _offset(curve, at)) / rate
    peaks = np.maximum.reduceat(curve, np.concatenate([[0], at]))
    lower, higher = np.minimum(peaks[:-1], peaks[1:]), np.maximum(peaks[:-1], peaks[1:])
    return Minima(times, curve[at], lower - curve[at], higher - curve[at])


def _offset(curve: Array, at: Ints) -> Array:
    """By how many samples a minimum lies beside a sample: of the parabola through the *squares*, which are smooth."""
    before, here, after = (curve[at + step] ** 2 for step in (-1, 0, 1))
    bend = before - 2.0 * here + after
    return np.where(bend > 1e-12, 0.5 * (before - after) / np.maximum(bend, 1e-12), 0.0).clip(-0.5, 0.5)


def windows(beats: Times, share: float = WINDOW) -> tuple[Times, Times]:
    """From when to when (B,) a minimum belongs to each beat: a share of the time to its neighbours."""
    gaps = np.diff(beats)
    usual = float(np.median(gaps)) if len(gaps) else 0.5
    before, after = np.concatenate([[usual], gaps]), np.concatenate([gaps, [usual]])
    return beats - share * before, beats + share * after


def candidates(
    found: Minima, beats: Times, thresholds: Thresholds, window: float = WINDOW, either: bool = False
) -> Times:
    """Time (B,) of each beat's candidate, NaN where it has none: the lowest of the minima that pass near it.

    With ``either`` a rise of T2 on one side is enough.
    """
    rises = found.climbs if either else found.rises
    passes = (found.values < thresholds.t1) | (rises > thresholds.t2)
    times, values = found.times[passes], found.values[passes]
    first, last = windows(beats, window)
    low, high = np.searchsorted(times, first), np.searchsorted(times, last)
    chosen = [a + int(values[a:b].argmin()) if b > a else -1 for a, b in zip(low, high, strict=True)]
    return np.array([times[k] if k >= 0 else np.nan for k in chosen])
