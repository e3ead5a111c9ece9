"""A small software renderer of a dancer: the same input gives the same bytes on every machine, without a display.

Rays meet tapering capsules (``cones.py``) inside each capsule's box on the screen; the nearest wins. Where capsules
meet, their normals run into each other, so that the body looks like one skin. The floor and the shadow on it are
in ``stage.py``.
"""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.viewer.camera import Camera, Size
from onbeat.viewer.cones import cast, cones_from, outward, spans
from onbeat.viewer.figure import Figure
from onbeat.viewer.stage import TO_LINEAR, TO_SRGB, Stage, linear, paint_backdrop, shadow_map


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


@numba.njit(cache=True)
def _skin(cones: Array, adjacent: Array, which: int, px: float, py: float, pz: float) -> tuple[float, float, float]:
    """The normal at a point of cone ``which``, run together with those of its neighbours within a few centimetres."""
    blend = 0.035
    sx, sy, sz = 0.0, 0.0, 0.0
    for i in range(len(cones)):
        if adjacent[which, i]:
            off, nx, ny, nz = outward(cones[i], px, py, pz)
            if off < blend:
                weight = (1.0 - max(off, 0.0) / blend) ** 2
                sx += weight * nx
                sy += weight * ny
                sz += weight * nz
    long = np.sqrt(sx * sx + sy * sy + sz * sz)
    if long < 1e-6:
        _, sx, sy, sz = outward(cones[which], px, py, pz)
        long = 1.0
    return sx / long, sy / long, sz / long


@numba.njit(cache=True)
def _open(cones: Array, px: float, py: float, pz: float, reach: float) -> float:
    """0…1: how far a point ``reach`` metres off the skin is from all of the body; what is left of the light there."""
    nearest = reach
    for i in range(len(cones)):
        cone = cones[i]
        wx, wy, wz = px - cone[0], py - cone[1], pz - cone[2]
        if wx * wx + wy * wy + wz * wz > (cone[6] + cone[7] + cone[13] + reach) ** 2:
            continue
        off, _, _, _ = outward(cone, px, py, pz)
        nearest = min(nearest, off)
    return max(nearest, 0.0) / reach


@numba.njit(cache=True)
def _light_on(
    cones: Array, adjacent: Array, which: int, x: float, y: float, depth: float, axes: Array, to: Array
) -> tuple[float, float, float]:
    """What a point of the body takes of the key light, of the sky and floor around, and of the rim's glow."""
    px, py, pz = x * depth, y * depth, depth
    nx, ny, nz = _skin(cones, adjacent, which, px, py, pz)
    up = axes[0, 2] * nx + axes[1, 2] * ny + axes[2, 2] * nz
    key = nx * to[0] + ny * to[1] + nz * to[2]
    key = max((key + 0.15) / 1.15, 0.0)
    reach = 0.11
    near = _open(cones, px + reach * nx, py + reach * ny, pz + reach * nz, reach)
    near = 0.35 + 0.65 * near
    reach = 0.16
    lit = _open(cones, px + reach * to[0], py + reach * to[1], pz + reach * to[2], reach)
    around = (0.5 + 0.5 * up) * near
    facing = max(-(nx * px + ny * py + nz * pz) / np.sqrt(px * px + py * py + pz * pz), 0.0)
    rim = (1.0 - facing) ** 4 * near
    return key * (0.25 + 0.75 * lit), around + 0.22 * near, rim


@numba.njit(cache=True)
def _shade(
    picture: np.ndarray, depth: Array, nearest: Array, cones: Array, adjacent: Array, colours: Array, axes: Array,
    to: Array, focal: float, cx: float, cy: float, origin: tuple[int, int], fine: int, to_srgb: np.ndarray,
    to_linear: Array,
) -> None:
    """Colour the figure's pixels; a pixel that several capsules share is their mean, by the points each has."""
    share = 1.0 / (fine * fine)
    for row in range(depth.shape[0] // fine):
        for column in range(depth.shape[1] // fine):
            red, green, blue, clear = 0.0, 0.0, 0.0, 1.0
            last = -1
            r, g, b = 0.0, 0.0, 0.0
            for point in range(fine * fine):
                i, j = row * fine + point // fine, column * fine + point % fine
                which = nearest[i, j]
                if which < 0:
                    continue
                if which != last:
                    x = (origin[0] + (j + 0.5) / fine - cx) / focal
                    y = (cy - origin[1] - (i + 0.5) / fine) / focal
                    key, around, rim = _light_on(cones, adjacent, which, x, y, depth[i, j], axes, to)
                    last = which
                    r = colours[which, 0] * (0.86 * key + 0.46 * around) + 0.10 * rim
                    g = colours[which, 1] * (0.82 * key + 0.49 * around) + 0.11 * rim
                    b = colours[which, 2] * (0.76 * key + 0.54 * around) + 0.13 * rim
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
