"""The shadow of a figure on the floor, soft with height, and dark where a foot touches; compiled."""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32, Positions
from onbeat.viewer.render.stage import Stage

CELL = 0.0125
"""Metres: the grain of the shadow, which is soft anyway."""


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


@numba.njit(cache=True, nogil=True)
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
