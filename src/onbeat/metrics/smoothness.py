"""How smooth a dance is, above all where one clip gives way to another.

A join shows as a jolt: joints change speed faster than bodies do. The dance is measured inside the windows around its
joins, elsewhere, and against its source clips, which show how much jolt the dancers themselves put in.

Conventions
-----------
Joint paths are in metres in the world. They are read at ``RATE`` through a cubic spline and smoothed by a Gaussian of
``SMOOTHING`` seconds before they are differentiated, so that 30, 60 and 120 frames a second give the same jerk.
Joins are seconds on the dance's clock; a window is everything within ``window`` seconds of one, or given as a span.

Metrics
-------
* :func:`jerk` : ``|d³p/dt³|`` in m/s³ of joints. Groups are the hands (wrists), the feet (ankles) and all joints.
* :func:`join_link_errors` : the mean angle in degrees between the 17 link directions of the two poses that a join
  brings together, in the body-centre frame: what the blend has to hide.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Ints, Positions, Times
from onbeat.errors import MetricError
from onbeat.metrics.windows import WINDOW, near_joins, ratio, statistic
from onbeat.motion.body import Body
from onbeat.motion.links import LINKS, link_directions, link_error
from onbeat.motion.motion import Motion

RATE = 120.0
"""Hz at which paths are analysed."""
SMOOTHING = 1 / 30
"""Seconds, standard deviation of the smoothing of joint paths."""
_REACH = 3.0  # standard deviations that the smoothing looks to each side


def validate(paths: Positions, fps: float) -> None:
    """Raise a ``MetricError`` unless paths are (F, ..., 3) finite metres at a positive rate."""
    if paths.ndim < 2 or paths.shape[-1] != 3:
        raise MetricError(f"paths have shape {paths.shape}; (frames, ..., 3) is needed")
    if not np.isfinite(paths).all():
        frame = int(np.argwhere(~np.isfinite(paths))[0][0])
        raise MetricError(f"paths have a value that is not a number at frame {frame}")
    if not (np.isfinite(fps) and fps > 0):
        raise MetricError(f"paths have {fps} frames per second; a positive rate is needed")


def derivative(paths: Positions, fps: float, order: int) -> tuple[Times, Array]:
    """Magnitude of the ``order``-th time derivative of paths (F, ..., 3): times (N,) and (N, ...) in m/s^order.

    The first and last tenth of a second, where the smoothing reaches past the ends, are left out; a path that is
    shorter than both gives no times.

    Examples
    --------
    >>> t = np.arange(60) / 30
    >>> falling = np.stack((0 * t, 0 * t, -9.81 / 2 * t**2), axis=-1)
    >>> derivative(falling, 30, 2)[1][100].round(2)
    np.float64(9.81)
    """
    validate(paths, fps)
    frames = len(paths)
    times = np.arange(int(np.floor((frames - 1) / fps * RATE + 1e-6)) + 1) / RATE
    reach = round(_REACH * SMOOTHING * RATE)
    known = slice(reach + order, len(times) - reach - order)  # elsewhere the filter would have to invent the path
    if frames < 4 or known.start >= known.stop:
        return np.zeros(0), np.zeros((0, *paths.shape[1:-1]))
    change = gaussian_filter1d(
        CubicSpline(np.arange(frames) / fps, paths)(times), SMOOTHING * RATE, axis=0, truncate=_REACH
    )
    for _ in range(order):
        change = np.gradient(change, 1 / RATE, axis=0)
    return times[known], np.linalg.norm(change[known], axis=-1)


def jerk(motion: Motion, joints: Ints) -> tuple[Times, Array]:
    """Seconds (N,) and jerk (N, len(joints)) in m/s³ of joints in the world."""
    return derivative(motion.positions[:, joints], motion.fps, 3)


def join_link_errors(clips: Sequence[Motion], moves: Sequence[tuple[int, float, float]]) -> Array:
    """(K,) degrees, for each join the link error between the pose left and the pose entered.

    ``moves`` are (clip, from_s, to_s) in order; join k lies between moves k and k + 1.
    """
    if len(moves) < 2:
        return np.zeros(0)
    left = _directions(clips, [(clip, to) for clip, _, to in moves[:-1]])
    return link_error(left, _directions(clips, [(clip, start) for clip, start, _ in moves[1:]]))


def _directions(clips: Sequence[Motion], poses: Sequence[tuple[int, float]]) -> Array:
    """(K, 17, 3) link directions of poses (clip, second), those of a clip reckoned together."""
    clip_of, seconds = np.array([clip for clip, _ in poses]), np.array([second for _, second in poses])
    directions = np.zeros((len(poses), len(LINKS), 3))
    for clip in np.unique(clip_of).tolist():
        mine = clip_of == clip
        directions[mine] = link_directions(clips[clip].at(seconds[mine]))
    return directions


def joint_groups(body: Body) -> dict[str, Ints]:
    """The joints of each group that is measured: ``hands``, ``feet`` and ``all`` but the ends of bones."""
    return {
        "hands": body.indices("left_wrist", "right_wrist"),
        "feet": body.indices("left_ankle", "right_ankle"),
        "all": np.flatnonzero(~body.skeleton.end_sites),
    }


def evaluate(
    motion: Motion, joins: Array, source: Sequence[Motion] = (), window: float = WINDOW
) -> dict[str, float | None]:
    """Jerk inside the windows around joins, elsewhere, and in the source.

    Parameters
    ----------
    motion : the dance.
    joins : (K,) seconds of its joins, or (K, 2) windows; none means all of it is elsewhere.
    source : the clips it is made of, or the stretches of them that it shows.
    window : seconds either side of a join.

    Returns
    -------
    For each group ``hands``, ``feet``, ``all``: ``jerk_<group>_joins``, ``…_elsewhere`` and ``…_source`` (means, m/s³),
    the same three with ``_p95`` (95th percentiles), and ``…_ratio``, ``…_p95_ratio``: joins over source, or over
    elsewhere where no source is given. None where there is nothing to measure.
    """
    times, values = jerk(motion, np.arange(len(motion.skeleton)))
    inside = near_joins(times, joins, window)
    sources = [(jerk(clip, np.arange(len(clip.skeleton)))[1], joint_groups(Body.of(clip.skeleton))) for clip in source]
    result: dict[str, float | None] = {}
    for group, joints in joint_groups(Body.of(motion.skeleton)).items():
        pool = [original[:, groups[group]].ravel() for original, groups in sources]
        places = {
            "joins": values[inside][:, joints],
            "elsewhere": values[~inside][:, joints],
            "source": np.concatenate(pool) if pool else np.zeros(0),
        }
        result |= _compared(f"jerk_{group}", places, "source" if pool else "elsewhere")
    return result


def _compared(key: str, places: dict[str, Array], against: str) -> dict[str, float | None]:
    """Mean and 95th percentile at each place, and of the joins over those of the place ``against``."""
    result: dict[str, float | None] = {}
    for which, suffix in (("mean", ""), ("p95", "_p95")):
        for place, values in places.items():
            result[f"{key}_{place}{suffix}"] = statistic(values, which)
        joins, other = result[f"{key}_joins{suffix}"], result[f"{key}_{against}{suffix}"]
        result[f"{key}{suffix}_ratio"] = ratio(joins, other)
    return result
