"""Joint angles of a motion in other forms: Euler angles of any order, rotation vectors; without jumps over time."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.errors import FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def euler_angles(motion: Motion, order: str = "ZXY") -> Array:
    """(F, J, 3) radians about moving axes in ``order``, each joint's without jumps from frame to frame.

    Of the two triples of each rotation, ``(a, b, c)`` and ``(a + π, π − b, c + π)``, and of their whole turns, each
    frame takes what is nearest to the frame before; angles may so go beyond ±π.

    Raises
    ------
    FormatError
        If the order is none of :data:`ORDERS`.

    Examples
    --------
    >>> spin = rot.about(np.array([0, 0, 1.0]), np.radians(np.arange(0, 720, 30)))[:, None]
    >>> top = Motion(Skeleton(("top",), [-1], [[0, 0, 0]]), spin, np.zeros((24, 3)), fps=30)
    >>> float(np.degrees(euler_angles(top)[-1, 0, 0]).round(6))
    690.0
    """
    _check(order)
    plain = rot.to_euler(order, motion.rotations)
    other = np.stack((plain[..., 0] + np.pi, np.pi - plain[..., 1], plain[..., 2] + np.pi), axis=-1)
    out = np.empty_like(plain)
    before = np.zeros(plain.shape[1:])
    for frame in range(len(plain)):
        near, far = (_whole_turns(a, before) for a in (plain[frame], other[frame]))
        closer = np.abs(near - before).sum(-1) <= np.abs(far - before).sum(-1)
        out[frame] = before = np.where(closer[:, None], near, far)
    return out


def from_euler_angles(
    skeleton: Skeleton, angles: Array, root_positions: Positions, fps: float, order: str = "ZXY", name: str = ""
) -> Motion:
    """The motion whose joints have these angles (F, J, 3) in radians; the inverse of :func:`euler_angles`."""
    _check(order)
    return Motion(skeleton, rot.from_euler(order, np.asarray(angles, np.float64)), root_positions, fps, name)


def rotation_vectors(motion: Motion) -> Array:
    """(F, J, 3) axis times angle in radians, without jumps: beyond π the vector grows on instead of turning over."""
    q = rot.continuous(motion.rotations)
    length = np.linalg.norm(q[..., 1:], axis=-1)
    angle = 2 * np.arctan2(length, q[..., 0])
    axis = q[..., 1:] / np.maximum(length, 1e-300)[..., None]
    out = np.empty(axis.shape)
    before = np.zeros(axis.shape[1:])
    for frame in range(len(out)):
        along = np.sum(before * axis[frame], axis=-1)
        turned = angle[frame] + 2 * np.pi * np.rint((along - angle[frame]) / (2 * np.pi))
        # Without a rotation there is no axis: a whole turn keeps the one it had.
        unit = before / np.maximum(np.linalg.norm(before, axis=-1, keepdims=True), 1e-300)
        whole = np.rint(np.linalg.norm(before, axis=-1) / (2 * np.pi))[:, None] * 2 * np.pi * unit
        out[frame] = before = np.where(length[frame][:, None] < 1e-12, whole, turned[:, None] * axis[frame])
    return out


def _whole_turns(angles: Array, before: Array) -> Array:
    return angles + 2 * np.pi * np.rint((before - angles) / (2 * np.pi))


def _check(order: str) -> None:
    if order not in ORDERS:
        raise FormatError(f"the order of axes {order!r} is not one of {', '.join(ORDERS)}")
