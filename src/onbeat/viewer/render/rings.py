"""Rings of colour that run over the floor around a dancer, compiled."""

from __future__ import annotations

from collections.abc import Sequence

import numba
import numpy as np

from onbeat._shapes import Array
from onbeat.viewer.render.stage import TO_LINEAR, TO_SRGB, Ring, linear

INSIDE = 0.2
"""How strong the colour is within a ring, against the ring itself."""


def draw_rings(
    picture: np.ndarray, eye: Array, axes: Array, focal: float, cx: float, cy: float, rings: Sequence[Ring]
) -> None:
    """Draw rings into a picture (H, W, 3) of the floor, one over the other.

    Parameters
    ----------
    picture : sRGB, 0…255.
    eye : (3,) metres, where the camera stands, above a floor at 0.
    axes : (3, 3) rows: right, up and forward of the camera in the world.
    focal, cx, cy : pixels.
    rings : what is drawn.
    """
    for ring in rings:
        place = (ring.x - float(eye[0]), ring.y - float(eye[1]), float(eye[2]))
        shape = (ring.radius, ring.width, ring.strength)
        _draw(picture, axes, focal, cx, cy, place, shape, linear(ring.colour), TO_SRGB, TO_LINEAR)


@numba.njit(cache=True, nogil=True)
def _draw(
    picture: np.ndarray,
    axes: Array,
    focal: float,
    cx: float,
    cy: float,
    place: tuple[float, float, float],
    shape: tuple[float, float, float],
    colour: Array,
    to_srgb: np.ndarray,
    to_linear: Array,
) -> None:
    radius, width, strength = shape
    reach = radius + 2.0 * width
    for row in range(picture.shape[0]):
        y = (cy - row - 0.5) / focal
        rise = axes[1, 2] * y + axes[2, 2]
        if rise > -0.004:
            continue
        t = -place[2] / rise
        step_x, step_y = axes[0, 0] * t / focal, axes[0, 1] * t / focal
        x = t * (axes[1, 0] * y + axes[2, 0]) + step_x * (0.5 - cx) - place[0]
        z = t * (axes[1, 1] * y + axes[2, 1]) + step_y * (0.5 - cx) - place[1]
        # The columns at which the row is within reach: between the roots of a square equation.
        a, b, c = step_x * step_x + step_y * step_y, x * step_x + z * step_y, x * x + z * z - reach * reach
        root = b * b - a * c
        if root <= 0.0:
            continue
        root = np.sqrt(root)
        for column in range(max(int((-b - root) / a), 0), min(int((-b + root) / a) + 1, picture.shape[1])):
            dx, dy = x + step_x * column, z + step_y * column
            off = np.sqrt(dx * dx + dy * dy) - radius
            close = max(1.0 - off * off / (4.0 * width * width), 0.0)
            within = INSIDE * min(max(0.5 - off / width, 0.0), 1.0)
            part = strength * max(close * close, within)
            for channel in range(3):
                value = to_linear[picture[row, column, channel]]
                value += (colour[channel] - value) * part
                picture[row, column, channel] = to_srgb[int(value * 4096)]
