"""Dances prepared for a robot before a session begins: all on its own legs, planted in one stance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import PlanError
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.motion import Motion
from onbeat.retime.lock import TimeMap
from onbeat.retime.retime import retime
from onbeat.retime.sources import Robot as Hinges
from onbeat.robots.balance import balanced
from onbeat.robots.calm import calmed
from onbeat.robots.legs.planted import Stance, planted
from onbeat.robots.model import Robot
from onbeat.robots.perform import Stage, is_of, limits_of
from onbeat.robots.retarget import retarget

FPS = 60.0
"""Frames a second of a prepared dance."""
PACE = 1.4
"""At which its balance is looked after: of a tempo and its half the nearer one is up to so much faster.

The zero-moment point of a slower pace lies between that of this one and the point below the centre of mass; where both
of these are inside the feet, so is all between.
"""
STANCE = Stance()
"""Where feet are for the whole of a session: dances that go over into one another have to agree on it."""


@dataclass(frozen=True, eq=False)
class RobotDance:
    """A dance as a robot can dance it at its own tempo.

    Parameters
    ----------
    motion : of the robot, balanced, its feet planted in :data:`STANCE`.
    angles : (F, n) radians of its hinges.
    beats, keyposes : seconds of the motion.
    """

    motion: Motion
    angles: Array
    beats: Times
    keyposes: Times

    def __post_init__(self) -> None:
        for name in ("angles", "beats", "keyposes"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def name(self) -> str:
        """The motion's."""
        return self.motion.name

    @property
    def duration(self) -> float:
        """Seconds from its first frame to its last."""
        return (len(self.motion) - 1) / self.motion.fps


def prepare(dance: Motion, robot: Robot, beats: Times, keyposes: Times, progress: Stage | None = None) -> RobotDance:
    """A dance on a robot's own planted legs, balanced, at its own tempo.

    Parameters
    ----------
    dance : of any body with roles, or of the robot itself.
    robot : the model.
    beats, keyposes : seconds of the dance.
    progress : is told the stage and its share that is done.

    Raises
    ------
    BodyError
        If the dance cannot be the robot's.
    PlanError
        If it is shorter than a second.
    """
    if not dance.duration >= 1.0:
        raise PlanError(f"{dance.name or 'a dance'} of {dance.duration:.2f} s is too short; a second is the least")
    tell = progress or (lambda stage, share: None)
    own = dance if is_of(dance, robot) else retarget(dance, robot, keyposes, lambda share: tell("retarget", share))
    counted = np.asarray(beats, np.float64) if len(beats) > 1 else np.array([0.0, dance.duration])
    source, limits, steady = Hinges(own, robot.body), limits_of(robot), TimeMap.steady(1.0)
    retimed = retime(source, steady, limits, counted, keyposes, "qp", FPS, progress=lambda share: tell("retime", share))
    assert isinstance(retimed.dance, Motion)
    tell("legs", 0.0)
    standing = planted(calmed(retimed.dance, robot).replace(fps=PACE * FPS), robot, STANCE)
    tell("balance", 0.0)
    motion = balanced(standing.motion, robot, standing.standing).motion.replace(fps=FPS)
    met = np.asarray(retimed.measures.keyposes) - retimed.start
    return RobotDance(motion, hinge_angles(robot.body, motion), np.asarray(beats, np.float64) - retimed.start, met)
