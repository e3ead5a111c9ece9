"""A reference that grows: poses come a hundred times a second, and a robot's controller wants five ticks for each.

Through the poses goes a uniform cubic B-spline whose control points are taken from the nine poses about each,

    c_i = Σ_k h_k x_{i+k},  h_k = √3 (√3 − 2)^|k|,  |k| ≤ 4,

the inverse of the spline's own filter (Unser et al. 1993), cut off where it is under a hundredth: what comes out for a
pose does not depend on how many come at once. It is known as soon as the six poses after it are.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.live.protocol import RATE
from onbeat.motion import rotations as rot
from onbeat.retime.bspline import basis
from onbeat.robots.model import Robot
from onbeat.robots.simulation.reference import Reference, dynamics
from onbeat.robots.simulation.world import RATE as TICKS
from onbeat.robots.state import angular

WIDE = 4
"""Poses before and after one that its control point is made of."""
AHEAD = WIDE + 2
"""Poses after one that have to be known: 60 ms."""
EACH = round(TICKS / RATE)
"""Ticks of the controller to a pose."""
_SHARES = (np.sqrt(3) - 2) ** np.abs(np.arange(-WIDE, WIDE + 1))
_PARTS = np.arange(EACH) / EACH


class Ticks:
    """What a robot is told to do at each tick, as far as it is known.

    Parameters
    ----------
    robot : n hinges.
    first : (7 + n,) the configuration in which it rests before the first pose.
    kept : ticks that are remembered, at least.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> g1 = robot_named("g1")
    >>> ticks = Ticks(g1, g1.model.qpos0, kept=8)
    >>> ticks.add(np.tile(g1.model.qpos0, (10, 1))), len(ticks.reference.qpos)
    (4, 28)
    """

    def __init__(self, robot: Robot, first: Array, kept: int) -> None:
        self._robot, self._kept = robot, max(kept, EACH)
        self._poses = np.tile(np.asarray(first, np.float64), (WIDE + 1, 1))
        still = np.zeros((self._kept, robot.model.nv))
        self.reference = dynamics(robot, np.tile(self._poses[:1], (self._kept, 1)), still, still)

    def add(self, poses: Array) -> int:
        """Take poses (N, 7 + n); of so many in all, their ticks are new at the end of the reference."""
        rows = np.concatenate((self._poses, poses))
        rows[:, 3:7] = rot.continuous(rows[:, 3:7])
        count = len(rows) - 2 * WIDE - 3
        self._poses = rows[max(count, 0) :]
        if count <= 0:
            return 0
        new = self._made(rows)
        pairs = zip(self.reference, new, strict=True)
        self.reference = Reference._make(np.concatenate((old[-self._kept :], more)) for old, more in pairs)
        return count

    def _made(self, rows: Array) -> Reference:
        count = len(rows) - 2 * WIDE
        controls = np.zeros((count, rows.shape[1]))
        for k, share in enumerate((_SHARES / _SHARES.sum()).tolist()):
            controls += share * rows[k : k + count]
        spans = np.stack([controls[k : count - 3 + k] for k in range(4)], axis=1)
        path, first, second = (
            (basis(_PARTS, order) * RATE**order @ spans).reshape(-1, rows.shape[1]) for order in range(3)
        )
        path[:, 3:7] = rot.normalise(path[:, 3:7])
        turning, quickening = angular(path[:, 3:7], first[:, 3:7], second[:, 3:7])
        qvel = np.hstack((first[:, :3], turning, first[:, 7:]))
        return dynamics(self._robot, path, qvel, np.hstack((second[:, :3], quickening, second[:, 7:])))
