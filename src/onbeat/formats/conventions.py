"""Axes and units of motion files: what comes in becomes metres, Z up; what goes out is turned back.

A file with Y up is turned by 90° about X, ``(x, y, z) → (x, −z, y)``, one with X up by ``(x, y, z) → (y, z, x)``;
where a negative axis is up, half a turn brings it up first. These are proper rotations Q, so left stays left. Offsets
and positions turn as vectors; local rotations are conjugated, ``q → Q q Q⁻¹``, so that the rest pose turns with them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from onbeat._shapes import Positions, Rotations
from onbeat.errors import FormatError
from onbeat.motion import Motion

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "cmu": 0.0254 / 0.45, "dm": 0.1, "ft": 0.3048}
"""Metres in one unit; ``cmu`` is the length of CMU's files and of their BVH conversions."""


Up = Literal["x", "y", "z", "-x", "-y", "-z"]
"""The axis of a file that points up; a negative one points down."""
UP_AXES: tuple[Up, ...] = ("x", "y", "z", "-x", "-y", "-z")
_HALF_TURN = {"x": np.array([-1.0, -1.0, 1.0]), "y": np.array([1.0, -1.0, -1.0]), "z": np.array([1.0, -1.0, -1.0])}
"""Half a turn about another axis, which turns each axis over."""


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
            raise FormatError(f"the up axis {self.up!r} is not known; x, y or z is expected, or -x, -y or -z")
        if self.unit not in UNITS:
            raise FormatError(f"the unit {self.unit!r} is not known; {', '.join(UNITS)} are expected")

    @property
    def metres(self) -> float:
        """Metres in one unit."""
        return UNITS[self.unit]


def z_up_vectors(v: Positions, up: Up = "y") -> Positions:
    """Vectors (..., 3) of a file whose ``up`` axis points up, with Z up; Y: ``(x, y, z) → (x, −z, y)``.

    Examples
    --------
    >>> z_up_vectors(np.array([0.0, -1.7, 0.2]), "-y").tolist()
    [0.0, 0.2, 1.7]
    """
    if up[0] == "-":
        v = v * _HALF_TURN[up[1]]
    if up[-1] == "y":
        return np.stack((v[..., 0], -v[..., 2], v[..., 1]), axis=-1)
    return v[..., [1, 2, 0]] if up[-1] == "x" else np.asarray(v)


def up_vectors(v: Positions, up: Up) -> Positions:
    """Vectors (..., 3) with Z up for a file whose ``up`` axis points up; the inverse of :func:`z_up_vectors`.

    Examples
    --------
    >>> [up_vectors(z_up_vectors(np.array([1.0, 2.0, 3.0]), up), up).tolist() for up in ("x", "-y")]
    [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]
    """
    if up[-1] == "y":
        v = np.stack((v[..., 0], v[..., 2], -v[..., 1]), axis=-1)
    elif up[-1] == "x":
        v = v[..., [2, 0, 1]]
    return v * _HALF_TURN[up[1]] if up[0] == "-" else np.asarray(v)


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
