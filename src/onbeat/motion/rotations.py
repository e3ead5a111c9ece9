"""Rotations as unit quaternions wxyz, on arrays of any leading shape.

q and −q are the same rotation; functions that interpolate take the shorter way. Matrices, and the way back to Euler
angles, go through SciPy's ``Rotation``.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from onbeat._shapes import Array, Positions, Rotations

IDENTITY: Rotations = np.array([1.0, 0.0, 0.0, 0.0])
IDENTITY.setflags(write=False)


def multiply(a: Rotations, b: Rotations) -> Rotations:
    """Hamilton product: first ``b``, then ``a``; (..., 4) with broadcasting."""
    aw, ax, ay, az = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bw, bx, by, bz = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    out = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    out[..., 0] = aw * bw - ax * bx - ay * by - az * bz
    out[..., 1] = aw * bx + ax * bw + ay * bz - az * by
    out[..., 2] = aw * by - ax * bz + ay * bw + az * bx
    out[..., 3] = aw * bz + ax * by - ay * bx + az * bw
    return out


def inverse(q: Rotations) -> Rotations:
    """The inverse of unit quaternions: the conjugate."""
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def rotate(q: Rotations, v: Positions) -> Positions:
    """Vectors (..., 3) turned by rotations (..., 4): ``v + 2w(u×v) + 2u×(u×v)``."""
    u = q[..., 1:]
    t = 2.0 * _cross(u, v)
    return v + q[..., :1] * t + _cross(u, t)


def _cross(a: Array, b: Array) -> Array:
    """As ``np.cross``, to the bit; a third of its time on few vectors."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    out[..., 0] = ay * bz - az * by
    out[..., 1] = az * bx - ax * bz
    out[..., 2] = ax * by - ay * bx
    return out


def normalise(q: Rotations) -> Rotations:
    """Unit length; a zero quaternion becomes the identity."""
    length = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(length > 1e-12, q / np.maximum(length, 1e-12), IDENTITY)


def continuous(q: Rotations) -> Rotations:
    """Signs along the first axis chosen so that neighbours are on the same half of the sphere."""
    flips = np.sum(q[1:] * q[:-1], axis=-1) < 0
    signs = np.where(np.cumsum(flips, axis=0) % 2 == 1, -1.0, 1.0)
    out = q.copy()
    out[1:] *= signs[..., None]
    return out


def slerp(a: Rotations, b: Rotations, t: Array | float) -> Rotations:
    """Spherical interpolation by the shorter way; ``t`` in 0…1, broadcast against the leading shape."""
    dot = np.sum(a * b, axis=-1)
    b = np.where((dot < 0)[..., None], -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0.0, 1.0))
    t = np.broadcast_to(np.asarray(t, np.float64), angle.shape)
    sine = np.sin(angle)
    near = sine < 1e-6
    safe = np.where(near, 1.0, sine)
    wa = np.where(near, 1.0 - t, np.sin((1.0 - t) * angle) / safe)
    wb = np.where(near, t, np.sin(t * angle) / safe)
    return normalise(wa[..., None] * a + wb[..., None] * b)


def log(q: Rotations) -> Array:
    """Rotation vectors (..., 3): axis times angle in radians, angle in 0…π."""
    q = np.where(q[..., :1] < 0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    return q[..., 1:] * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0)


def exp(v: Array) -> Rotations:
    """Unit quaternions from rotation vectors (axis times angle in radians)."""
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.concatenate((np.cos(angle / 2), v * 0.5 * np.sinc(angle / (2 * np.pi))), axis=-1)


def angle_between(a: Rotations, b: Rotations) -> Array:
    """The angle, 0…π radians, of the rotation that takes ``a`` to ``b``."""
    d = multiply(inverse(a), b)
    return 2.0 * np.arctan2(np.linalg.norm(d[..., 1:], axis=-1), np.abs(d[..., 0]))


def between(a: Positions, b: Positions) -> Rotations:
    """The smallest rotation that takes the direction of ``a`` to that of ``b``; (..., 3) to (..., 4).

    Opposite directions turn by π about some axis across ``a``; a zero vector gives the identity.
    """
    a, b = np.broadcast_arrays(np.asarray(a, np.float64), np.asarray(b, np.float64))
    a = a / np.maximum(np.linalg.norm(a, axis=-1, keepdims=True), 1e-12)
    b = b / np.maximum(np.linalg.norm(b, axis=-1, keepdims=True), 1e-12)
    w = 1.0 + np.sum(a * b, axis=-1, keepdims=True)
    across = np.where(np.abs(a[..., :1]) < 0.9, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    flat = np.linalg.norm(a, axis=-1, keepdims=True) * np.linalg.norm(b, axis=-1, keepdims=True) > 0.5
    opposite = (w < 1e-9) & flat
    v = np.where(opposite, np.cross(a, across), np.cross(a, b))
    return normalise(np.concatenate((np.where(opposite, 0.0, w), v), axis=-1))


def about(axis: Array, angle: Array | float) -> Rotations:
    """Rotations by ``angle`` (...) radians about unit axes (..., 3), broadcast against each other."""
    half = np.asarray(angle, np.float64)[..., None] / 2
    vector = np.sin(half) * np.asarray(axis, np.float64)
    return np.concatenate((np.broadcast_to(np.cos(half), (*vector.shape[:-1], 1)), vector), axis=-1)


def yaw(angle: Array | float) -> Rotations:
    """Rotations by ``angle`` radians about the vertical."""
    half = np.asarray(angle, np.float64) / 2
    zero = np.zeros_like(half)
    return np.stack((np.cos(half), zero, zero, np.sin(half)), axis=-1)


def from_matrix(matrix: Array) -> Rotations:
    """Unit quaternions from rotation matrices (..., 3, 3) whose columns are the turned axes."""
    flat = Rotation.from_matrix(matrix.reshape(-1, 3, 3)).as_quat(scalar_first=True)
    return flat.reshape(*matrix.shape[:-2], 4)


def to_matrix(q: Rotations) -> Array:
    """Rotation matrices (..., 3, 3) from unit quaternions."""
    return Rotation.from_quat(q.reshape(-1, 4), scalar_first=True).as_matrix().reshape(*q.shape[:-1], 3, 3)


def from_euler(order: str, angles: Array) -> Rotations:
    """Quaternions from Euler angles (..., n) in radians, turned about moving axes in ``order`` ("ZXY").

    Each turn multiplies from the right: with half the angle's cosine c and sine s about axis a,
    ``w' = wc − v_a s``, ``v_a' = v_a c + ws``, ``v_b' = v_b c + v_c s``, ``v_c' = v_c c − v_b s``.
    """
    half = np.moveaxis(angles, -1, 0) / 2
    cosine, sine = np.cos(half), np.sin(half)
    q = np.zeros((4, *angles.shape[:-1]))
    q[0] = 1
    for axis, c, s in zip(order.upper(), cosine, sine, strict=True):
        a = "XYZ".index(axis)
        a, b, d = 1 + a, 1 + (a + 1) % 3, 1 + (a + 2) % 3
        q[0], q[a] = q[0] * c - q[a] * s, q[a] * c + q[0] * s
        q[b], q[d] = q[b] * c + q[d] * s, q[d] * c - q[b] * s
    return np.ascontiguousarray(np.moveaxis(q, 0, -1))


def to_euler(order: str, q: Rotations) -> Array:
    """Euler angles (..., 3) in radians, −π…π, about moving axes in ``order``; at gimbal lock the third angle is zero.

    After Bernardes & Viollet 2022 (doi:10.1371/journal.pone.0276302): for axes k, j, i with parity ε and
    ``a = w − q_j, b = q_i + ε q_k, c = w + q_j, d = ε q_k − q_i`` the middle angle is
    ``2 atan2(|c, d|, |a, b|) − π/2``, sum and difference of the others are ``2 atan2(b, a)`` and ``2 atan2(d, c)``.
    It loses no digits near gimbal lock. Orders that come back to the first axis (ZXZ) take ``a, b, c, d = w, q_i, q_j,
    ε q_k`` and no ``π/2``.

    Examples
    --------
    >>> np.degrees(to_euler("ZXY", from_euler("ZXY", np.radians([10.0, -20, 30])))).round(9).tolist()
    [10.0, -20.0, 30.0]
    """
    i, j, k = ("XYZ".index(axis) for axis in order.upper()[::-1])
    proper = i == k
    k = 3 - i - j if proper else k
    parity = (i - j) * (j - k) * (k - i) // 2
    w, first, middle, last = q[..., 0], q[..., 1 + i], q[..., 1 + j], q[..., 1 + k] * parity
    if proper:
        a, b, c, d = w, first, middle, last
    else:
        a, b, c, d = w - middle, first + last, w + middle, last - first
    tilt = 2 * np.arctan2(np.hypot(c, d), np.hypot(a, b))
    total, difference = np.arctan2(b, a), np.arctan2(d, c)
    low, high = tilt < 1e-7, tilt > np.pi - 1e-7
    angles = np.empty((*q.shape[:-1], 3))
    angles[..., 0] = np.where(low, 2 * total, np.where(high, 2 * difference, total + difference))
    angles[..., 2] = np.where(low | high, 0.0, total - difference)
    angles[..., 1] = tilt if proper else tilt - np.pi / 2
    if not proper:
        angles[..., 0] *= parity
    return angles - 2 * np.pi * np.rint(angles / (2 * np.pi))
