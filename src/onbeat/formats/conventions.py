"""Axes and units of motion files: what comes in becomes metres, Z up; what goes out is turned back.

A file with Y up is turned by 90° about X, ``(x, y, z) → (x, −z, y)``, one with X up by ``(x, y, z) → (y, z, x)``:
proper rotations Q, so left stays left. Offsets and positions turn as vectors; local rotations are conjugated,
``q → Q q Q⁻¹``, so that the rest pose turns with them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.errors import BodyError, FormatError
from onbeat.formats.notes import tell
from onbeat.motion import Body, Motion, Skeleton

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "cmu": 0.0254 / 0.45}
"""Metres in one unit; ``cmu`` is the length of CMU's files and of their BVH conversions."""


Up = Literal["x", "y", "z"]
"""The axis of a file that points up."""
UP_AXES: tuple[Up, ...] = ("x", "y", "z")


@dataclass(frozen=True)
class Convention:
    """Which axis of a file points up, and its unit of length (one of :data:`UNITS`).

    Raises
    ------
    FormatError
        If the axis or the unit is not known.
    """

    up: Up = "y"
    unit: str = "cm"

    def __post_init__(self) -> None:
        if self.up not in UP_AXES:
            raise FormatError(f"the up axis {self.up!r} is not known; x, y or z is expected")
        if self.unit not in UNITS:
            raise FormatError(f"the unit {self.unit!r} is not known; {', '.join(UNITS)} are expected")

    @property
    def metres(self) -> float:
        """Metres in one unit."""
        return UNITS[self.unit]


def z_up_vectors(v: Positions, up: Up = "y") -> Positions:
    """Vectors (..., 3) of a file whose ``up`` axis points up, with Z up; Y: ``(x, y, z) → (x, −z, y)``."""
    if up == "y":
        return np.stack((v[..., 0], -v[..., 2], v[..., 1]), axis=-1)
    return v[..., [1, 2, 0]] if up == "x" else np.asarray(v)


def up_vectors(v: Positions, up: Up) -> Positions:
    """Vectors (..., 3) with Z up for a file whose ``up`` axis points up; the inverse of :func:`z_up_vectors`.

    Examples
    --------
    >>> [up_vectors(z_up_vectors(np.array([1.0, 2.0, 3.0]), up), up).tolist() for up in ("x", "y")]
    [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]
    """
    if up == "y":
        return np.stack((v[..., 0], v[..., 2], -v[..., 1]), axis=-1)
    return v[..., [2, 0, 1]] if up == "x" else np.asarray(v)


def turn_in_place(v: Positions, up: Up, scale: float = 1.0) -> None:
    """:func:`z_up_vectors` times ``scale``, written over ``v`` itself a block of frames at a time."""
    step = max(1, 100_000 // max(1, v[0].size)) if len(v) else 1
    for at in range(0, len(v), step):
        v[at : at + step] = z_up_vectors(v[at : at + step], up) * scale


def unit_metres(unit: str) -> float:
    """Metres in one of :data:`UNITS`; a ``FormatError`` lists them."""
    return Convention("z", unit).metres


def y_up_vectors(v: Positions) -> Positions:
    """Vectors (..., 3) with Z up for a Y-up file: ``(x, y, z) → (x, z, −y)``."""
    return up_vectors(v, "y")


def z_up_rotations(q: Rotations, up: Up = "y") -> Rotations:
    """Rotations (..., 4) of such a file with Z up: the conjugation turns the vector part only."""
    return q if up == "z" else np.concatenate((q[..., :1], z_up_vectors(q[..., 1:], up)), axis=-1)


def up_rotations(q: Rotations, up: Up) -> Rotations:
    """Rotations (..., 4) with Z up for a file whose ``up`` axis points up."""
    return q if up == "z" else np.concatenate((q[..., :1], up_vectors(q[..., 1:], up)), axis=-1)


def y_up_rotations(q: Rotations) -> Rotations:
    """Rotations (..., 4) with Z up for a Y-up file."""
    return up_rotations(q, "y")


def z_up_motion(motion: Motion, metres: float, up: Up) -> Motion:
    """A motion as a file tells it, in metres and with Z up."""
    s, t = motion.skeleton, motion.translations
    skeleton = s.replace(offsets=z_up_vectors(s.offsets, up) * metres)
    translations = None if t is None else z_up_vectors(t, up) * metres
    path = z_up_vectors(motion.root_positions, up) * metres
    return Motion(skeleton, z_up_rotations(motion.rotations, up), path, motion.fps, motion.name, translations)


def tree_span(skeleton: Skeleton) -> float:
    """The longest way along the bones from one joint to another, in the skeleton's unit.

    It needs no rest pose that looks like a body. From head to toe or hand to foot it is 1.1 to 1.3 body heights.
    """
    deepest, span = np.zeros(len(skeleton)), 0.0
    for joint in range(len(skeleton) - 1, 0, -1):
        parent, reach = skeleton.parents[joint], deepest[joint] + skeleton.bone_lengths[joint]
        span = max(span, float(deepest[parent] + reach))
        deepest[parent] = max(deepest[parent], reach)
    return span


def guessed_unit(skeleton: Skeleton) -> str:
    """The unit in which a skeleton is the size of a body; BVH stores none.

    By :func:`tree_span`: up to 15 metres (giants are drawn, dwarfs of centimetres are not); to 60 the CMU scale (a body
    of 30 units); to 400 centimetres; beyond millimetres. Skeletons without length are taken as centimetres.
    """
    span = tree_span(skeleton)
    unit = "m" if 0 < span < 15 else "cmu" if 15 <= span < 60 else "cm" if span < 400 else "mm"
    tell("unit", unit, f"the longest way along the bones is {span:g} units, so {span * UNITS[unit]:.2f} m")
    return unit


def guessed_up(motion: Motion) -> tuple[Up, str]:
    """The axis along which the head is over the ankles in the frames themselves, and why; Y where that does not tell.

    X is never guessed: hardly any file has it up, and in many somebody lies down.
    """
    try:
        body = Body.of(motion.skeleton)
    except BodyError:
        return "y", "no body with head and feet is recognised; Y is usual"
    some = motion[:: max(1, len(motion) // 32)]
    top = some.positions[:, body["head"] if "head" in body else body["chest"]]
    feet = some.positions[:, body.indices("left_ankle", "right_ankle")].mean(1)
    mean: Array = (top - feet).mean(0)
    if mean[2] > 2 * abs(mean[1]):
        lowest = np.abs(some.positions[..., 1:].min((0, 1)))
        if _stands_along_y(body) and lowest[0] < 0.5 * lowest[1]:
            return "y", "the body lies on a floor at 0; it stands along Y in its rest pose"
        return "z", "the head is over the feet along it"
    clear = mean[1] > np.abs(mean[[0, 2]]).max()
    return "y", "the head is over the feet along it" if clear else "no axis is clearly upright; Y is usual"


def _stands_along_y(body: Body) -> bool:
    rest = body.skeleton.rest_positions
    top, feet = body["head"] if "head" in body else body["chest"], body.indices("left_ankle", "right_ankle")
    up = rest[top] - rest[feet].mean(0)
    return bool(up[1] > 2 * np.abs(up[[0, 2]]).max())
