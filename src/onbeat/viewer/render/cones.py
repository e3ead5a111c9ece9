"""Rays against tapering capsules, compiled.

A tapering capsule is the union of the spheres along a line from ``a`` to ``b``, ``n`` the unit vector between and
``L`` their distance, whose radius falls steadily from ``ra`` to ``rb``. With ``k = (ra - rb) / L`` and
``c² = 1 - k²``, and ``w = p - a``, ``X = w·n - k ra``, its side is

    c² (|w|² - ra²) = X²    for 0 < X < c² L,

and beyond that it ends in the two spheres; the sphere that touches the side at ``p`` stands at ``a + (X / c²) n``.
All points are in the camera's frame (right, up, forward), so that a ray from the camera is ``p = t d`` with
``d = (x, y, 1)`` and ``t`` is the depth. ``CONE`` columns hold what does not depend on the ray.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Float32, Ints, Positions

AX, AY, AZ, NX, NY, NZ, LENGTH, RADIUS, TAPER, SQUARE, SIDE, END_A, END_B, RADIUS_B, SLOPE = range(15)
"""Columns of a cone: a, n, L, ra, k, c², the side's constant term, those of both spheres, rb, k / c."""
NEAR = 0.05
"""Metres: nothing nearer to the camera than this is drawn."""


def cones_from(ends: Positions, radii: Array) -> Array:
    """(N, 15) cones from both ends (N, 2, 3) in the camera's frame and radii (N, 2).

    Where one end's sphere holds the other's, the larger sphere is all there is.
    """
    a, b = ends[:, 0], ends[:, 1]
    ra, rb = radii[:, 0], radii[:, 1]
    length = np.linalg.norm(b - a, axis=1)
    ball = length <= np.abs(ra - rb) + 1e-6
    a = np.where((ball & (rb > ra))[:, None], b, a)
    ra = np.where(ball, np.maximum(ra, rb), ra)
    rb = np.where(ball, ra, rb)
    axis = np.where(ball[:, None], 0.0, (b - a) / np.maximum(length, 1e-9)[:, None])
    length = np.where(ball, 0.0, length)
    b = a + axis * length[:, None]
    taper = np.where(ball, 0.0, (ra - rb) / np.maximum(length, 1e-9))
    square = 1 - taper**2
    start = -(a * axis).sum(1) - taper * ra
    end_a = (a * a).sum(1) - ra**2
    side = square * end_a - start**2
    columns = (a, axis, length[:, None], ra[:, None], taper[:, None], square[:, None], side[:, None])
    end_b, slope = (b * b).sum(1) - rb**2, taper / np.sqrt(np.maximum(square, 1e-12))
    return np.hstack((*columns, end_a[:, None], end_b[:, None], rb[:, None], slope[:, None]))


@numba.njit(cache=True, nogil=True)
def hit(cones: Array, i: int, x: float, y: float) -> float:
    """Depth at which the ray (x, y, 1) enters cone ``i``, or infinity."""
    nx, ny, nz, taper = cones[i, NX], cones[i, NY], cones[i, NZ], cones[i, TAPER]
    dd = x * x + y * y + 1.0
    da = cones[i, AX] * x + cones[i, AY] * y + cones[i, AZ]
    dn = nx * x + ny * y + nz
    start = -(cones[i, AX] * nx + cones[i, AY] * ny + cones[i, AZ] * nz) - taper * cones[i, RADIUS]
    qa = cones[i, SQUARE] * dd - dn * dn
    qb = -cones[i, SQUARE] * da - start * dn
    root = qb * qb - qa * cones[i, SIDE]
    if root < 0.0:
        return np.inf
    root = np.sqrt(root)
    far = cones[i, SQUARE] * cones[i, LENGTH]
    if qa > 1e-12:
        t = (-qb - root) / qa
        reach = start + t * dn
        if 0.0 < reach < far:
            return t
    elif qa < -1e-12:  # The ray runs within the taper: both roots may be on the right half of the double cone.
        for sign in (1.0, -1.0):
            t = (-qb + sign * root) / qa
            reach = start + t * dn
            if 0.0 < reach < far and t > 0.0:
                return t
    best = np.inf
    ball = da * da - dd * cones[i, END_A]
    if ball > 0.0:
        best = (da - np.sqrt(ball)) / dd
    db = da + cones[i, LENGTH] * dn
    ball = db * db - dd * cones[i, END_B]
    if ball > 0.0:
        best = min(best, (db - np.sqrt(ball)) / dd)
    return best


@numba.njit(cache=True, nogil=True)
def off_axis(cones: Array, i: int, px: float, py: float, pz: float) -> tuple[float, float, float, float]:
    """From the middle of the nearest sphere of cone ``i`` to a point, and that sphere's radius."""
    wx, wy, wz = px - cones[i, AX], py - cones[i, AY], pz - cones[i, AZ]
    axial = wx * cones[i, NX] + wy * cones[i, NY] + wz * cones[i, NZ]
    square = wx * wx + wy * wy + wz * wz - axial * axial
    # The nearest sphere stands further along by the taper's slope times the distance from the axis.
    along = axial - cones[i, SLOPE] * np.sqrt(max(square, 0.0))
    along = min(max(along, 0.0), cones[i, LENGTH])
    radius = cones[i, RADIUS] - cones[i, TAPER] * along
    return wx - along * cones[i, NX], wy - along * cones[i, NY], wz - along * cones[i, NZ], radius


@numba.njit(cache=True, nogil=True)
def outward(cones: Array, i: int, px: float, py: float, pz: float) -> tuple[float, float, float, float]:
    """Distance from a point to the skin of cone ``i``, and the outward unit normal there."""
    wx, wy, wz, radius = off_axis(cones, i, px, py, pz)
    long = np.sqrt(wx * wx + wy * wy + wz * wz) + 1e-12
    return long - radius, wx / long, wy / long, wz / long


@numba.njit(cache=True, nogil=True)
def gap(cones: Array, i: int, px: float, py: float, pz: float, most: float) -> float:
    """About the distance from a point to the skin of cone ``i`` (without the taper's slant), at most ``most``."""
    wx, wy, wz = px - cones[i, AX], py - cones[i, AY], pz - cones[i, AZ]
    along = min(max(wx * cones[i, NX] + wy * cones[i, NY] + wz * cones[i, NZ], 0.0), cones[i, LENGTH])
    wx -= along * cones[i, NX]
    wy -= along * cones[i, NY]
    wz -= along * cones[i, NZ]
    square = wx * wx + wy * wy + wz * wz
    radius = cones[i, RADIUS] - cones[i, TAPER] * along
    return most if square >= (radius + most) ** 2 else np.sqrt(square) - radius


@numba.njit(cache=True, nogil=True)
def spans(cones: Array, focal: float, cx: float, cy: float, width: int, height: int) -> Ints:
    """(N, 4) first and past-the-last column and row that each cone may cover; empty where it is not seen."""
    boxes = np.zeros((len(cones), 4), np.int64)
    for i in range(len(cones)):
        left, right, top, bottom = np.inf, -np.inf, np.inf, -np.inf
        for end in range(2):
            along = cones[i, LENGTH] * end
            r = cones[i, RADIUS] if end == 0 else cones[i, RADIUS_B]
            x, y, z = (
                cones[i, AX] + along * cones[i, NX],
                cones[i, AY] + along * cones[i, NY],
                cones[i, AZ] + along * cones[i, NZ],
            )
            if z - r < NEAR:
                if z + r > NEAR:
                    left, right, top, bottom = 0.0, float(width), 0.0, float(height)
                continue
            zz = z * z - r * r
            across, upward = r * np.sqrt(x * x + zz), r * np.sqrt(y * y + zz)
            left = min(left, cx + focal * (x * z - across) / zz)
            right = max(right, cx + focal * (x * z + across) / zz)
            top = min(top, cy - focal * (y * z + upward) / zz)
            bottom = max(bottom, cy - focal * (y * z - upward) / zz)
        if left < right:
            boxes[i, 0] = min(max(int(np.floor(left)), 0), width)
            boxes[i, 1] = min(max(int(np.ceil(right)) + 1, 0), width)
            boxes[i, 2] = min(max(int(np.floor(top)), 0), height)
            boxes[i, 3] = min(max(int(np.ceil(bottom)) + 1, 0), height)
    return boxes


@numba.njit(cache=True, nogil=True)
def cast(
    cones: Array,
    boxes: Ints,
    focal: float,
    cx: float,
    cy: float,
    origin: tuple[int, int],
    shape: tuple[int, int],
    fine: int,
) -> tuple[Float32, NDArray[np.int16]]:
    """Depth and the number of the nearest cone (-1: none) at ``fine`` × ``fine`` points of each pixel.

    ``origin`` is the column and row of the first pixel, ``shape`` the rows and columns looked at.
    """
    depth = np.full((shape[0] * fine, shape[1] * fine), np.inf, np.float32)
    nearest = np.full((shape[0] * fine, shape[1] * fine), -1, np.int16)
    for i in range(len(cones)):
        for row in range((boxes[i, 2] - origin[1]) * fine, (boxes[i, 3] - origin[1]) * fine):
            y = (cy - (origin[1] + (row + 0.5) / fine)) / focal
            met = False
            for column in range((boxes[i, 0] - origin[0]) * fine, (boxes[i, 1] - origin[0]) * fine):
                x = ((origin[0] + (column + 0.5) / fine) - cx) / focal
                t = hit(cones, i, x, y)
                if t < np.inf:
                    met = True
                elif met:  # A cone bulges everywhere: once a row has left it, it does not come back.
                    break
                if NEAR < t < depth[row, column]:
                    depth[row, column] = t
                    nearest[row, column] = i
    return depth, nearest
