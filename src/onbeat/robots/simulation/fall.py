"""When a robot has fallen: low, tipped over, or on the floor with more than its feet."""

from __future__ import annotations

from typing import Any

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.robots.model import Robot

LOW = 0.6
"""Part of the height that the root is meant to have under which the robot has fallen."""
TIPPED = np.deg2rad(45.0)
"""Angle between where the root's up is meant to point and where it points."""


class Ground:
    """The geoms of a model that may be on the floor, and the floor's.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> ground = Ground(robot_named("g1"))
    >>> int(ground.floor.sum()), bool(ground.soles[ground.side == 0].all())
    (1, True)
    """

    def __init__(self, robot: Robot) -> None:
        model = robot.model
        feet = [model.body(foot.link).id for foot in robot.feet.values()]
        # Toes with a hinge of their own are links below the foot.
        below = [np.flatnonzero((np.arange(model.nbody) == f) | (model.body_parentid == f)) for f in feet]
        self.floor: Bools = np.asarray(model.geom_bodyid == 0)
        self.soles: Bools = np.isin(model.geom_bodyid, np.concatenate(below))
        self.side = np.select([np.isin(model.geom_bodyid, links) for links in below], [0, 1], -1)

    def touched(self, data: Any) -> Bools:
        """Which contacts are between the floor and something other than a foot."""
        pairs = data.contact.geom
        return np.asarray(self.floor[pairs].any(axis=1) & ~self.soles[pairs].any(axis=1))


def fallen(qpos: Array, up: Array, meant: Array, meant_up: Array, touched: Bools) -> str | None:
    """Why a robot has fallen, or None while it stands.

    Parameters
    ----------
    qpos, up : the root's place first; the root's z axis (3,) in the world.
    meant, meant_up : the same as the dance has them.
    touched : from :meth:`Ground.touched`.

    Examples
    --------
    >>> up, none = np.array([0, 0, 1.0]), np.zeros(0, np.bool_)
    >>> fallen(np.array([0, 0, 0.7]), up, np.array([0, 0, 0.75]), up, none) is None
    True
    >>> fallen(np.array([0, 0, 0.3]), up, np.array([0, 0, 0.75]), up, none)
    'its root was at 0.30 m instead of 0.75 m'
    """
    if qpos[2] < LOW * meant[2]:
        return f"its root was at {qpos[2]:.2f} m instead of {meant[2]:.2f} m"
    tilt = float(np.arccos(np.clip(up @ meant_up, -1.0, 1.0)))
    if tilt > TIPPED:
        return f"it had tipped over by {np.degrees(tilt):.0f}°"
    return "more than its feet was on the floor" if touched.any() else None
