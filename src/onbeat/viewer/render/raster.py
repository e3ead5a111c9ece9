"""A small software renderer of a dancer: the same input gives the same bytes on every machine, without a display.

Rays meet tapering capsules (``cones.py``) inside each capsule's box on the screen; the nearest wins. Where capsules
meet, their normals run into each other, so that the body looks like one skin. The floor is in ``floor.py``, the
shadow on it in ``shadow.py``.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Bools, Float32, Ints, Positions
from onbeat.viewer.figure import Figure
from onbeat.viewer.render.camera import Camera, Size
from onbeat.viewer.render.cones import (
    AX,
    AY,
    AZ,
    LENGTH,
    NX,
    NY,
    NZ,
    RADIUS,
    RADIUS_B,
    cast,
    cones_from,
    gap,
    off_axis,
    outward,
    spans,
)
from onbeat.viewer.render.floor import paint_backdrop
from onbeat.viewer.render.shadow import shadow_map
from onbeat.viewer.render.stage import TO_LINEAR, TO_SRGB, Stage, linear

BLEND, HOLLOW, SHADE = 0.05, 0.09, 0.1
"""Metres: how far normals run together, and how far off the skin ambient and key light look for what hides them."""
PATCH = 0.015
"""Metres: as far as this from a point of the skin, the same cones are looked at as there."""


def render_frame(
    positions: Positions, figure: Figure, camera: Camera, size: Size = (1280, 720), stage: Stage | None = None
) -> np.ndarray:
    """A picture (H, W, 3) uint8 of a figure standing on a floor.

    Parameters
    ----------
    positions : (J, 3) metres, joint positions in the world.
    figure, camera, stage : what is seen, from where, in which light.
    size : width and height in pixels.

    Examples
    --------
    >>> from onbeat.motion import Skeleton
    >>> stick = Figure.of(Skeleton(("foot", "head"), [-1, 0], [[0, 0, 0], [0, 0, 1.7]]))
    >>> camera = Camera((0.0, -5.0, 1.2), (0.0, 0.0, 0.9))
    >>> render_frame(np.array([[0, 0, 0.0], [0, 0, 1.7]]), stick, camera, (32, 18)).shape
    (18, 32, 3)
    """
    stage = Stage() if stage is None else stage
    ends = figure.ends(positions)
    shadow, origin = shadow_map(ends, figure.radii, stage)
    picture = paint_backdrop(camera, size, stage, shadow, origin)
    cones = cones_from(camera.to_camera(ends), figure.radii)
    focal = camera.focal(size)
    cx, cy = camera.centre(size)
    boxes = spans(cones, focal, cx, cy, size[0], size[1])
    seen = boxes[(boxes[:, 1] > boxes[:, 0]) & (boxes[:, 3] > boxes[:, 2])]
    if len(seen):
        left, top = int(seen[:, 0].min()), int(seen[:, 2].min())
        shape = (int(seen[:, 3].max()) - top, int(seen[:, 1].max()) - left)
        depth, nearest = cast(cones, boxes, focal, cx, cy, (left, top), shape, stage.fine)
        _shade(
            picture, depth, nearest, cones, figure.adjacent, linear(figure.colours), camera.axes,
            camera.axes @ stage.towards_light, focal, cx, cy, (left, top), stage.fine, TO_SRGB, TO_LINEAR,
        )  # fmt: skip
    return picture


@numba.njit(cache=True, nogil=True)
def _neighbours(cones: Array, reach: float) -> tuple[Ints, Ints]:
    """(N, N) for each cone the cones that come within ``reach`` metres of its skin, and (N,) how many."""
    count = len(cones)
    found = np.zeros((count, count), np.int64)
    many = np.zeros(count, np.int64)
    for which in range(count):
        # Balls along the cone hold it; the more there are, the closer they fit.
        apart = cones[which, LENGTH] / 6
        most = max(cones[which, RADIUS], cones[which, RADIUS_B]) + apart / 2 + reach
        for i in range(count):
            for ball in range(7):
                x = cones[which, AX] + ball * apart * cones[which, NX]
                y = cones[which, AY] + ball * apart * cones[which, NY]
                z = cones[which, AZ] + ball * apart * cones[which, NZ]
                if gap(cones, i, x, y, z, most) < most:
                    found[which, many[which]] = i
                    many[which] += 1
                    break
    return found, many


@numba.njit(cache=True, nogil=True)
def _near(cones: Array, among: Ints, px: float, py: float, pz: float, reach: float, found: Ints) -> int:
    """Put the numbers of all cones whose ball lies within ``reach`` metres of a point in ``found``; how many."""
    count = 0
    for k in range(len(among)):
        i = among[k]
        half = 0.5 * cones[i, LENGTH]
        x = px - cones[i, AX] - half * cones[i, NX]
        y = py - cones[i, AY] - half * cones[i, NY]
        z = pz - cones[i, AZ] - half * cones[i, NZ]
        far = half + max(cones[i, RADIUS], cones[i, RADIUS_B]) + reach
        found[count] = i
        count += x * x + y * y + z * z < far * far
    return count


@numba.njit(cache=True, nogil=True)
def _skin(
    cones: Array, adjacent: Bools, near: Ints, count: int, which: int, px: float, py: float, pz: float
) -> tuple[float, float, float]:
    """The normal at a point of cone ``which``, run together with those of its neighbours within a few centimetres."""
    sx, sy, sz = 0.0, 0.0, 0.0
    for k in range(count):
        i = near[k]
        if not adjacent[which, i]:
            continue
        wx, wy, wz, radius = off_axis(cones, i, px, py, pz)
        square = wx * wx + wy * wy + wz * wz
        if square < (radius + BLEND) * (radius + BLEND):
            long = np.sqrt(square) + 1e-12
            weight = 1.0 - max(long - radius, 0.0) * (1.0 / BLEND)
            weight *= weight / long
            sx += weight * wx
            sy += weight * wy
            sz += weight * wz
    long = np.sqrt(sx * sx + sy * sy + sz * sz)
    if long < 1e-6:
        _, sx, sy, sz = outward(cones, which, px, py, pz)
        long = 1.0
    return sx / long, sy / long, sz / long


@numba.njit(cache=True, nogil=True)
def _open(cones: Array, near: Ints, count: int, px: float, py: float, pz: float, reach: float) -> float:
    """0…1: how far a point ``reach`` metres off the skin is from all of the body; what is left of the light there."""
    nearest = reach
    for k in range(count):
        nearest = gap(cones, near[k], px, py, pz, nearest)
    return max(nearest, 0.0) / reach


@numba.njit(cache=True, nogil=True)
def _light_on(
    cones: Array,
    adjacent: Bools,
    near: Ints,
    count: int,
    which: int,
    px: float,
    py: float,
    pz: float,
    axes: Array,
    to: Array,
) -> tuple[float, float, float]:
    """What a point of the body takes of the key light, of the sky and floor around, and of the rim's glow."""
    nx, ny, nz = _skin(cones, adjacent, near, count, which, px, py, pz)
    up = axes[0, 2] * nx + axes[1, 2] * ny + axes[2, 2] * nz
    key = max((nx * to[0] + ny * to[1] + nz * to[2] + 0.15) / 1.15, 0.0)
    free = 0.35 + 0.65 * _open(cones, near, count, px + HOLLOW * nx, py + HOLLOW * ny, pz + HOLLOW * nz, HOLLOW)
    if key > 0.0:
        key *= 0.25 + 0.75 * _open(
            cones, near, count, px + SHADE * to[0], py + SHADE * to[1], pz + SHADE * to[2], SHADE
        )
    facing = max(-(nx * px + ny * py + nz * pz) / np.sqrt(px * px + py * py + pz * pz), 0.0)
    return key, (0.72 + 0.5 * up) * free, (1.0 - facing) ** 4 * free


@numba.njit(cache=True, nogil=True)
def _shade(
    picture: np.ndarray,
    depth: Float32,
    nearest: NDArray[np.int16],
    cones: Array,
    adjacent: Bools,
    colours: Array,
    axes: Array,
    to: Array,
    focal: float,
    cx: float,
    cy: float,
    origin: tuple[int, int],
    fine: int,
    to_srgb: np.ndarray,
    to_linear: Array,
) -> None:
    """Colour the figure's pixels; a pixel that several capsules share is their mean, by the points each has."""
    share = 1.0 / (fine * fine)
    near = np.empty(len(cones) + 1, np.int64)
    among, many = _neighbours(cones, SHADE + SHADE)
    count, patch, px, py, pz = 0, -1, 0.0, 0.0, 0.0
    down, across = np.repeat(np.arange(fine), fine), np.arange(fine * fine) % fine
    for row in range(depth.shape[0] // fine):
        for column in range(depth.shape[1] // fine):
            red, green, blue, clear = 0.0, 0.0, 0.0, 1.0
            last = -1
            r, g, b = 0.0, 0.0, 0.0
            for point in range(fine * fine):
                i, j = row * fine + down[point], column * fine + across[point]
                which = int(nearest[i, j])
                if which < 0:
                    continue
                if which != last:
                    x = (origin[0] + (j + 0.5) / fine - cx) / focal
                    y = (cy - origin[1] - (i + 0.5) / fine) / focal
                    z = float(depth[i, j])
                    x, y = x * z, y * z
                    if which != patch or (x - px) ** 2 + (y - py) ** 2 + (z - pz) ** 2 > PATCH * PATCH:
                        patch, px, py, pz = which, x, y, z
                        close = among[which, : many[which]]
                        count = _near(cones, close, x, y, z, SHADE + SHADE + PATCH, near)
                    key, around, rim = _light_on(cones, adjacent, near, count, which, x, y, z, axes, to)
                    last = which
                    r = colours[which, 0] * (0.86 * key + 0.46 * around + 0.3 * rim)
                    g = colours[which, 1] * (0.82 * key + 0.49 * around + 0.3 * rim)
                    b = colours[which, 2] * (0.76 * key + 0.54 * around + 0.3 * rim)
                red += share * r
                green += share * g
                blue += share * b
                clear -= share
            if last >= 0:
                pixel = picture[origin[1] + row, origin[0] + column]
                if clear > 1e-6:
                    red += clear * to_linear[pixel[0]]
                    green += clear * to_linear[pixel[1]]
                    blue += clear * to_linear[pixel[2]]
                pixel[0] = to_srgb[int(min(red, 1.0) * 4096)]
                pixel[1] = to_srgb[int(min(green, 1.0) * 4096)]
                pixel[2] = to_srgb[int(min(blue, 1.0) * 4096)]
