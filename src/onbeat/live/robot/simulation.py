"""A robot in MuJoCo in the loop: it is told poses, stands on its own feet, may fall, and is put up again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import BodyError
from onbeat.live.protocol import RATE, Note, Pose, Step
from onbeat.live.robot.ticks import EACH, Ticks
from onbeat.robots.model import Robot
from onbeat.robots.simulation.fall import Ground, fallen
from onbeat.robots.simulation.world import Options, World

SETTLING = 1.0
"""Seconds for which it stands in its first pose before it is told any other."""
LYING = 3.0
"""Seconds after a fall after which it is put up again."""


class Simulation:
    """A simulated robot that is told poses and does what it can.

    What it did is known 60 ms after what it was told, in the time of poses: of a lump the last six come with the next.
    Poses that come out tell no points.

    Parameters
    ----------
    robot : n hinges.
    first : (7 + n,) the configuration in which it stands at first.
    options : as of a simulated dance; its sensors' feedback without any.
    rng : of the sensors' noise; without one, the same each time.

    ``fallen_at`` is the second since which it lies, None while it stands; ``why`` is how it fell last, ``falls`` how
    often.

    Raises
    ------
    BodyError
        If the configuration is not the robot's.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> g1 = robot_named("g1")
    >>> qpos = g1.model.qpos0
    >>> simulation = Simulation(g1, qpos)
    >>> none = np.zeros((0, 3), np.float32)
    >>> step = simulation.step([Pose(k, k / RATE, qpos[:3], qpos[None, 3:7], qpos[7:], none) for k in range(20)])
    >>> [pose.number for pose in step.poses] == list(range(14)), simulation.fallen_at
    (True, None)
    """

    def __init__(
        self,
        robot: Robot,
        first: Array,
        options: Options | None = None,
        rng: np.random.Generator | None = None,
    ) -> None:
        first = np.asarray(first, np.float64)
        if first.shape != (robot.model.nq,) or not np.isfinite(first).all():
            raise BodyError(
                f"a first pose of shape {first.shape} is not {robot.name}'s; {robot.model.nq} finite numbers are"
            )
        options = options or Options()
        self.robot, self.falls = robot, 0
        self.fallen_at: float | None = None
        self.why: str | None = None
        self._ticks = Ticks(robot, first, options.late + 2)
        self._world = World(robot, self._ticks.reference, options, rng or np.random.default_rng(0))
        self._ground = Ground(robot)
        self._waiting: list[Pose] = []
        self._up = 0.0
        for _ in range(round(SETTLING * RATE) * EACH):
            self._world.step(len(self._ticks.reference.qpos) - 1, -1.0)

    def step(self, poses: Sequence[Pose]) -> Step:
        """Take the next poses; what came of those that are far enough back, and a note of each fall.

        Raises
        ------
        BodyError
            If they are not the robot's, or not the next ones.
        """
        if not poses:
            return Step()
        self._check(poses)
        self._waiting.extend(poses)
        ready = self._ticks.add(np.stack([np.concatenate((p.root, p.rotations[0], p.angles)) for p in poses]))
        self._world.go_on(self._ticks.reference)
        first = len(self._ticks.reference.qpos) - ready * EACH
        notes, done = list[Note](), list[Pose]()
        told, self._waiting = self._waiting[:ready], self._waiting[ready:]
        for k, pose in enumerate(told):
            notes += self._looked_after(pose.time, first + k * EACH)
            done.append(_as_it_is(pose, self._world.data.qpos.copy()))
            self._danced(pose.time, first + k * EACH)
        return Step(done, notes)

    def _check(self, poses: Sequence[Pose]) -> None:
        before = self._waiting[-1].number if self._waiting else poses[0].number - 1
        for pose in poses:
            if pose.number != before + 1:
                raise BodyError(f"pose {pose.number} came after pose {before}; pose {before + 1} is expected")
            before = pose.number
            size = pose.root.size + pose.rotations.size + pose.angles.size
            finite = np.isfinite(pose.root).all() and np.isfinite(pose.rotations).all()
            if size != self.robot.model.nq or not (finite and np.isfinite(pose.angles).all()):
                raise BodyError(f"pose {pose.number} is not {self.robot.name}'s, or a number of it is none")

    def _looked_after(self, time: float, tick: int) -> list[Note]:
        """Whether it has fallen since, or is to be put up again."""
        told, world = self._ticks.reference, self._world
        if self.fallen_at is not None:
            if time < self._up:
                return []
            world.place(tick)
            self.fallen_at = None
            return [Note(time, "the robot is put up again")]
        qpos, meant = world.data.qpos, told.root[tick, :, 2]
        if np.isfinite(qpos).all():
            why = fallen(qpos, world.up, told.qpos[tick], meant, self._ground.touched(world.data))
        else:
            why = "its simulation went out of bounds"
        if why is None:
            return []
        self.fallen_at, self.why, self._up = time, why, time + LYING
        self.falls += 1
        return [Note(time, f"the robot fell: {why}; it is put up again in {LYING:.0f} s")]

    def _danced(self, time: float, tick: int) -> None:
        for k in range(EACH):
            if self.fallen_at is None:
                self._world.step(tick + k, time + k / (RATE * EACH))
            else:
                self._world.lie()


def _as_it_is(told: Pose, qpos: Array) -> Pose:
    """The pose of what was told, as it came; places of joints are not known here."""
    return Pose(told.number, told.time, qpos[:3], qpos[None, 3:7], qpos[7:], np.zeros((0, 3), np.float32))
