"""Uniform cubic B-splines: several channels on knots evenly spaced in time (2007, Eqs. 1-5).

    f(t) = Σ_{i=0..3} B_i(u − ⌊u⌋) Q_{⌊u⌋+i},  u = (t − start) / step

so that m intervals have m + 3 control points, and interval k is under the control points k to k + 3 alone. The first
differences of the control points are, divided by the step, those of the velocity (a quadratic spline), the second
those of the acceleration (piecewise linear, so these are its very corners), the third those of the jerk (its steps). A
spline lies within the hull of its control points: what bounds these bounds it *between* samples, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import solve_banded
from scipy.sparse import csr_array, diags_array

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import PlanError

# Rows B_0 … B_3, columns the powers 1, u, u², u³ (Eqs. 2-5).
_BASIS = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0
_POWERS = np.arange(4)
MOST = 3
"""The highest derivative that is not zero everywhere."""
LARGEST = 1e100
"""Past any number that is meant; larger ones have no squares."""


def basis(parts: Array, derivative: int = 0) -> Array:
    """The four basis functions (N, 4), or their derivatives, at parts (N,) of an interval from 0 to 1.

    Examples
    --------
    >>> basis(np.array([0.0, 0.5])).round(4).tolist()
    [[0.1667, 0.6667, 0.1667, 0.0], [0.0208, 0.4792, 0.4792, 0.0208]]
    """
    table, powers = _BASIS, _POWERS
    for _ in range(derivative):
        table = table[:, 1:] * powers[1 : table.shape[1]]
    return np.asarray(parts, dtype=np.float64)[:, None] ** _POWERS[: table.shape[1]] @ table.T


def differences(count: int, order: int) -> csr_array:
    """The matrix (count − order, count) that takes values to their differences of an order.

    Examples
    --------
    >>> differences(4, 2).toarray().tolist()
    [[1.0, -2.0, 1.0, 0.0], [0.0, 1.0, -2.0, 1.0]]
    """
    shares = [float(math.comb(order, i) * (-1) ** (order - i)) for i in range(order + 1)]
    if count <= order:
        return csr_array((0, count))
    offsets: Any = list(range(order + 1))
    bands = diags_array(shares, offsets=offsets, shape=(count - order, count), dtype=np.float64)
    return csr_array(bands)


@dataclass(frozen=True)
class Knots:
    """Where a spline's knots are: ``intervals`` of ``step`` seconds from ``start`` on.

    Examples
    --------
    >>> Knots(0.0, 0.5, 4).end, Knots(0.0, 0.5, 4).controls
    (2.0, 7)
    """

    start: float
    step: float
    intervals: int

    @property
    def end(self) -> float:
        """Seconds."""
        return self.start + self.step * self.intervals

    @property
    def controls(self) -> int:
        """How many control points there are."""
        return self.intervals + 3

    @property
    def times(self) -> Times:
        """(intervals + 1,) seconds of the knots."""
        return self.start + self.step * np.arange(self.intervals + 1, dtype=np.float64)

    def places(self, times: Times) -> tuple[np.ndarray, Array]:
        """The interval of each time and the part of it that has gone by; times outside go to the ends' intervals."""
        u = (np.asarray(times, np.float64) - self.start) / self.step
        if np.isnan(u).any():
            raise PlanError(f"time {int(np.argmax(np.isnan(u)))} is not a number")
        interval = np.clip(np.floor(u), 0, self.intervals - 1).astype(np.int64)
        return interval, u - interval

    def design(self, times: Times, derivative: int = 0) -> csr_array:
        """The matrix (N, controls) that takes control points to values or derivatives at times (Eqs. 7, 11)."""
        interval, part = self.places(times)
        values = basis(part, derivative) / self.step**derivative
        columns = interval[:, None] + np.arange(4)
        starts = np.arange(len(interval) + 1) * 4
        return csr_array((values.ravel(), columns.ravel(), starts), shape=(len(interval), self.controls))


@dataclass(frozen=True, eq=False)
class Spline:
    """Channels over time as one uniform cubic B-spline.

    Parameters
    ----------
    knots : where they are.
    controls : (knots.controls, n) control points, in the channels' unit.

    Examples
    --------
    >>> line = Spline.through(np.array([[0.0], [1.0], [2.0]]), fps=10)
    >>> line(np.array([0.05])).tolist(), line(np.array([0.05]), 1).round(9).tolist()
    ([[0.5]], [[10.0]])
    """

    knots: Knots
    controls: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "controls", frozen(self.controls))
        if self.controls.ndim != 2 or len(self.controls) != self.knots.controls:
            raise PlanError(
                f"control points of shape {self.controls.shape} on {self.knots.intervals} intervals; "
                f"({self.knots.controls}, channels) are needed"
            )

    @classmethod
    def through(cls, samples: Array, fps: float, start: float = 0.0) -> Spline:
        """The spline through samples (F, n), one a knot, with no acceleration at its ends; O(F).

        Raises
        ------
        PlanError
            If there is no sample, one is not a number, or the rate is not above 0.
        """
        if not 1 / LARGEST < fps < LARGEST:
            raise PlanError(f"{fps} samples a second; a rate above 0 is needed")
        values = np.asarray(samples, np.float64)
        if values.ndim != 2 or not len(values):
            raise PlanError(f"samples of shape {values.shape}; (frames, channels) with one frame or more are needed")
        good = np.abs(values) < LARGEST
        if not good.all():
            frame, channel = np.argwhere(~good)[0].tolist()
            raise PlanError(f"channel {channel} is {values[frame, channel]} at frame {frame}; a number is needed")
        if len(values) == 1:
            values = np.repeat(values, 2, axis=0)
        # At the ends c₀ − 2c₁ + c₂ = 0, so that c₁ is the first sample itself.
        inner = values.copy()
        if len(values) > 2:
            right = 6 * values[1:-1]
            right[0] -= values[0]
            right[-1] -= values[-1]
            bands = np.ones((3, len(right)))
            bands[1] = 4
            inner[1:-1] = solve_banded((1, 1), bands, right)
        controls = np.concatenate((2 * inner[:1] - inner[1:2], inner, 2 * inner[-1:] - inner[-2:-1]))
        return cls(Knots(start, 1 / fps, len(values) - 1), controls)

    def __call__(self, times: Times, derivative: int = 0) -> Array:
        """Values (N, n), or derivatives, at times; before the start and after the end those of the ends."""
        held = np.clip(np.asarray(times, np.float64), self.knots.start, self.knots.end)
        interval, part = self.knots.places(held)
        weights = basis(part, derivative) / self.knots.step**derivative
        return np.einsum("fi,fin->fn", weights, self.controls[interval[:, None] + np.arange(4)])

    @property
    def channels(self) -> int:
        """How many there are."""
        return self.controls.shape[1]

    @property
    def samples(self) -> Array:
        """(intervals + 1, n) values at the knots."""
        c = self.controls
        return (c[:-2] + 4 * c[1:-1] + c[2:]) / 6

    def differences(self, derivative: int) -> Array:
        """The control points (controls − derivative, n) of the 1st, 2nd or 3rd derivative."""
        return np.diff(self.controls, derivative, axis=0) / self.knots.step**derivative

    @property
    def hull(self) -> Array:
        """(2, intervals + 2, n) the inner Bézier points about every pair of control points; they bound the values.

        The knots' values lie between those of the neighbouring pairs, so these points are enough.
        """
        c = self.controls
        return np.stack(((2 * c[:-1] + c[1:]) / 3, (c[:-1] + 2 * c[1:]) / 3))

    def with_controls(self, controls: Array) -> Spline:
        """The same knots under other control points."""
        return Spline(self.knots, controls)
