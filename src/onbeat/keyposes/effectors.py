"""Keyposes by the end effectors alone: the method of 2004, and the hands' stops."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Ints, Times
from onbeat.errors import BodyError
from onbeat.keyposes.candidates import Thresholds, candidates, minima, windows
from onbeat.keyposes.energy import RATE, speed_at
from onbeat.keyposes.points import Points
from onbeat.motion.features import SMOOTHING, find_stops, merge_stops

SLOW, FAST = 0.5, 1.0
"""Of the mean speed: under which an end effector rests, and what it reaches before or after."""


def effector_speed(points: Points, which: Ints) -> Array:
    """Speed (N,) in m/s at 120 Hz of some points in the body-centre frame, as one."""
    if not len(which):
        raise BodyError(f"no hands or feet among {', '.join(points.names)}; use the method energy")
    inside = points.local(which)
    weights = points.seen[:, which] / len(which)
    times = np.arange(max(1, int(np.floor((len(inside) - 1) / points.fps * RATE + 1e-6)) + 1)) / RATE
    return speed_at(times, inside, weights, "sum", points.fps, SMOOTHING)


def shiratori2004(points: Points, beats: Times, window: float) -> Times:
    """Time (B,) of the keypose at each beat, NaN where there is none: hands and feet rest near the beat.

    Shiratori, Nakazawa & Ikeuchi (2004, FG): for the hands and for the feet, minima of the speed that are slow and
    between which the speed is high; a beat at which both rest is a keypose, at the mean of their times.
    """
    found: list[Times] = []
    for which in (points.hands, points.feet):
        curve = effector_speed(points, which)
        resting = minima(curve / max(float(curve.mean()), 1e-9))
        passes = (resting.values < SLOW) & (resting.values + resting.rises > FAST)
        found.append(candidates(resting.chosen(passes), beats, Thresholds(np.inf, np.inf), window))
    return (found[0] + found[1]) / 2.0


def hand_stops(points: Points, beats: Times, window: float) -> Times:
    """Time (B,) of the stop of the hands at each beat, NaN where they do not stop (Shiratori 2006, Sec. II-A)."""
    half = len(points.hands) // 2
    sides = (points.hands[:half], points.hands[half:]) if half else (points.hands, points.hands)
    stops = merge_stops(find_stops(effector_speed(points, sides[0])), find_stops(effector_speed(points, sides[1])))
    if not len(stops):
        return np.full(len(beats), np.nan)
    first, last = windows(beats, window)
    near = stops[np.abs(stops[None] - beats[:, None]).argmin(axis=1)]
    return np.where((near >= first) & (near < last), near, np.nan)
