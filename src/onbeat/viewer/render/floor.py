"""The picture behind a figure: a backdrop, a tiled floor that fades into it, and shadow and rings on it; compiled."""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.viewer.render.camera import Camera, Size
from onbeat.viewer.render.rings import draw_rings
from onbeat.viewer.render.shadow import CELL
from onbeat.viewer.render.stage import TO_SRGB, Stage, linear

HORIZON = -0.004
"""A ray that sinks by less than this on its way does not meet the floor."""


def paint_backdrop(
    camera: Camera, size: Size, stage: Stage, shadow: Float32, origin: tuple[float, float]
) -> np.ndarray:
    """The picture (H, W, 3) without the figure: backdrop, floor, shadow, rings."""
    colours = np.array([linear(c) for c in (stage.floor, stage.tile, stage.backdrop, stage.horizon)])
    picture = np.empty((size[1], size[0], 3), np.uint8)
    cx, cy = camera.centre(size)
    eye = np.asarray(camera.position) - (0.0, 0.0, stage.ground)
    middle = np.asarray(camera.target)[:2]
    axes, focal = camera.axes, camera.focal(size)
    _paint(picture, eye, middle, axes, focal, cx, cy, colours, shadow, origin, TO_SRGB)
    draw_rings(picture, eye, axes, focal, cx, cy, stage.rings)
    return picture


@numba.njit(cache=True, nogil=True)
def _tiles(x: float, half: float, share: float) -> float:
    """-1…1: a square wave of period 2 m, averaged over four ``half`` metres around ``x``; ``share`` is 1 / 4 half."""
    low, high = 0.5 * x - half, 0.5 * x + half
    return (abs(2.0 * (high - np.floor(high)) - 1.0) - abs(2.0 * (low - np.floor(low)) - 1.0)) * share


@numba.njit(cache=True, nogil=True)
def _missing(shadow: Float32, column: float, row: float) -> float:
    """The shadow between four cells."""
    i, j = int(np.floor(row)), int(np.floor(column))
    if i < 0 or j < 0 or i + 1 >= shadow.shape[0] or j + 1 >= shadow.shape[1]:
        return 0.0
    u, v = column - j, row - i
    upper = shadow[i, j] * (1 - u) + shadow[i, j + 1] * u
    return upper * (1 - v) + (shadow[i + 1, j] * (1 - u) + shadow[i + 1, j + 1] * u) * v


@numba.njit(cache=True, nogil=True)
def _between(first: float, step: float, most: float, count: int) -> tuple[int, int]:
    """The columns, from 0 to ``count``, at which ``first + step * column`` is within 0…``most``."""
    if abs(step) < 1e-12:
        return (0, count) if 0.0 <= first <= most else (0, 0)
    one, other = -first / step, (most - first) / step
    low, high = min(one, other), max(one, other)
    if high < 0.0 or low > count:
        return 0, 0
    return max(int(low), 0), min(int(high) + 1, count)


@numba.njit(cache=True, nogil=True)
def _darken(
    light: Array, shadow: Float32, origin: tuple[float, float], x: float, y: float, step_x: float, step_y: float
) -> None:
    """Take a row's light away where the shadow lies; ``x, y`` is the row's first point on the floor, in metres."""
    column, across = (x - origin[0]) / CELL, step_x / CELL
    row, upward = (y - origin[1]) / CELL, step_y / CELL
    first, last = _between(column, across, shadow.shape[1], len(light))
    low, high = _between(row, upward, shadow.shape[0], len(light))
    for i in range(max(first, low), min(last, high)):
        light[i] = 1.0 - 0.66 * _missing(shadow, column + across * i, row + upward * i)


@numba.njit(cache=True, nogil=True)
def _sky(row: np.ndarray, part: float, backdrop: Array, horizon: Array, to_srgb: np.ndarray) -> None:
    """A row above the horizon, of one colour: ``part`` of the way up to the backdrop's."""
    red, green, blue = horizon + (backdrop - horizon) * part
    r, g, b = to_srgb[int(red * 4096)], to_srgb[int(green * 4096)], to_srgb[int(blue * 4096)]
    for column in range(len(row)):
        row[column, 0], row[column, 1], row[column, 2] = r, g, b


@numba.njit(cache=True, nogil=True)
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
    floor, tile, backdrop, horizon = 4096 * colours[0], 4096 * colours[1], colours[2], 4096 * colours[3]
    ink = tile - floor
    mix, fade, light = np.empty(width), np.empty(width), np.ones(width)
    for row in range(height):
        y = (cy - row - 0.5) / focal
        rise = axes[1, 2] * y + axes[2, 2]
        if rise > HORIZON:
            _sky(picture[row], min(max(rise / 0.22, 0.0), 1.0), backdrop, colours[3], to_srgb)
            continue
        t = -eye[2] / rise
        # The row's first point on the floor and the step to the next pixel.
        step_x, step_y = axes[0, 0] * t / focal, axes[0, 1] * t / focal
        gx = eye[0] + t * (axes[1, 0] * y + axes[2, 0]) + step_x * (0.5 - cx)
        gy = eye[1] + t * (axes[1, 1] * y + axes[2, 1]) + step_y * (0.5 - cx)
        deep = t * np.sqrt(t * t + 1.0) / focal / max(eye[2], 0.1)
        half_x = 0.25 * (abs(step_x) + deep * abs(axes[2, 0]) + 1e-4)
        half_y = 0.25 * (abs(step_y) + deep * abs(axes[2, 1]) + 1e-4)
        share_x, share_y = 0.25 / half_x, 0.25 / half_y
        off_x, off_y = gx - middle[0], gy - middle[1]
        # Loops without branches and look-ups: these run several pixels at a time.
        for column in range(width):
            dx, dy = off_x + step_x * column, off_y + step_y * column
            far = (dx * dx + dy * dy) * (1 / 30)
            fade[column] = 1.0 / (1.0 + far * far)
        for column in range(width):
            along_x = _tiles(gx + step_x * column, half_x, share_x)
            mix[column] = 0.5 + 0.5 * along_x * _tiles(gy + step_y * column, half_y, share_y)
        light[:] = 1.0
        _darken(light, shadow, origin, gx, gy, step_x, step_y)
        for column in range(width):
            lit, part, dark = fade[column] * light[column], 1.0 - fade[column], mix[column]
            for channel in range(3):
                value = (floor[channel] + ink[channel] * dark) * lit + horizon[channel] * part
                picture[row, column, channel] = to_srgb[int(value)]
