"""Motion features of Shiratori et al. 2006, Sec. II: stops of the hands and the intensity of their movement.

All parameters are in seconds and metres. Hand paths are read at one analysis rate whatever the motion's own rate, so
that 30, 60 and 120 frames per second give the same result.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Positions, Times
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames
from onbeat.motion.motion import Motion

RATE = 120.0
"""Hz, the rate at which hand paths are analysed."""
SMOOTHING = 0.05
"""Seconds, standard deviation of the smoothing of hand paths."""
MOVING = 0.25
"""Metres per second a hand must reach on both sides of a stop."""
DIP = 0.6
"""A stop's speed is under this part of the peaks on both sides."""
TOGETHER = 0.1
"""Seconds within which stops of both hands are one stop of the body."""
STOP_WIDTH = 0.1
"""σ1 of Eq. 1 in seconds."""
INTENSITY_WIDTH = 0.25
"""σ2 of Eq. 2 in seconds."""


@dataclass(frozen=True)
class HandFeatures:
    """What the hands of one motion do.

    Parameters
    ----------
    times : (N,) seconds at ``RATE``.
    speeds : (N, 2) m/s of the left and right hand in the body-centre frame.
    stops : for each hand, the seconds of its stops.
    """

    times: Times
    speeds: Array
    stops: tuple[Times, Times]

    @property
    def body_stops(self) -> Times:
        """Stops of either hand, those of both within ``TOGETHER`` seconds taken as one at their mean."""
        return merge_stops(*self.stops)


def hand_paths(motion: Motion, body: Body | None = None) -> Positions:
    """(F, 2, 3) metres, left and right wrist in the body-centre frame."""
    body = Body.of(motion.skeleton) if body is None else body
    frames, waist = body_frames(motion, body)
    wrists = motion.positions[:, body.indices("left_wrist", "right_wrist")]
    return rot.rotate(rot.inverse(frames)[:, None], wrists - waist[:, None])


def speed_of(paths: Positions, fps: float, smoothing: float = SMOOTHING) -> tuple[Times, Array]:
    """Speed along paths (F, ..., 3) sampled at ``fps``: times (N,) at ``RATE`` and speeds (N, ...) in m/s.

    The path is read at ``RATE`` through a cubic spline, smoothed by a Gaussian and differentiated centrally.
    """
    frames = len(paths)
    count = max(1, int(np.floor((frames - 1) / fps * RATE + 1e-6)) + 1)
    times = np.arange(count) / RATE
    dense = CubicSpline(np.arange(frames) / fps, paths)(times) if frames > 3 else np.repeat(paths[:1], count, axis=0)
    smooth = gaussian_filter1d(dense, smoothing * RATE, axis=0, mode="nearest")
    if count < 2:
        return times, np.zeros(smooth.shape[:-1])
    return times, np.linalg.norm(np.gradient(smooth, axis=0), axis=-1) * RATE


def find_stops(speed: Array, rate: float = RATE, moving: float = MOVING, dip: float = DIP) -> Times:
    """Seconds of the stops in one speed curve (N,) in m/s.

    A stop is a minimum of the speed between two real movements: the peaks before and after it reach ``moving`` and
    its own speed is under ``dip`` times both. Shallower dips inside a movement are no stops. Times are refined below
    the sampling by a parabola.

    Examples
    --------
    >>> t = np.arange(0, 4, 1 / 120)
    >>> find_stops(np.abs(np.sin(np.pi * t))).round(2).tolist()
    [1.0, 2.0, 3.0]
    """
    stops: list[float] = []
    peak, valley, at = 0.0, np.inf, -1
    for i, value in enumerate(speed.tolist()):
        if value > peak and at < 0:
            peak = value
        elif peak >= moving:
            if value < valley:
                valley, at = value, i
            if valley <= dip * peak and value >= max(moving, valley / dip):
                stops.append(_refined(speed, at) / rate)
                peak, valley, at = value, np.inf, -1
            elif value >= peak:
                peak, valley, at = value, np.inf, -1
    return np.array(stops)


def _refined(values: Array, index: int) -> float:
    """The place of a minimum by the parabola through it and its neighbours."""
    if not 0 < index < len(values) - 1:
        return float(index)
    before, here, after = (float(v) for v in values[index - 1 : index + 2])
    bend = before - 2 * here + after
    return index + (0.5 * (before - after) / bend if bend > 1e-12 else 0.0)


def merge_stops(left: Times, right: Times, together: float = TOGETHER) -> Times:
    """Stops of both hands as one list: a left and a right stop within ``together`` seconds become their mean."""
    merged: list[float] = []
    pool = sorted([(float(t), 0) for t in left] + [(float(t), 1) for t in right])
    index = 0
    while index < len(pool):
        time, hand = pool[index]
        if index + 1 < len(pool) and pool[index + 1][1] != hand and pool[index + 1][0] - time <= together:
            merged.append((time + pool[index + 1][0]) / 2)
            index += 2
        else:
            merged.append(time)
            index += 1
    return np.array(merged)


def hand_features(motion: Motion, body: Body | None = None) -> HandFeatures:
    """Speeds and stops of both hands."""
    times, speeds = speed_of(hand_paths(motion, body), motion.fps)
    return HandFeatures(times, speeds, (find_stops(speeds[:, 0]), find_stops(speeds[:, 1])))


def keyframe_component(stops: tuple[Times, ...], times: Times, width: float = STOP_WIDTH) -> Array:
    """Eq. 1: ``MC_stop(t) = Σ_hands Σ_j exp(−(t − t_j)² / σ1²)`` at ``times`` (N,), σ1 = ``width`` seconds.

    There is no ½ in the exponent. It is highest where both hands stop together.
    """
    total = np.zeros(len(times))
    for hand in stops:
        for stop in hand:
            total += np.exp(-(((times - stop) / width) ** 2))
    return total


def intensity_component(features: HandFeatures, times: Times, width: float = INTENSITY_WIDTH) -> Array:
    """Eq. 2: ``MC_intensity(t) = Σ_hands Σ_j v_max(j) exp(−(t − c_j)² / σ2²)`` at ``times`` (N,), in m/s.

    ``c_j`` is the midpoint of stops j and j+1 and ``v_max(j)`` the highest hand speed between them.
    """
    total = np.zeros(len(times))
    for hand, stops in enumerate(features.stops):
        for first, second in itertools.pairwise(stops.tolist()):
            low, high = np.searchsorted(features.times, (first, second))
            peak = float(features.speeds[low : max(high, low + 1), hand].max())
            total += peak * np.exp(-(((times - (first + second) / 2) / width) ** 2))
    return total
