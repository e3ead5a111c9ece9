"""One joint of a retimed dance as curves to draw: the angle it turns by, its velocity, and the weights of its layers.

A hinge is its angle. A character's joint turns freely: what is drawn of it is the turn about its main axis, the
direction in which its rotation vector moves most in the wish, and the length of the vector's velocity, which is what
its limit bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.errors import OnbeatError
from onbeat.limits.limits import listed, near_names
from onbeat.retime.bspline import Spline
from onbeat.retime.measures import TOLERANCE
from onbeat.retime.retime import Retimed

SECONDS = 8.0
"""How much is drawn where no stretch is told."""
FINE = 8
"""Moments a frame at which velocities are looked at for their highest."""
AT_ONCE = 20_000
"""Moments that are looked at together: an hour's would not fit in memory."""
_SAME = 1e-9


@dataclass(frozen=True, eq=False)
class Look:
    """How one joint is looked at.

    Parameters
    ----------
    joint : its name.
    channels : which ones of the trajectory are the joint's.
    axis : (size,) of length 1, the direction whose share of the joint's vector is drawn; (1,) for a hinge.
    start, end : seconds of the music.
    """

    joint: str
    channels: slice
    axis: Array
    start: float
    end: float

    def angle(self, curve: Spline, times: Times) -> Array:
        """(N,) degrees."""
        return np.degrees(curve(times)[:, self.channels] @ self.axis)

    def velocity(self, curve: Spline, times: Times) -> Array:
        """(N,) degrees a second; of a joint that turns freely its length."""
        rates = np.degrees(curve(times, 1)[:, self.channels])
        return rates[:, 0] if len(self.axis) == 1 else np.linalg.norm(rates, axis=1)

    def angles_allowed(self, result: Retimed) -> tuple[float, float]:
        """Degrees, from and to; infinite for a joint that turns freely, whose limits are not of one angle."""
        if len(self.axis) > 1:
            return -np.inf, np.inf
        mine = result.limits.of([self.joint])
        return float(np.degrees(mine.low[0])), float(np.degrees(mine.high[0]))

    def weights(self, result: Retimed) -> Array | None:
        """(frames, layers) of the layers, as far as they act along the axis; None for methods that have none."""
        every = result.answer.weights
        return None if every is None else every[:, :, self.channels] @ np.square(self.axis)

    def keyposes(self, result: Retimed) -> tuple[Times, Array, Bools]:
        """(K,) seconds inside the stretch, degrees of the wish there, and whether the body can take all of it."""
        every = result.measures.keyposes
        inside = np.flatnonzero((every >= self.start) & (every <= self.end))
        feasible = result.measures.feasible[inside, self.channels].all(axis=1)
        return every[inside], self.angle(result.demand.wish, every[inside]), np.asarray(feasible)


def look_at(result: Retimed, joint: str | None = None, span: tuple[float, float] | None = None) -> Look:
    """How a joint is looked at over a stretch of the music.

    Parameters
    ----------
    result : a retimed dance.
    joint : its name; the joint that was changed most without it.
    span : seconds of the music, from and to; ``SECONDS`` about the joint's largest change without it.

    Raises
    ------
    OnbeatError
        If there is no such joint, or the stretch has nothing of the dance.
    """
    names, size = result.source.joints, result.source.size
    if joint is not None and joint not in names:
        raise OnbeatError(f"no joint {joint!r} {near_names(joint, names)}".rstrip() + f"; there are {listed(names)}")
    changes = changed(result)
    place = int(changes.max(axis=0).argmax()) if joint is None else names.index(joint)
    start, end = _span(result, changes[:, place]) if span is None else _inside(result, span)
    channels = slice(place * size, (place + 1) * size)
    return Look(names[place], channels, _main_axis(result, channels, start, end), start, end)


def changed(result: Retimed) -> Array:
    """(frames, joints) radians by which each joint is not as wished; where none is changed, how fast the wish is."""
    wish, answer = result.demand.wish, result.answer.trajectory
    change = _lengths(answer.samples - wish.samples, result.source.size)
    return change if change.max(initial=0.0) > _SAME else _lengths(wish(wish.knots.times, 1), result.source.size)


class Use(NamedTuple):
    """How much of its limit each joint's speed is, (joints,): at most, and for how many seconds it is more than all."""

    highest: Array
    seconds_over: Array


def speed_use(result: Retimed, curve: Spline) -> Use:
    """What a curve needs of the joints' speed limits, looked at ``FINE`` times a frame; 0 of infinite ones."""
    knots, limits = curve.knots, result.limits.of(result.source.joints).speed
    highest, count = np.zeros(len(limits)), np.zeros(len(limits))
    for first in range(0, knots.intervals * FINE + 1, AT_ONCE):
        places = np.arange(first, min(first + AT_ONCE, knots.intervals * FINE + 1), dtype=np.float64)
        shares = _lengths(curve(knots.start + places * (knots.step / FINE), 1), result.source.size) / limits
        np.maximum(highest, shares.max(axis=0), out=highest)
        count += (shares > 1 + TOLERANCE).sum(axis=0)
    return Use(highest, count * (knots.step / FINE))


def over_limits(result: Retimed, curve: Spline) -> Bools:
    """(joints,) true where a curve is past a joint's limit of angle or speed at any moment."""
    past = (curve.samples < result.demand.low - TOLERANCE) | (curve.samples > result.demand.high + TOLERANCE)
    angles = past.any(axis=0).reshape(-1, result.source.size).any(axis=1)
    return np.asarray(angles | (speed_use(result, curve).highest > 1 + TOLERANCE))


def one_dance(results: Sequence[Retimed]) -> Retimed:
    """The first of some results, if all are of the same dance in the same time.

    Raises
    ------
    OnbeatError
        If there is none, or they are of different dances.
    """
    if not results:
        raise OnbeatError("no retimed dance to draw; one result or more is needed")
    first = results[0].demand.wish
    for other in results[1:]:
        mine = other.demand.wish
        if other.source.joints != results[0].source.joints or mine.knots != first.knots:
            raise OnbeatError(
                f"the results of {results[0].method} and {other.method} are of different dances or speeds: "
                f"{first.channels} channels over {first.knots.end - first.knots.start:.2f} s, {mine.channels} over "
                f"{mine.knots.end - mine.knots.start:.2f} s; draw methods on one dance in one time together"
            )
    return results[0]


def speed_told(result: Retimed, start: float, end: float) -> str:
    """How much faster the dance is than it was, in words: "1.2×", or "1.1–1.3×" where the tempo changes."""
    rates = result.warp(np.linspace(start, end, 101), 1)
    low, high = f"{rates.min():.3g}", f"{rates.max():.3g}"
    return f"{low}×" if low == high else f"{low}–{high}×"


def joint_told(name: str) -> str:
    """A joint's name in a figure: without what every name has.

    Examples
    --------
    >>> joint_told("left_shoulder_yaw_joint"), joint_told("LeftArm")
    ('left shoulder yaw', 'LeftArm')
    """
    return name.removesuffix("_joint").replace("_", " ")


def _lengths(values: Array, size: int) -> Array:
    """(N, joints) of vectors of ``size`` channels each."""
    return np.abs(values) if size == 1 else np.linalg.norm(values.reshape(len(values), -1, size), axis=2)


def _span(result: Retimed, change: Array) -> tuple[float, float]:
    """The stretch about the largest change, all of it inside the dance."""
    knots = result.demand.wish.knots
    middle = float(knots.times[int(change.argmax())])
    start = max(min(middle - SECONDS / 2, knots.end - SECONDS), knots.start)
    return start, min(start + SECONDS, knots.end)


def _inside(result: Retimed, span: tuple[float, float]) -> tuple[float, float]:
    knots = result.demand.wish.knots
    start, end = max(span[0], knots.start), min(span[1], knots.end)
    if not start < end:
        raise OnbeatError(
            f"from {span[0]:g} to {span[1]:g} s there is nothing of the dance; it lasts from {knots.start:.2f} to "
            f"{knots.end:.2f} s"
        )
    return start, end


def _main_axis(result: Retimed, channels: slice, start: float, end: float) -> Array:
    """The direction in which the wish's vector moves most, its largest component positive."""
    if result.source.size == 1:
        return np.ones(1)
    wish = result.demand.wish
    values = wish(np.linspace(start, end, 200))[:, channels]
    axis = np.linalg.svd(values - values.mean(axis=0), full_matrices=False)[2][0]
    return axis * np.sign(axis[np.abs(axis).argmax()])
