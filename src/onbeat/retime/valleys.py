"""Insight 2 of 2007 as numbers: the valleys that all curves of variance have in common, and how low they are there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from onbeat._shapes import Array

WITHIN = 0.125
"""Beats from their middle within which the valleys of all curves are one."""
SMOOTHING = 0.0625
"""Beats over which a curve is smoothed (deviation of a Gaussian)."""
DEPTH = 1.35
"""By how much a curve rises on both sides of a valley before it is lower again: a factor."""
AWAY = 0.25
"""Beats from every keypose past which a moment is another one."""


def valleys(beats: Array, curve: Array, cyclic: bool = False) -> Array:
    """Beats (K,) at which a curve (G,) of variance has a local minimum that is deep enough to be one.

    Depth is a factor: a variance is never below 0, and its estimate's error grows with it. A curve's ends are no
    valleys, but where it is of a cycle, which goes on.

    Examples
    --------
    >>> beats = np.arange(129) / 32
    >>> curve = 1.1 + np.cos(2 * np.pi * (beats - 0.5))
    >>> valleys(beats, curve).tolist(), valleys(beats, curve, cyclic=True).tolist()
    ([1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0])
    """
    top = float(np.max(curve, initial=0.0))
    if len(curve) < 3 or not np.isfinite(curve).all() or top <= 0:
        return np.zeros(0)
    around = np.tile(curve[:-1], 3) if cyclic else curve
    smooth = gaussian_filter1d(around, SMOOTHING / float(beats[1] - beats[0]), mode="nearest")
    found = find_peaks(-np.log(np.maximum(smooth, 1e-12 * top)), prominence=np.log(DEPTH))[0]
    if cyclic:
        found = found[(found >= len(curve) - 1) & (found < 2 * (len(curve) - 1))] - (len(curve) - 1)
    return np.asarray(beats[found], dtype=np.float64)


def common_valleys(each: Sequence[Array], period: float = 0.0, within: float = WITHIN) -> Array:
    """Beats (K,) about which every one of some curves has a valley, each used once; the middles of these valleys.

    Parameters
    ----------
    each : the valleys of each curve, in beats.
    period : beats after which a cycle begins again; 0 where there is none.
    within : beats from their middle.

    Examples
    --------
    >>> common_valleys([np.array([1.0, 2.0]), np.array([1.1, 2.6]), np.array([0.95])]).round(3).tolist()
    [1.025]
    >>> common_valleys([np.array([0.0]), np.array([7.9])], period=8.0).round(3).tolist()
    [7.95]
    """
    if not each or not all(len(curve) for curve in each):
        return np.zeros(0)
    groups = [np.array([_nearest(curve, start, period) for curve in each]) for start in each[0].tolist()]
    taken, found = set[tuple[int, float]](), list[float]()
    for group in sorted(groups, key=lambda group: float(np.ptp(group))):
        used = {(number, _wrapped(float(beat), period)) for number, beat in enumerate(group)}
        if np.ptp(group) <= 2 * within + 1e-9 and not used & taken:
            taken |= used
            found.append(_wrapped(float(group.min() + group.max()) / 2, period))
    return np.sort(np.array(found))


def _nearest(curve: Array, start: float, period: float) -> float:
    """The valley nearest to ``start``, counted on from it where a cycle ends between them."""
    apart = away(curve, start, period)
    return start + float(apart[np.abs(apart).argmin()])


def _wrapped(beat: float, period: float) -> float:
    return round(beat % period, 9) % period if period else round(beat, 9)


def away(beats: Array, start: Array | float, period: float = 0.0) -> Array:
    """By how many beats some are after ``start``, before it where that is shorter round the cycle.

    Examples
    --------
    >>> away(np.array([1.0, 7.5]), 0.5, period=8.0).tolist()
    [0.5, -1.0]
    """
    apart = beats - start
    return (apart + period / 2) % period - period / 2 if period else apart


def contrast(beats: Array, curve: Array, keyposes: Array, period: float = 0.0) -> float:
    """The mean of a curve (G,) at keyposes (K,), by its mean at other times between the first and the last of them.

    Below 1 the keyposes are kept better than the rest. No number where there are no other times.

    Examples
    --------
    >>> beats = np.arange(129) / 32
    >>> round(contrast(beats, 1.1 + np.cos(2 * np.pi * beats), np.array([0.5, 1.5, 2.5])), 3)
    0.056
    """
    inside = keyposes[(keyposes >= beats[0]) & (keyposes <= beats[-1])]
    if not len(inside):
        return float("nan")
    others = np.abs(away(beats[:, None], inside, period)).min(axis=1) > AWAY
    if not period:
        others &= (beats > inside.min()) & (beats < inside.max())
    below = float(curve[others].mean()) if others.any() else 0.0
    return float(np.interp(inside, beats, curve).mean()) / below if below > 0 else float("nan")
