"""What stands around a dancer: light, the colours of floor and backdrop, and rings that run over the floor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array


class Ring(NamedTuple):
    """A ring on the floor: its middle, radius and width in metres, how strong it is (0…1), and its sRGB colour."""

    x: float
    y: float
    radius: float
    width: float
    strength: float
    colour: tuple[int, int, int]


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
    rings : what is drawn on the floor, the last on top.
    """

    light: tuple[float, float, float] = (-0.5, -0.55, 1.0)
    ground: float = 0.0
    fine: int = 2
    floor: tuple[int, int, int] = (226, 224, 220)
    tile: tuple[int, int, int] = (215, 213, 210)
    backdrop: tuple[int, int, int] = (190, 207, 224)
    horizon: tuple[int, int, int] = (236, 239, 241)
    rings: tuple[Ring, ...] = ()

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
