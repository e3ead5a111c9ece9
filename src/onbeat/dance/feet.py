"""Planted feet stay planted through joins."""

from __future__ import annotations

from onbeat._shapes import Bools, Ints, Positions, Rotations, Times
from onbeat.dance.blend import Windows
from onbeat.dance.sources import Pose
from onbeat.motion.body import Body


def plant_feet(
    body: Body,
    pose: Pose,
    shown: tuple[Rotations, Positions],
    contacts: Bools,
    moves: Ints,
    windows: Windows,
    times: Times,
) -> Pose:
    """The poses with feet that rest kept in place (not yet: the poses as they are)."""
    return pose
