"""Whether a dance is strong where its music is strong.

Two curves on one clock are compared: how much the hands move and how loud and full the music is. People feel this over
a second or two, not from frame to frame, so both are smoothed alike before they are correlated.

Conventions
-----------
Both curves are sampled at ``rate`` Hz (10) and smoothed by a Gaussian of ``smoothing`` seconds (0.6: 1.4 s wide at
half its height). The motion's intensity is the mean speed of the two hands in the body-centre frame in m/s, or the
paper's Eq. 2 (:func:`onbeat.motion.features.intensity_component`); the music's is the song's ``intensity``.

Metrics
-------
* :func:`pearson` : −1…1, do they rise and fall in proportion.
* :func:`spearman` : −1…1, do they rise and fall together: Pearson's of the ranks.

A curve that is constant has no correlation: functions give nan, :func:`evaluate` gives None.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.stats import rankdata

from onbeat._shapes import Array, Times
from onbeat.errors import MetricError
from onbeat.motion.features import HandFeatures, intensity_component
from onbeat.music.song import Song

RATE = 10.0
"""Hz at which the curves are compared."""
SMOOTHING = 0.6
"""Seconds, standard deviation of the smoothing of both curves."""


def validate(motion: Array, music: Array, rate: float = RATE) -> None:
    """Raise a ``MetricError`` unless both curves are as many finite numbers at a positive rate."""
    if motion.ndim != 1 or motion.shape != music.shape:
        raise MetricError(
            f"the motion's intensity has shape {motion.shape} and the music's {music.shape}; both (N,) are needed"
        )
    for name, curve in (("motion", motion), ("music", music)):
        if not np.isfinite(curve).all():
            raise MetricError(f"the {name}'s intensity is not a number at sample {int(np.argmin(np.isfinite(curve)))}")
    if not (np.isfinite(rate) and rate > 0):
        raise MetricError(f"the rate is {rate} Hz; a positive rate is needed")


def hand_speed(features: HandFeatures, times: Times) -> Array:
    """Mean speed of the two hands at ``times`` (N,), in m/s."""
    return np.interp(times, features.times, features.speeds.mean(axis=1))


def pearson(a: Array, b: Array) -> float:
    """Pearson's correlation of (N,) and (N,); nan where either is constant or has under three numbers.

    Examples
    --------
    >>> pearson(np.array([1.0, 2.0, 3.0]), np.array([3.0, 2.0, 1.0]))
    -1.0
    """
    if len(a) < 3:
        return float("nan")
    a, b = a - a.mean(), b - b.mean()
    # Relative to the values themselves, so that rounding of a constant is not taken for a signal.
    size = float(np.sqrt((a @ a) * (b @ b)))
    if min(np.abs(a).max(), np.abs(b).max()) < 1e-9 or size <= 0:
        return float("nan")
    return float(np.clip(a @ b / size, -1.0, 1.0))


def spearman(a: Array, b: Array) -> float:
    """Spearman's correlation of (N,) and (N,): Pearson's of the ranks, ties at their mean rank.

    Examples
    --------
    >>> spearman(np.array([1.0, 2.0, 30.0]), np.array([0.1, 0.2, 0.3]))
    1.0
    """
    if len(a) < 3:
        return float("nan")
    return pearson(rankdata(a), rankdata(b))


def smoothed(curve: Array, rate: float = RATE, smoothing: float = SMOOTHING) -> Array:
    """A curve (N,) sampled at ``rate`` Hz, smoothed by a Gaussian of ``smoothing`` seconds."""
    return gaussian_filter1d(curve, smoothing * rate, mode="nearest") if smoothing > 0 and len(curve) else curve


def evaluate(motion: Array, music: Array, rate: float = RATE, smoothing: float = SMOOTHING) -> dict[str, float | None]:
    """Both correlations of two curves (N,) sampled at ``rate`` Hz, as ``pearson`` and ``spearman``.

    Raises
    ------
    MetricError
        If the curves are not as many finite numbers.
    """
    motion, music = np.asarray(motion, np.float64), np.asarray(music, np.float64)
    validate(motion, music, rate)
    a, b = smoothed(motion, rate, smoothing), smoothed(music, rate, smoothing)
    # Rounding to 1e-9 makes a smoothed constant constant again, and its ranks ties.
    a, b = np.round(a, 9), np.round(b, 9)
    found = {"pearson": pearson(a, b), "spearman": spearman(a, b)}
    return {name: None if np.isnan(value) else value for name, value in found.items()}


def evaluate_dance(features: HandFeatures, song: Song, duration: float) -> dict[str, float | None]:
    """Correlations of a dance's hands with its song over ``duration`` seconds.

    Returns
    -------
    ``intensity_pearson``, ``intensity_spearman`` of the hands' speed, and ``intensity_eq2_…`` of the paper's Eq. 2.
    """
    times = np.arange(max(round(duration * RATE), 0)) / RATE
    music = song.intensity_at(times)
    speed = evaluate(hand_speed(features, times), music)
    component = evaluate(intensity_component(features, times), music)
    return {f"intensity_{name}": value for name, value in speed.items()} | {
        f"intensity_eq2_{name}": value for name, value in component.items()
    }
