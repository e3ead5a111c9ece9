"""What stands around a dancer: light, floor, backdrop; and the floor with the dancer's shadow, compiled."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from onbeat._shapes import Array, Float32, Positions
from onbeat.viewer.camera import Camera, Size

CELL = 0.0125
"""Metres: the grain of the shadow, which is soft anyway."""


@dataclass(frozen=True)
class Stage:
    """Light and floor.

    Parameters
    ----------
    light : a vector towards the key light, in the world; of any length.
    ground : metres, the floor's height.
    fine : each edge pixel is looked at in ``fine`` × ``fine`` points.
    floor, tile, backdrop, horizon : sRGB colours of the floor and its darker tiles, and of the backdrop above and at
        the horizon.
    """

    light: tuple[float, float, float] = (-0.5, -0.55, 1.0)
    ground: float = 0.0
    fine: int = 2
    floor: tuple[int, int, int] = (226, 224, 220)
    tile: tuple[int, int, int] = (215, 213, 210)
    backdrop: tuple[int, int, int] = (190, 207, 224)
    horizon: tuple[int, int, int] = (236, 239, 241)

    @classmethod
    def lit_from(cls, azimuth: float, ground: float = 0.0, fine: int = 2) -> Stage:
        """A stage for a camera at ``azimuth`` radians as seen from the dancer: lit from the camera's upper left."""
        across = azimuth - 0.85
        return cls((float(np.cos(across)) * 0.8, float(np.sin(across)) * 0.8, 1.0), ground, fine)

    @property
    def towards_light(self) -> Array:
        """(3,) unit vector towards the light."""
        return np.asarray(self.light) / np.linalg.norm(self.light)


def linear(colour: object) -> Array:
    """Linear light 0…1 of sRGB colours 0…255."""
    value = np.asarray(colour, np.float64) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def _srgb_table() -> np.ndarray:
    value = (np.arange(4097) + 0.0) / 4096
    coded = np.where(value <= 0.0031308, value * 12.92, 1.055 * value ** (1 / 2.4) - 0.055)
    return np.round(coded * 255).astype(np.uint8)


TO_SRGB = _srgb_table()
"""(4097,) sRGB 0…255 of linear light 0…1."""
TO_LINEAR = linear(np.arange(256))
"""(256,) linear light of sRGB 0…255."""


def shadow_map(ends: Positions, radii: Array, stage: Stage) -> tuple[Float32, tuple[float, float]]:
    """How much of the light each cell of the floor misses, 0…1, and where in metres the first cell lies."""
    to = stage.towards_light
    height = np.maximum(ends[..., 2] - stage.ground, 0.0)
    foot = ends[..., :2] - height[..., None] * to[:2] / to[2]
    wide = (radii + 0.1 * height)[..., None] / to[2] + 0.1
    low = np.minimum((foot - wide).min((0, 1)), (ends[..., :2] - wide).min((0, 1)))
    high = np.maximum((foot + wide).max((0, 1)), (ends[..., :2] + wide).max((0, 1)))
    cells = np.clip(np.ceil((high - low) / CELL).astype(np.int64) + 1, 2, 1200)
    shadow = np.zeros((int(cells[1]), int(cells[0])), np.float32)
    origin = (float(low[0]), float(low[1]))
    _cast_shadow(shadow, origin, ends, radii, stage.ground, to)
    return shadow, origin


@numba.njit(cache=True)
def _cast_shadow(
    shadow: Float32, origin: tuple[float, float], ends: Positions, radii: Array, ground: float, to: Array
) -> None:
    """Darken the cells that each capsule hides from the light; the edge widens with the height of what hides it."""
    rows, columns = shadow.shape
    for i in range(len(ends)):
        # Once along the light, and once straight down, near the floor only: the dark where a foot touches.
        for down in range(2):
            lx, ly = (0.0, 0.0) if down else (to[0] / to[2], to[1] / to[2])
            za, zb = max(ends[i, 0, 2] - ground, 0.0), max(ends[i, 1, 2] - ground, 0.0)
            if down and min(za, zb) > 0.25:
                continue
            ax, ay = ends[i, 0, 0] - lx * za, ends[i, 0, 1] - ly * za
            bx, by = ends[i, 1, 0] - lx * zb, ends[i, 1, 1] - ly * zb
            # The disc of a sphere grows into an ellipse along the light: measured square to the light.
            stretch = 1.0 / (1.0 + lx * lx + ly * ly)
            most = max(radii[i, 0], radii[i, 1]) + 0.1 * max(za, zb) + 0.06
            span = most / np.sqrt(stretch)
            first_column = max(int((min(ax, bx) - span - origin[0]) / CELL), 0)
            last_column = min(int((max(ax, bx) + span - origin[0]) / CELL) + 1, columns - 1)
            first_row = max(int((min(ay, by) - span - origin[1]) / CELL), 0)
            last_row = min(int((max(ay, by) + span - origin[1]) / CELL) + 1, rows - 1)
            dx, dy = bx - ax, by - ay
            skew = (dx * lx + dy * ly) * stretch
            metric_dd = dx * dx + dy * dy - skew * (dx * lx + dy * ly)
            for row in range(first_row, last_row + 1):
                y = origin[1] + row * CELL - ay
                for column in range(first_column, last_column + 1):
                    x = origin[0] + column * CELL - ax
                    slant = (x * lx + y * ly) * stretch
                    along = 0.0
                    if metric_dd > 1e-9:
                        along = (x * dx + y * dy - slant * (dx * lx + dy * ly)) / metric_dd
                        along = min(max(along, 0.0), 1.0)
                    ex, ey = x - along * dx, y - along * dy
                    slant = ex * lx + ey * ly
                    off = np.sqrt(max(ex * ex + ey * ey - slant * slant * stretch, 0.0))
                    high = za + along * (zb - za)
                    radius = radii[i, 0] + along * (radii[i, 1] - radii[i, 0])
                    soft = 0.05 if down else 0.012 + 0.07 * high
                    cover = min(max((radius + soft - off) / (2.0 * soft), 0.0), 1.0)
                    cover = cover * cover * (3.0 - 2.0 * cover)
                    # A thin thing far up hides only part of a lamp that is not a point.
                    cover *= min(1.0, radius / soft) if not down else 0.55 * max(0.0, 1.0 - high / 0.25)
                    shadow[row, column] = max(shadow[row, column], cover)


def paint_backdrop(
    camera: Camera, size: Size, stage: Stage, shadow: Float32, origin: tuple[float, float]
) -> np.ndarray:
    """The picture (H, W, 3) without the figure: backdrop, floor, shadow."""
    colours = np.array([linear(c) for c in (stage.floor, stage.tile, stage.backdrop, stage.horizon)])
    picture = np.empty((size[1], size[0], 3), np.uint8)
    cx, cy = camera.centre(size)
    eye = np.asarray(camera.position) - (0.0, 0.0, stage.ground)
    middle = np.asarray(camera.target)[:2]
    _paint(picture, eye, middle, camera.axes, camera.focal(size), cx, cy, colours, shadow, origin, TO_SRGB)
    return picture


@numba.njit(cache=True)
def _tiles(x: float, wide: float) -> float:
    """-1…1: a square wave of period 2 m, averaged over ``wide`` metres around ``x``."""
    low, high = (x - 0.5 * wide) * 0.5, (x + 0.5 * wide) * 0.5
    return (abs(2.0 * (high - np.floor(high)) - 1.0) - abs(2.0 * (low - np.floor(low)) - 1.0)) / wide


@numba.njit(cache=True)
def _missing(shadow: Float32, column: float, row: float) -> float:
    """The shadow between four cells."""
    i, j = int(np.floor(row)), int(np.floor(column))
    if i < 0 or j < 0 or i + 1 >= shadow.shape[0] or j + 1 >= shadow.shape[1]:
        return 0.0
    u, v = column - j, row - i
    upper = shadow[i, j] * (1 - u) + shadow[i, j + 1] * u
    return upper * (1 - v) + (shadow[i + 1, j] * (1 - u) + shadow[i + 1, j + 1] * u) * v


@numba.njit(cache=True)
def _paint(
    picture: np.ndarray,
    eye: Array,
    middle: Array,
    axes: Array,
    focal: float,
    cx: float,
    cy: float,
    colours: Array,
    shadow: Float32,
    origin: tuple[float, float],
    to_srgb: np.ndarray,
) -> None:
    height, width = picture.shape[:2]
    floor, tile, backdrop, horizon = colours[0], colours[1], colours[2], colours[3]
    for row in range(height):
        y = (cy - row - 0.5) / focal
        rise = axes[1, 2] * y + axes[2, 2]
        if rise > -0.004:
            part = min(max(rise / 0.22, 0.0), 1.0)
            for channel in range(3):
                light = horizon[channel] + (backdrop[channel] - horizon[channel]) * part
                picture[row, :, channel] = to_srgb[int(light * 4096)]
            continue
        t = -eye[2] / rise
        # The row's first point on the floor and the step to the next pixel.
        step_x, step_y = axes[0, 0] * t / focal, axes[0, 1] * t / focal
        x = eye[0] + t * (axes[1, 0] * y + axes[2, 0]) + step_x * (0.5 - cx)
        z = eye[1] + t * (axes[1, 1] * y + axes[2, 1]) + step_y * (0.5 - cx)
        deep = t * np.sqrt(t * t + 1.0) / focal / max(eye[2], 0.1)
        wide_x = abs(step_x) + deep * abs(axes[2, 0]) + 1e-4
        wide_y = abs(step_y) + deep * abs(axes[2, 1]) + 1e-4
        for column in range(width):
            gx, gy = x + step_x * column, z + step_y * column
            far = ((gx - middle[0]) ** 2 + (gy - middle[1]) ** 2) / 30.0
            fade = 1.0 / (1.0 + far * far)
            mix = 0.5 + 0.5 * _tiles(gx, wide_x) * _tiles(gy, wide_y)
            dark = 1.0 - 0.66 * _missing(shadow, (gx - origin[0]) / CELL, (gy - origin[1]) / CELL)
            for channel in range(3):
                light = (floor[channel] + (tile[channel] - floor[channel]) * mix) * dark
                light = horizon[channel] + (light - horizon[channel]) * fade
                picture[row, column, channel] = to_srgb[int(light * 4096)]
