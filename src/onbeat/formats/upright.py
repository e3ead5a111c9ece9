"""Which axis of a file points up, seen from the bodies in it: along which they stand, and on which there is a floor."""

from __future__ import annotations

from typing import cast

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.errors import BodyError
from onbeat.formats.conventions import Up
from onbeat.motion import Body, Motion


def clear_axis(rise: Array) -> str:
    """The axis along which a vector (3,) rises at least twice as far as along the others, with its sign; "" if none.

    Examples
    --------
    >>> clear_axis(np.array([0.1, -1.6, 0.3])), clear_axis(np.array([1.0, 1.0, 0.0]))
    ('-y', '')
    """
    lengths = np.abs(rise)
    axis = int(np.argmax(lengths))
    if lengths[axis] <= 2 * np.delete(lengths, axis).max():
        return ""
    return ("-" if rise[axis] < 0 else "+") + "xyz"[axis]


def bounds(some: Positions) -> tuple[Array, Array]:
    """(F, 3) the lowest and the highest coordinates of each frame; points that are NaN do not count."""
    seen = np.isfinite(some)
    return np.where(seen, some, np.inf).min(1), np.where(seen, some, -np.inf).max(1)


def has_floor(some: Positions, axis: str) -> bool:
    """Whether the lowest point along an axis keeps within 8 % of the largest extent, and that within 10 % of zero.

    Parameters
    ----------
    some : (F, N, 3) points, in each frame at least one that is no NaN.
    axis : as ``+y``.
    """
    if not len(some):
        return False
    low, high = bounds(some)
    largest = float(np.median(high - low, axis=0).max())
    column = "xyz".index(axis[1])
    lowest = -high[:, column] if axis[0] == "-" else low[:, column]
    steady = np.ptp(np.quantile(lowest, [0.1, 0.9])) < 0.08 * largest
    return bool(steady and abs(np.median(lowest)) < 0.1 * largest)


def guessed_up(motion: Motion) -> tuple[Up, str]:
    """The axis along which a body stands, at rest and in the frames, and why; Y where neither tells.

    A rest pose nearly always stands, a dancer may lie, crawl or stand on the hands: where both tell and differ, the
    frames are believed only where there is a floor along their axis and none along that of the rest pose (the root
    of some files turns a body of another axis upright). X and negative axes are believed where both agree; hardly any
    file has them, and in many somebody lies.

    Parameters
    ----------
    motion : as the file tells it, in its own axes and unit; some frames are enough.
    """
    try:
        body = Body.of(motion.skeleton)
    except BodyError:
        return "y", "no body with head and feet is recognised; Y is usual"
    some = motion[:: max(1, len(motion) // 32)].positions
    shown, rest = clear_axis(_rise(body, some).mean(0)), _rest_axis(body)
    if shown and shown == rest:
        return _up(shown), "the head is over the feet along it"
    usual = ("+y", "+z")
    if rest in usual:
        if shown in usual and has_floor(some, shown) and not has_floor(some, rest):
            return _up(shown), f"the head is over the feet along it, though at rest the body stands along {rest[1]}"
        lies = f", though it lies, or stands head down, along {_up(shown)} in the frames" if shown else ""
        return _up(rest), f"the body stands along it in its rest pose{lies}"
    if shown in usual:
        other = usual[shown == "+y"]
        if has_floor(some, other) and not has_floor(some, shown):
            return _up(other), f"there is a floor along it, on which the body lies along {shown[1]}"
        return _up(shown), "the head is over the feet along it"
    if shown in ("-y", "-z") and has_floor(some, shown) and not has_floor(some, "+" + shown[1]):
        return _up(shown), "the head is over the feet along it, on a floor at its zero"
    return "y", "no axis is clearly upright; Y is usual"


def _up(axis: str) -> Up:
    return cast("Up", axis.removeprefix("+"))


def _rise(body: Body, positions: Positions) -> Array:
    """(..., 3) from the ankles to the head."""
    top = positions[..., body["head"] if "head" in body else body["chest"], :]
    return top - positions[..., body.indices("left_ankle", "right_ankle"), :].mean(-2)


def _rest_axis(body: Body) -> str:
    """The axis along which the rest pose stands, its legs and its trunk; "" where it is no standing body.

    In many files all bones lie along one axis at rest, legs and trunk alike.
    """
    rest = body.skeleton.rest_positions
    feet, hips, shoulders = (
        rest[body.indices(f"left_{part}", f"right_{part}")].mean(0) for part in ("ankle", "hip", "shoulder")
    )
    legs, trunk = clear_axis(hips - feet), clear_axis(shoulders - hips)
    return legs if legs == trunk else ""
