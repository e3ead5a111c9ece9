"""How fast joints turn: angular velocities of recorded rotations, without those that only bad frames have.

1. A single bad frame is put onto the cubic through its four neighbours, ``(−q₋₂ + 4q₋₁ + 4q₁ − q₂)/6``: one that is
   further off it than two degrees, than is usual for the joint, than its neighbours are off theirs, and than these are
   from each other.
2. The velocity is that of the cubic spline q(t) through the frames, ``ω = 2 vec(q* q̇)``.
3. No speed is over 1.5 × one that lasts for ``LASTING`` s within as long before and after. That which lasts at a time
   is the least of the mean speeds until it, from it, and around it: when a recording jumps, one of them is low.

All is read at ``RATE``, whatever the recording's own rate is.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d

from onbeat._shapes import Array, Rotations
from onbeat.motion import rotations as rot

RATE = 120.0
"""Hz, at which velocities are read."""
LASTING = 0.05
"""Seconds that a speed has to last."""
_OVER = 1.5
"""How far the highest speed of a fast swing (4 Hz) is over that which lasts."""
_GLITCH = 0.0175
"""Two degrees as a distance of quaternions, which is half the angle."""
_UNUSUAL = 10.0
"""Times the median distance of the joint."""
_TOGETHER = 8
"""Joints that are worked on at once."""


def angular_velocities(rotations: Rotations, fps: float) -> Array:
    """Angular velocities (N, J, 3) in rad/s of F ≥ 2 frames of rotations (F, J, 4) wxyz, at ``RATE`` from the first.

    They are in the joint's own frame.

    Examples
    --------
    >>> times = np.arange(60) / 30
    >>> turning = rot.about(np.array([0, 0, 1.0]), 2 * times)[:, None]
    >>> bool(np.abs(angular_velocities(turning, 30) - [0, 0, 2]).max() < 1e-6)
    True
    """
    frames, joints = rotations.shape[:2]
    count = int(np.floor((frames - 1) / fps * RATE + 1e-6)) + 1
    out = np.empty((count, joints, 3))
    for start in range(0, joints, _TOGETHER):
        some = slice(start, start + _TOGETHER)
        out[:, some] = _velocities(without_glitches(rot.continuous(rotations[:, some])), fps, np.arange(count) / RATE)
    return out


def _velocities(q: Rotations, fps: float, times: Array) -> Array:
    spline = CubicSpline(np.arange(len(q)) / fps, q)
    velocity = 2 * rot.multiply(rot.inverse(rot.normalise(spline(times))), spline(times, 1))[..., 1:]
    lasting, before = lasting_speeds(q, fps), (times * fps + 1e-6).astype(np.int64)
    ceiling = _OVER * np.maximum(lasting[before], lasting[np.minimum(before + 1, len(q) - 1)])
    return velocity * np.minimum(1.0, ceiling / np.maximum(np.linalg.norm(velocity, axis=-1), 1e-12))[..., None]


def without_glitches(q: Rotations) -> Rotations:
    """Continuous rotations (F, J, 4) with single bad frames put onto the cubic through their neighbours."""
    if len(q) < 7:
        return q
    cubic = (4 * (q[1:-3] + q[3:-1]) - q[:-4] - q[4:]) / 6
    off = np.linalg.norm(q[2:-2] - cubic, axis=-1)
    beside = np.linalg.norm(q[3:-1] - q[1:-3], axis=-1)
    highest = off > beside
    highest[1:] &= off[1:] > off[:-1]
    highest[:-1] &= off[:-1] >= off[1:]
    bad = highest & (off > np.maximum(_GLITCH, _UNUSUAL * np.median(off, axis=0)))
    out = q.copy()
    out[2:-2][bad] = rot.normalise(cubic[bad])
    return out


def lasting_speeds(q: Rotations, fps: float) -> Array:
    """(F, J) rad/s: the highest speed that lasts, of those within ``LASTING`` before and after each frame of (F, J, 4).

    Examples
    --------
    >>> jump = rot.about(np.array([0, 0, 1.0]), np.repeat([0.0, 1.0], 60))[:, None]
    >>> float(lasting_speeds(jump, 120).max())
    0.0
    """
    n = min(max(int(LASTING * fps + 1e-6), 1), len(q) - 1)
    until, since = _mean_speeds(q, n, n, fps), _mean_speeds(q, n, 0, fps)
    around = _mean_speeds(q, min(2 * ((n + 1) // 2), len(q) - 1), (n + 1) // 2, fps)
    return maximum_filter1d(np.minimum(np.minimum(until, since), around), 2 * n + 1, axis=0, mode="nearest")


def _mean_speeds(q: Rotations, frames: int, before: int, fps: float) -> Array:
    """(F, J) rad/s over so many frames, so many of which are before each; at the ends over the outermost frames."""
    over = rot.angle_between(q[:-frames], q[frames:]) * (fps / frames)
    return over[np.clip(np.arange(len(q)) - before, 0, len(over) - 1)]
