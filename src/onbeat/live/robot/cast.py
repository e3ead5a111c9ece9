"""A robot that dances given choreographies live: prepared before the session, inside its limits in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import PlanError
from onbeat.live.bodies.dancers import Machine, points_of
from onbeat.live.cast import Cast, Drawn, Known, distinct
from onbeat.live.choice.choreography import Choreography, Repertoire
from onbeat.live.conductor import Conductor, Rest
from onbeat.live.protocol import RATE, Pose, Step, Who
from onbeat.live.robot.bounds import bounds_of
from onbeat.live.robot.dance import prepare
from onbeat.live.robot.line import RobotLine
from onbeat.live.robot.rest import resting
from onbeat.live.robot.simulation import Simulation
from onbeat.live.session import Tried
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.pages.content import body_data
from onbeat.viewer.robot_shape import ROBOT, robot_shape

Progress = Callable[[str, float], None]
FASTEST = 1.2
"""Rate at which a choreography is played at most: with the clock's ups on top it stays within what was balanced."""


def on_robot(dances: Sequence[Known], robot: Robot, simulate: bool = False, progress: Progress | None = None) -> Cast:
    """A robot that dances choreographies.

    Parameters
    ----------
    dances : one or more.
    robot : the model.
    simulate : whether it is tried in MuJoCo.
    progress : is told the stage and its share that is done.

    Raises
    ------
    PlanError
        If there is none, or one has less than two beats.
    BodyError
        If one cannot be the robot's.
    """
    if not dances:
        raise PlanError("no choreography to dance; give one motion or more")
    tell = progress or (lambda stage, share: None)
    tell("preparing", 0.0)
    names = distinct([dance.motion.name or f"dance {k + 1}" for k, dance in enumerate(dances)])
    prepared, plans = [], list[Choreography]()
    for k, (name, dance) in enumerate(zip(names, dances, strict=True)):
        made = prepare(dance.motion, robot, dance.beats, dance.keyposes)
        prepared.append(made)
        plans.append(Choreography(name, k, made.duration, made.beats, dance.meter, made.keyposes))
        tell("preparing", (k + 1) / (len(dances) + 1))
    rest = resting(robot)
    line = RobotLine([*prepared, rest], robot)
    conductor = Conductor(line, Repertoire(plans, fastest=FASTEST), Rest(len(dances), rest.duration))
    return _cast(robot, line, conductor, simulate)


def _cast(robot: Robot, line: RobotLine, conductor: Conductor, simulate: bool) -> Cast:
    times = np.arange(RATE) / RATE
    roots, turns = line.root(times)
    stood = hinge_motion(robot.body, roots, turns, line.angles(times), RATE, robot.name)
    shown, shape = robot_shape(stood, robot)
    drawn = body_data(shown[:2], 1, shape=shape, palette=ROBOT)
    points = np.array([shown.skeleton.index(joint) for joint in drawn.joints], dtype=np.int64)
    dancer = Machine(line, robot.body, bounds_of(robot), shown.skeleton, points)
    skeleton = robot.body.skeleton
    who = Who(
        robot.name,
        "robot",
        skeleton.names,
        tuple(skeleton.parents.tolist()),
        robot.body.names,
        tuple(drawn.joints),
    )
    floor = ground_height(Figure.from_capsules(shape, ROBOT), shown)
    tried = (
        _simulated(robot, dancer, np.concatenate((roots[0], turns[0], line.angles(times[:1])[0]))) if simulate else None
    )
    return Cast(who, dancer, conductor, Drawn(tuple(drawn.capsules), tuple(drawn.spine), floor, _facing(stood)), tried)


def _simulated(robot: Robot, dancer: Machine, first: Array) -> Tried:
    """The robot in MuJoCo, drawn as it then is."""
    simulation = Simulation(robot, first)

    def tried(poses: Sequence[Pose]) -> Step:
        step = simulation.step(poses)
        if not step.poses:
            return step
        roots, turns, angles = (
            np.stack(part) for part in zip(*((p.root, p.rotations[0], p.angles) for p in step.poses), strict=True)
        )
        points = points_of(dancer, roots, turns, angles)
        return Step([replace(pose, points=points[k]) for k, pose in enumerate(step.poses)], step.events)

    return tried


def _facing(motion: Motion) -> float:
    """Yaw of the root, from +Y: robots are built along +X."""
    w, x, y, z = motion.rotations[0, 0]
    return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) - np.pi / 2)
