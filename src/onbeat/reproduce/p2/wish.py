"""A dance as a robot's angles, which methods are then to bring inside its limits.

They are found twice. *As captured* they are found with no thought of how fast the robot's hinges are, as joint angles
of a captured dancer know nothing of it: this is the paper's setting. *As planned* they are found as onbeat finds them,
where a step past a hinge's speed has its price, so that less is left for a method to do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from onbeat.errors import MissingExtraError
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_angles, hinge_motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.reproduce.p2.takes import Solo
from onbeat.retime.sources import Table
from onbeat.retime.upper_body import above_the_legs
from onbeat.robots.engine import engine
from onbeat.robots.ik.collision import Capsules
from onbeat.robots.ik.directions import aims_of
from onbeat.robots.ik.trajectory import Problem, solve
from onbeat.robots.ik.tree import ROOT, tree_of
from onbeat.robots.model import Robot
from onbeat.robots.retarget import RATE, retarget, rules_of

UNBOUND = 1e3
"""rad/s, faster than any hinge of any robot."""
BENT = 0.2
"""Share of the way from a hinge's rest to the middle of its range at which it is begun: straight limbs bend no way."""


def why_not() -> str | None:
    """Why nothing can be simulated here; None where it can."""
    try:
        engine()
    except MissingExtraError as error:
        return str(error)
    return None


def on_robot(solo: Solo, robot: Robot, *, captured: bool, progress: Callable[[float], None] | None = None) -> Motion:
    """The dance as the robot's: as ``captured``, or as planned, with a price on what its hinges are too slow for.

    Where MuJoCo is not there, which knows what of a robot collides, its links may go through each other. ``progress``
    is told the share, 0 to 1, that is done.
    """
    free = replace(robot, body=replace(robot.body, speed=np.full(len(robot.body.names), UNBOUND)))
    body = free if captured else robot
    if why_not() is None:
        return retarget(solo.motion, body, solo.keyposes, progress)
    return without_collisions(solo, body)


def without_collisions(solo: Solo, robot: Robot) -> Motion:
    """The dance as the robot's angles at 60 frames a second, on the spot, whatever touches whatever."""
    count = int(np.ceil((len(solo.motion) - 1) / solo.motion.fps * RATE - 1e-6)) + 1
    dancer = solo.motion.at(np.minimum(np.arange(count) / RATE, solo.motion.times[-1])).replace(fps=RATE)
    aims, rules = aims_of(dancer, robot, solo.keyposes), rules_of(robot)
    none = np.zeros(0)
    capsules = Capsules(np.zeros(0, np.int64), np.zeros((0, 2, 3)), none, none, np.zeros((0, 2), np.int64), none)
    problem = Problem(tree_of(robot.body), aims, capsules, rules, np.ones((count, 0)), 1 / RATE)
    rest, middle = rules.rest[ROOT:], (rules.low[ROOT:] + rules.high[ROOT:]) / 2
    begin = np.concatenate((rules.rest[:ROOT], rest + BENT * (middle - rest)))
    angles = solve(problem, np.tile(begin, (count, 1))).x[:, ROOT:]
    still = np.zeros((count, 3)), np.tile(rot.IDENTITY, (count, 1))
    return hinge_motion(robot.body, *still, angles, RATE, solo.motion.name)


def upper_table(robot: Robot, motion: Motion) -> Table:
    """The angles of the robot's hinges above its legs."""
    above = {robot.body.skeleton.names[joint] for joint in above_the_legs(robot.body.skeleton)}
    places = [n for n, name in enumerate(robot.body.names) if name in above]
    angles = hinge_angles(robot.body, motion)[:, places]
    return Table(JointAngles(tuple(robot.body.names[n] for n in places), angles, motion.fps, motion.name))
