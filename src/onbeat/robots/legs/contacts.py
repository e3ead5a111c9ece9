"""Which feet of a robot stand on the floor, and what they span."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Positions, frozen
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.legs.ik import Legs
from onbeat.robots.polygon import Polygons


@dataclass(frozen=True, eq=False)
class Danced:
    """A dance on a robot's legs.

    Parameters
    ----------
    motion : of the robot.
    standing : (F, 2) true where the left, right foot stands flat on the floor.
    """

    motion: Motion
    standing: Bools

    def __post_init__(self) -> None:
        object.__setattr__(self, "standing", frozen(self.standing, np.bool_))


def sole_corners(legs: Legs, qpos: Array) -> Positions:
    """The corners (F, 2, 4, 3) in metres of the left and right sole in the world."""
    places, turns = legs.feet(qpos)
    corners = np.stack([leg.corners for leg in legs.both])
    return places[:, :, None] + rot.rotate(turns[:, :, None], corners[None])


def support(legs: Legs, qpos: Array, standing: Bools) -> Polygons:
    """The support polygons of the feet (F, 2) that stand."""
    corners = sole_corners(legs, qpos)[..., :2]
    frames, _, count, _ = corners.shape
    return Polygons.around(corners.reshape(frames, 2 * count, 2), np.repeat(standing, count, axis=1))
