"""A dance on a robot: its hinges retimed inside limits, its feet on the floor, its balance kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from onbeat._shapes import Bools, Times
from onbeat.errors import BodyError
from onbeat.limits.limits import Limits
from onbeat.motion.hinges import hinge_angles
from onbeat.motion.motion import Motion
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Demand
from onbeat.retime.lock import TimeMap
from onbeat.retime.measures import Measures, measure
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import Robot as Hinges
from onbeat.robots.balance import Balanced, balanced
from onbeat.robots.calm import ACCELERATION, calmed
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.own import Danced, planted, stepping
from onbeat.robots.model import Robot
from onbeat.robots.retarget import retarget
from onbeat.robots.upright import root_tilt, trunk_tilt, warn_of_lying

Feet = Literal["planted", "stepping"]
Stage = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Staged:
    """A dance as a robot is to dance it, and how it came about; times are the music's seconds from ``start`` on.

    Parameters
    ----------
    motion : of the robot, its frame 0 at second ``start`` of the music.
    start : seconds.
    dancer : the dance as the robot's without limits of time: retargeted where it was a character's.
    retimed : its hinges in the music's time.
    legs : the motion on legs of the robot's own, before its balance was looked after.
    standing : (F, 2) true where the left, right foot stands.
    balanced : see there.
    limits : how well the motion keeps the body's limits, looked at a thousand times a second.
    """

    motion: Motion
    start: float
    dancer: Motion
    retimed: Retimed
    legs: Motion
    standing: Bools
    balanced: Balanced
    limits: Measures

    @property
    def beats(self) -> Times:
        """Seconds of the music at which the dance's beats are."""
        return self.retimed.beats


def stage(
    dance: Motion,
    robot: Robot,
    warp: TimeMap,
    beats: Times,
    keyposes: Times,
    feet: Feet = "planted",
    fps: float | None = None,
    until: float = np.inf,
    progress: Stage | None = None,
    method: str = "qp",
) -> Staged:
    """A dance on a robot, in the music's time.

    Parameters
    ----------
    dance : of any body with roles, or of the robot itself.
    robot : the model.
    warp : the music's seconds to the dance's own.
    beats, keyposes : seconds of the dance's own.
    feet : "planted", both where they are all the time, or "stepping", where the dancer steps.
    fps : frames a second; as the dance without it.
    until : second of the music at which it ends at the latest.
    progress : is told the stage and its share that is done.
    method : of ``onbeat.retime.methods``, by which the hinges are brought inside their limits.

    Raises
    ------
    BodyError
        If the dance cannot be the robot's.
    PlanError
        If it has no time in the music.
    """
    tell = progress or (lambda stage, share: None)
    Legs.of(robot)  # what it cannot stand on is said before anything is done
    is_own = is_of(dance, robot)
    warn_of_lying(root_tilt(dance) if is_own else trunk_tilt(dance), dance.fps)
    own = dance if is_own else retarget(dance, robot, keyposes, lambda share: tell("retarget", share))
    source, limits = Hinges(own, robot.body), limits_of(robot)
    retimed = retime(source, warp, limits, beats, keyposes, method, fps, until, lambda share: tell("retime", share))
    assert isinstance(retimed.dance, Motion)
    tell("legs", 0.0)
    danced: Danced = (planted if feet == "planted" else stepping)(calmed(retimed.dance, robot), robot)
    tell("balance", 0.0)
    kept = balanced(danced.motion, robot, danced.standing)
    over = kept_limits(kept.motion, robot)
    return Staged(kept.motion, retimed.start, own, retimed, danced.motion, danced.standing, kept, over)


def is_of(dance: Motion, robot: Robot) -> bool:
    """Whether a motion is the robot's own."""
    try:
        robot.body.found_in(dance.skeleton)
    except BodyError:
        return False
    return True


def limits_of(robot: Robot) -> Limits:
    """What the hinges of a robot can do: the ranges and speeds of its model, and accelerations that it can balance."""
    body = robot.body
    quickly = np.full(len(body.names), ACCELERATION)
    return Limits(body.name, body.names, body.low, body.high, body.speed, quickly, source=robot.source)


def kept_limits(motion: Motion, robot: Robot) -> Measures:
    """How well a robot's motion keeps the ranges and speeds of its hinges between its frames."""
    body, free = robot.body, np.full(len(robot.body.names), np.inf)
    curve = Spline.through(hinge_angles(body, motion), motion.fps)
    demand = Demand(curve, body.low, body.high, body.speed, free, free, np.zeros(0), TimeMap.steady(2.0))
    return measure(demand, curve)
