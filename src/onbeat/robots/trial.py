"""What a robot did in a simulation: its motion, where it pressed on the floor, how well it followed, if it fell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from onbeat._shapes import Array, Bools, Times, frozen
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot
from onbeat.robots.simulation.fall import Ground
from onbeat.robots.simulation.reference import Reference
from onbeat.robots.state import motion_of

PRESSED = 1.0
"""Newtons from which on a foot touches the floor."""
SATURATED = 0.999
"""Part of its greatest torque from which on a motor gives all it has."""


@dataclass(frozen=True, eq=False)
class Trial:
    """One simulated dance, of T ticks until its end or the robot's fall, on the dance's clock.

    Parameters
    ----------
    motion : what the robot did, at the rate of the dance.
    fell_at : seconds, or None if it stood to the end.
    why : how it fell.
    times : (T,) seconds.
    error : (T, n) radians, angles less what they were meant to be.
    saturated : (n,) the part of the time in which each motor gave all it has.
    pressure : (T, 2) metres, the point where the floor pressed on the robot; NaN where it did not.
    load : (T, 2) newtons under the left and the right foot.
    """

    motion: Motion
    fell_at: float | None
    why: str | None
    times: Times
    error: Array
    saturated: Array
    pressure: Array
    load: Array

    def __post_init__(self) -> None:
        for name in ("times", "error", "saturated", "pressure", "load"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def upright(self) -> bool:
        """Whether the robot stood to the end."""
        return self.fell_at is None

    @property
    def rms_error(self) -> Array:
        """(n,) radians, the root mean square of each hinge's error."""
        return np.sqrt(np.mean(self.error**2, axis=0))

    @property
    def worst_error(self) -> Array:
        """(n,) radians, the largest error of each hinge."""
        return np.abs(self.error).max(axis=0)

    @property
    def contacts(self) -> Bools:
        """(T, 2) whether the left and the right foot touched the floor."""
        return self.load > PRESSED


class Recorder:
    """Notes a trial down while it happens."""

    def __init__(self, robot: Robot, told: Reference, motion: Motion, rate: float, settling: float) -> None:
        self._robot, self._told, self._motion, self._rate = robot, told, motion, rate
        self._still = round(settling * rate)
        ticks = len(told.qpos) - self._still
        self._qpos = np.zeros((ticks, told.qpos.shape[1]))
        self._full = np.zeros((ticks, told.torque.shape[1]), np.bool_)
        self._pressure, self._load = np.full((ticks, 2), np.nan), np.zeros((ticks, 2))
        self._most = SATURATED * np.asarray(robot.torque)

    def add(self, data: Any, tick: int, ground: Ground) -> None:
        """Note one tick of the dance; those before it are passed over."""
        now = tick - self._still
        if now < 0:
            return
        self._qpos[now] = data.qpos
        self._full[now] = np.abs(data.actuator_force) >= self._most
        if data.ncon:
            self._pressed(data, now, ground)

    def _pressed(self, data: Any, now: int, ground: Ground) -> None:
        contact = data.contact
        pairs, rows = contact.geom, contact.efc_address
        on_floor = ground.floor[pairs].any(axis=1) & (rows >= 0)
        up = data.efc_force[rows[on_floor]]
        total = up.sum()
        side = ground.side[pairs[on_floor]].max(axis=1)
        self._load[now] = up[side == 0].sum(), up[side == 1].sum()
        if total > PRESSED:
            self._pressure[now] = up @ contact.pos[on_floor, :2] / total

    def trial(self, fell: int | None, why: str | None) -> Trial:
        """The trial, which ended at its last tick or with a fall at tick ``fell``."""
        count = len(self._qpos) if fell is None else max(fell - self._still + 1, 1)
        if fell is not None and fell < self._still:
            self._qpos[0] = self._told.qpos[0]
        done = self._qpos[:count]
        meant = self._told.qpos[self._still : self._still + count, 7:]
        return Trial(
            self._as_motion(done),
            None if fell is None else max(fell - self._still, 0) / self._rate,
            why,
            np.arange(count) / self._rate,
            done[:, 7:] - meant,
            self._full[:count].mean(axis=0),
            self._pressure[:count],
            self._load[:count],
        )

    def _as_motion(self, qpos: Array) -> Motion:
        """The motion at the dance's own rate, linear between ticks."""
        fps = self._motion.fps
        frames = min(len(self._motion), int((len(qpos) - 1) / self._rate * fps + 1e-6) + 1)
        at = np.minimum(np.arange(frames) / fps * self._rate, len(qpos) - 1)
        low = at.astype(np.int64)
        part = (at - low)[:, None]
        path = np.hstack((qpos[:, :3], rot.continuous(qpos[:, 3:7]), qpos[:, 7:]))
        between = path[low] * (1 - part) + path[np.minimum(low + 1, len(qpos) - 1)] * part
        return motion_of(self._robot, between, fps, self._motion.name)
