"""Demands on joints that are made up, for the tests of retiming."""

from __future__ import annotations

import numpy as np

from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Demand
from onbeat.retime.lock import TimeMap

FREE = np.inf


def demand(
    samples: np.ndarray,
    low: object = -FREE,
    high: object = FREE,
    speed: object = FREE,
    acceleration: object = FREE,
    jerk: object = FREE,
    keyposes: object = (),
    *,
    fps: float = 60.0,
    start: float = 0.0,
    beats: float = 2.0,
    begin: float = 0.0,
) -> Demand:
    """A demand of samples (F,) or (F, n), so many beats a second from beat ``begin`` on at second 0."""
    samples = np.asarray(samples, np.float64)
    wish = Spline.through(samples.reshape(len(samples), -1), fps, start)
    each = [np.broadcast_to(np.asarray(v, np.float64), (wish.channels,)) for v in (low, high, acceleration, jerk)]
    keys = np.asarray(keyposes, np.float64)
    return Demand(wish, *each[:2], np.asarray(speed, np.float64), *each[2:], keys, TimeMap.steady(beats, begin))


def curves(seed: int, frames: int, channels: int = 1, fps: float = 60.0, highest: float = 3.0) -> np.ndarray:
    """(frames, channels) sums of five sines up to so many Hz, of about 1 rad, about a random middle."""
    rng = np.random.default_rng(seed)
    times = np.arange(frames) / fps
    hertz, phase = rng.uniform(0.1, highest, (5, channels)), rng.uniform(0, 2 * np.pi, (5, channels))
    size = rng.normal(size=(5, channels)) / 2
    waves = size * np.sin(2 * np.pi * hertz * times[:, None, None] + phase)
    return waves.sum(axis=1) + rng.normal(size=channels)


def swing(seconds: float = 4.0, fps: float = 60.0, hertz: float = 1.0) -> np.ndarray:
    """(F,) a sine of 1 rad."""
    return np.sin(2 * np.pi * hertz * np.arange(int(seconds * fps) + 1) / fps)
