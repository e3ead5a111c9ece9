"""Paths over time that keep bounds: of their values, their velocities and their accelerations.

A path is a uniform cubic B-spline (:mod:`onbeat.retime.bspline`); what bounds its control points and their differences
bounds the path between its samples, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack

from onbeat._shapes import Array
from onbeat.quadratic import minimise
from onbeat.retime.bspline import Knots, differences

STEP = 0.05
"""Seconds between knots."""
SMOOTH = 2 * np.pi * 6.0
"""rad/s: what swings faster than this costs more as jerk than as distance."""


@dataclass(frozen=True)
class Grid:
    """Splines on knots ``step`` seconds apart, read at F frames.

    Parameters
    ----------
    frames, fps : what is read.
    step : seconds between knots; never less than a frame.
    """

    frames: int
    fps: float
    step: float = STEP

    @property
    def _step(self) -> float:
        return max(self.step, 1 / self.fps)

    @cached_property
    def knots(self) -> Knots:
        """From the first frame to the last or a little after."""
        intervals = max(1, int(np.ceil((self.frames - 1) / self.fps / self._step - 1e-9)))
        return Knots(0.0, self._step, intervals)

    @property
    def controls(self) -> int:
        """How many control points there are."""
        return self.knots.controls

    def values(self, derivative: int = 0) -> csr_array:
        """The sparse matrix (F, controls) from control points to values or derivatives at the frames."""
        return self.knots.design(np.arange(self.frames) / self.fps, derivative)

    def differences(self, order: int) -> csr_array:
        """The sparse matrix (controls − order, controls) to the control points of a derivative."""
        return csr_array(differences(self.controls, order) / self._step**order)

    def hull(self) -> Any:
        """The sparse matrix to the inner Bézier points, between which all values lie, at the frames or not."""
        n = self.controls - 1
        offsets: Any = [0, 1]
        first: Any = diags_array([2 / 3, 1 / 3], offsets=offsets, shape=(n, n + 1))
        second: Any = diags_array([1 / 3, 2 / 3], offsets=offsets, shape=(n, n + 1))
        return csr_array(vstack((first, second)))

    def roughness(self, smooth: float = SMOOTH) -> Any:
        """The sparse (controls, controls) square form of the jerk, in the unit of the values' mean square."""
        third = self.differences(3) / smooth**3
        return third.T @ third / self.controls

    def closeness(self) -> Any:
        """The sparse (controls, controls) square form of the mean square at the frames."""
        at = self.values()
        return at.T @ at / self.frames


@dataclass(frozen=True)
class Bounds:
    """Of a path: its values (both or none), its speed a second, its acceleration a second squared."""

    low: float = -np.inf
    high: float = np.inf
    speed: float = np.inf
    acceleration: float = np.inf


def gentle(values: Array, fps: float, bounds: Bounds) -> Array:
    """The smooth path nearest to values (F,) that keeps bounds, at the same frames.

    Examples
    --------
    >>> step = np.repeat([0.0, 1.0], 30)
    >>> path = gentle(step, 30, Bounds(0.0, 0.9, acceleration=8.0))
    >>> bool(path.max() <= 0.9 + 1e-6), bool(np.abs(np.diff(path, 2)).max() * 900 <= 8.01)
    (True, True)
    """
    if len(values) < 2:
        return np.clip(values, bounds.low, bounds.high)
    grid = Grid(len(values), fps)
    # Written for the distance from the mean, so that the programme is of size 1.
    middle = float(np.clip(values.mean(), bounds.low, bounds.high))
    rows: list[Any] = []
    most: list[tuple[float, float]] = []
    if np.isfinite(bounds.high - bounds.low):
        rows, most = [grid.hull()], [(bounds.low - middle, bounds.high - middle)]
    for order, bound in ((1, bounds.speed), (2, bounds.acceleration)):
        if np.isfinite(bound):
            rows.append(grid.differences(order) / bound)
            most.append((-1.0, 1.0))
    if not rows:
        rows, most = [grid.values()], [(-1e3, 1e3)]
    low, high = (np.concatenate([np.full(r.shape[0], m[n]) for r, m in zip(rows, most, strict=True)]) for n in (0, 1))
    cost = grid.closeness() + grid.roughness()
    linear = -grid.values().T @ (values - middle) / len(values)
    found = minimise(cost * 1e2, linear * 1e2, vstack(rows), (low, high), tolerance=1e-7, iterations=100, creeping=True)
    return values if found is None else np.asarray(middle + grid.values() @ found, dtype=np.float64)
