"""A dance on a robot in MuJoCo: motors with limits, a floor with friction, and feedback that the robot could run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot
from onbeat.robots.simulation.fall import Ground, fallen
from onbeat.robots.simulation.reference import reference
from onbeat.robots.simulation.world import RATE, Options, World
from onbeat.robots.trial import Recorder, Trial

__all__ = ["RATE", "SETTLING", "Options", "simulate"]

SETTLING = 1.0
"""Seconds for which the first pose is held before the dance begins."""


def simulate(
    robot: Robot,
    motion: Motion,
    options: Options | None = None,
    *,
    rng: np.random.Generator | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trial:
    """Let a robot dance, from standing in the first pose until the dance is over or the robot has fallen.

    Parameters
    ----------
    robot : the model.
    motion : of the robot.
    options : how.
    rng : of noise and of random masses; without one, the same each time.
    progress : called with the part of the dance that is done.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or an option cannot be.
    """
    options, rng = options or Options(), rng or np.random.default_rng(0)
    told = reference(robot, motion, RATE, SETTLING)
    world = World(robot, told, options, rng, SETTLING)
    recorder = Recorder(robot, told, motion, RATE, SETTLING)
    ground = Ground(robot)
    for tick in range(len(told.qpos)):
        world.step(tick)
        recorder.add(world.data, tick, ground)
        why = fallen(world.data.qpos, world.up, told.qpos[tick], told.root[tick, :, 2], ground.touched(world.data))
        if why is not None:
            return recorder.trial(tick, why)
        if progress is not None and tick % 50 == 0:
            progress(tick / len(told.qpos))
    return recorder.trial(None, None)
