"""Global and local energy of a motion (keyposes 2009, Eqs. 1 and 2): how fast the body moves as a whole.

As printed the energy is the norm of the weighted *sum* of the points' velocities, ``F = ‖Σ m_i V_i‖``: the speed of
their centroid, in which opposing limbs cancel. That is ``paper``. ``rms``, ``√(Σ m_i ‖V_i‖² / Σ m_i)``, cannot cancel
and is the steadiest on recorded dances; ``sum`` is ``Σ m_i ‖V_i‖``. Global velocities are in the world, local ones in
the body-centre frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from scipy.interpolate import CubicSpline

from onbeat._shapes import Array, Positions, Times, frozen
from onbeat.errors import BodyError
from onbeat.keyposes.points import Points

RATE = 120.0
"""Hz, the rate at which energy is read, whatever the motion's own."""
SMOOTHING = 0.07
"""Seconds, standard deviation of the Gaussian with which velocities are taken."""
REACH = 4.0
"""Standard deviations after which that Gaussian is cut."""
SPARSE = 59.0
"""Frames per second under which the Gaussian would have too few samples."""
KINDS = ("rms", "sum", "paper")
"""How the points' velocities become one energy."""


@dataclass(frozen=True)
class Energy:
    """Energy over time, in units of its own mean.

    Parameters
    ----------
    times : (N,) seconds at ``RATE``.
    world, local : (N,) energy in the world and in the body-centre frame; their means over the motion are 1. ``local``
        is empty where that frame is not known.
    """

    times: Times
    world: Array
    local: Array

    def __post_init__(self) -> None:
        for name in ("times", "world", "local"):
            object.__setattr__(self, name, frozen(getattr(self, name)))


def energy_of(points: Points, kind: str = "rms", smoothing: float = SMOOTHING) -> Energy:
    """Energy of a body's points.

    Parameters
    ----------
    points : of the body.
    kind : one of ``KINDS``.
    smoothing : seconds, standard deviation of the smoothing.

    Raises
    ------
    BodyError
        If ``kind`` is unknown.
    """
    if kind not in KINDS:
        raise BodyError(f"no energy {kind!r}; there are {', '.join(KINDS)}")
    times = np.arange(max(1, int(np.floor((len(points.positions) - 1) / points.fps * RATE + 1e-6)) + 1)) / RATE
    weights = points.seen * points.weights
    curves = [np.zeros(0), np.zeros(0)]
    for which, paths in enumerate((points.positions, points.local()) if points.centred else (points.positions,)):
        curve = speed_at(times, paths, weights, kind, points.fps, smoothing)
        mean = float(curve.mean())
        curves[which] = curve / mean if mean > 1e-9 else np.zeros(len(curve))
    return Energy(times, curves[0], curves[1])


def speed_at(times: Times, paths: Positions, weights: Array, kind: str, fps: float, smoothing: float) -> Array:
    """One speed (N,) in m/s at ``RATE`` of paths (F, N, 3); few frames a second are first read through a spline."""
    if fps < SPARSE and len(paths) > 3:
        frames = np.arange(len(paths)) / fps
        nearest = np.minimum(np.round(times * fps).astype(np.int64), len(paths) - 1)
        return speed(CubicSpline(frames, paths)(times), weights[nearest], kind, RATE, smoothing)
    return read_at(speed(paths, weights, kind, fps, smoothing), fps, times)


def speed(paths: Positions, weights: Array, kind: str, fps: float, smoothing: float) -> Array:
    """One speed (F,) in m/s of paths (F, N, 3), those of weight 0 (F, N) left out."""
    sigma = smoothing * fps
    reach = max(1, int(np.ceil(REACH * sigma)))
    taps = np.arange(1, reach + 1)
    kernel = taps * np.exp(-0.5 * (taps / max(sigma, 0.3)) ** 2)
    kernel *= fps / (2.0 * (kernel * taps).sum())  # exact on straight lines
    return _speed(np.ascontiguousarray(paths), np.ascontiguousarray(weights), kernel, KINDS.index(kind))


@numba.njit(cache=True)
def _speed(paths: Positions, weights: Array, kernel: Array, kind: int) -> Array:
    """Velocities by an odd kernel, and at once what they come to; at the ends the path is held."""
    count, points = weights.shape
    flat = paths.reshape(count, 3 * points)
    velocity = np.empty(3 * points)
    result = np.zeros(count)
    for frame in range(count):
        velocity[:] = 0.0
        for tap in range(len(kernel)):
            after, before = flat[min(frame + tap + 1, count - 1)], flat[max(frame - tap - 1, 0)]
            share = kernel[tap]
            for axis in range(3 * points):
                velocity[axis] += share * (after[axis] - before[axis])
        total, moved, x, y, z = 0.0, 0.0, 0.0, 0.0, 0.0
        for point in range(points):
            weight = weights[frame, point]
            vx, vy, vz = velocity[3 * point], velocity[3 * point + 1], velocity[3 * point + 2]
            squared = vx * vx + vy * vy + vz * vz
            total += weight
            moved += weight * (squared if kind == 0 else np.sqrt(squared))
            x, y, z = x + weight * vx, y + weight * vy, z + weight * vz
        if total > 0.0:
            value = moved / total if kind == 1 else np.sqrt(moved / total)
            result[frame] = value if kind < 2 else np.sqrt(x * x + y * y + z * z) / total
    return result


def read_at(curve: Array, fps: float, times: Times) -> Array:
    """A speed (F,) at other times: its square, which is smooth where the speed has a corner, by a cubic spline."""
    if abs(fps - RATE) < 1e-9:
        return curve[: len(times)]
    if len(curve) < 4:
        return np.interp(times, np.arange(len(curve)) / fps, curve)
    return np.sqrt(np.maximum(CubicSpline(np.arange(len(curve)) / fps, curve**2)(times), 0.0))
