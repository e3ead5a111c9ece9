"""What a link takes up of space, as its file has it: points for the sole, a capsule for collisions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import Capsule

THINNEST, WIDEST = 0.01, 0.25
"""Metres, the radii a capsule may have."""
_CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)


class Shape(NamedTuple):
    """Points (N, 3) on the surface of a shape, and a capsule about as large as it; metres in the frame of its link."""

    points: Positions
    capsule: Array

    def moved(self, turn: Rotations, at: Positions) -> Shape:
        """The shape in another frame, in which this one is turned and placed like this."""
        ends = rot.rotate(turn, self.capsule[:6].reshape(2, 3)) + at
        return Shape(rot.rotate(turn, self.points) + at, np.append(ends.ravel(), self.capsule[6]))


def sphere(radius: float) -> Shape:
    """A ball about the origin: its six poles."""
    poles = radius * np.vstack((np.eye(3), -np.eye(3)))
    return Shape(poles, np.array([0, 0, 0, 0, 0, 0, _radius(radius)]))


def cylinder(radius: float, length: float) -> Shape:
    """A cylinder along z about the origin, of this whole length."""
    half = max(length / 2 - radius, 0.0)
    around = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    ring = radius * np.column_stack((np.cos(around), np.sin(around)))
    points = np.vstack([np.column_stack((ring, np.full(16, z))) for z in (-length / 2, length / 2)])
    return Shape(points, np.array([0, 0, -half, 0, 0, half, _radius(radius)]))


def box(half: Array) -> Shape:
    """A box about the origin with half sizes (3,); its capsule lies along the longest."""
    order = np.argsort(half)
    radius = _radius(float(half[order[:2]].mean()))
    along = np.zeros(3)
    along[order[2]] = max(half[order[2]] - radius, 0.0)
    return Shape(_CORNERS * half, np.concatenate((-along, along, [radius])))


def cloud(points: Positions) -> Shape:
    """A mesh of vertices (N, 3): the capsule is that of the box about them along their main axes.

    Examples
    --------
    >>> stick = cloud(np.array([[x, y, 0] for x in (0, 0.4) for y in (-0.02, 0.02)]))
    >>> stick.capsule.round(3).tolist()
    [0.01, 0.0, 0.0, 0.39, 0.0, 0.0, 0.01]
    """
    middle = points.mean(axis=0)
    axes = np.linalg.svd(points - middle, full_matrices=False)[2] if len(points) > 2 else np.eye(3)
    if np.linalg.det(axes) < 0:
        axes[2] *= -1
    inside = (points - middle) @ axes.T
    low, high = inside.min(axis=0), inside.max(axis=0)
    centre = middle + (low + high) / 2 @ axes
    fitted = box((high - low) / 2).capsule[:6].reshape(2, 3) @ axes + centre
    ends = fitted[np.argsort(fitted @ axes[0])]
    return Shape(points, np.append(ends.ravel(), box((high - low) / 2).capsule[6]))


def bone(tips: Positions, mass: float, centre: Positions, inertia: Array) -> list[Array]:
    """Capsules (7,) of a link without a shape: from its origin to its tips (N, 3), as thick as its inertia says.

    A cylinder of mass m has ``I = m r²/2`` about its axis.
    """
    tips = tips if len(tips) else 2 * centre[None]
    out = list[Array]()
    for tip in tips:
        length = float(np.linalg.norm(tip))
        axis = tip / length if length > 1e-3 else np.array([0, 0, 1.0])
        radius = _radius(0.8 * np.sqrt(max(2 * float(axis @ inertia @ axis) / mass, 0.0)))
        inset = axis * min(radius, length / 2)
        out.append(np.concatenate((inset, tip - inset, [radius])))
    return out


def as_capsule(values: Array) -> Capsule:
    """Seven numbers, rounded to a tenth of a millimetre."""
    x, y, z, a, b, c, radius = values.round(4).tolist()
    return x, y, z, a, b, c, radius


def _radius(radius: float) -> float:
    return float(np.clip(radius, THINNEST, WIDEST))
