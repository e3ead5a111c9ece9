"""A dancer's motion as a robot's: every hinge's angle over time, within its limits, without jumps or collisions.

Unlike :mod:`onbeat.motion.retarget`, which moves a motion between bodies with ball joints, this finds angles of hinges
with limits: the robot's links are to point as the dancer's (:mod:`onbeat.robots.ik.directions`), over the whole dance
at once (:mod:`onbeat.robots.ik.trajectory`), its capsules kept apart (:mod:`onbeat.robots.ik.collision`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline
from threadpoolctl import threadpool_limits

from onbeat._shapes import Array, Times
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.motion import Motion
from onbeat.robots.ik.clear import cleared
from onbeat.robots.ik.collision import capsules_of
from onbeat.robots.ik.directions import Aims, aims_of
from onbeat.robots.ik.mend import mended
from onbeat.robots.ik.trajectory import Problem, Rules, solve
from onbeat.robots.ik.tree import ROOT, tree_of
from onbeat.robots.model import Robot

RATE = 60.0
"""Frames a second at which angles are found, whatever the rate of the motion."""
WINDOW, OVERLAP = 20.0, 1.0
"""Seconds that are solved at once, and that the next window solves anew."""
COARSE = 4
"""Every which frame is found first."""
BEND, DRAG = 0.02, 0.005
"""Seconds, τ and τ_v of the trajectory's cost."""
EASE = 0.03
"""What a radian weighs by which an angle is away from the robot's resting pose."""
APART = 10.0
"""What a metre weighs by which capsules are under their margin."""
SPEED = 0.95
"""Part of the limits of speed that is used."""


def retarget(
    motion: Motion, robot: Robot, keyposes: Times | None = None, progress: Callable[[float], None] | None = None
) -> Motion:
    """A dancer's motion as the robot's, at the same rate and for as long.

    Parameters
    ----------
    motion : of any body with roles.
    robot : the robot.
    keyposes : seconds of the poses that matter most.
    progress : is told the share, 0 to 1, that is done.

    Raises
    ------
    BodyError
        If a role that is needed is missing on either side.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> from onbeat.robots.model import robot_named
    >>> body = Build(1.7).skeleton
    >>> standing = Motion(body, np.tile(rot.IDENTITY, (2, len(body), 1)), np.zeros((2, 3)), fps=30)
    >>> retarget(standing, robot_named("g1")).skeleton.names[0]
    'pelvis'
    """
    count = int(np.ceil((len(motion) - 1) / motion.fps * RATE - 1e-6)) + 1
    times = np.arange(count) / RATE
    dancer = motion.at(times).replace(fps=RATE)
    aims = aims_of(dancer, robot, keyposes)
    with threadpool_limits(1, "blas"):  # bands so narrow are slower on more threads, and differ in their last bits
        found = _solved(robot, aims, progress or (lambda share: None))
    return _as_motion(robot, aims, found, times, motion)


def rules_of(robot: Robot) -> Rules:
    """What a robot's unknowns have to keep to: ranges and speeds of its hinges, and the pose they rest in."""
    body = robot.body
    count = len(body.names)
    wide, free = np.full(ROOT, np.inf), np.zeros(ROOT)
    low, high = np.concatenate((-wide, body.low)), np.concatenate((wide, body.high))
    rest = np.concatenate((free, np.clip(0.0, body.low, body.high)))
    every = np.ones(ROOT + count)
    ease = np.concatenate((free, np.full(count, EASE)))
    speed = np.concatenate((wide, SPEED * body.speed))
    return Rules(low, high, rest, ease, BEND * every, DRAG * every, speed, APART)


def _solved(robot: Robot, aims: Aims, progress: Callable[[float], None]) -> Array:
    """(F, N) the unknowns: first coarsely, then frame by frame, window after window."""
    capsules, frames = capsules_of(robot), len(aims.place)
    problem = Problem(
        tree_of(robot.body), aims, capsules, rules_of(robot), np.ones((frames, len(capsules.pairs))), 1 / RATE
    )
    x = _finer(_coarse(problem.cut(slice(0, frames, COARSE))), frames, problem.rules)
    for start in range(0, frames, int(WINDOW * RATE)):
        end = min(start + int((WINDOW + OVERLAP) * RATE), frames)
        part = slice(max(start - 2, 0), end)
        x[part] = solve(problem.cut(part), x[part], (2 if start else 0, 0)).x
        progress(end / frames)
    return cleared(problem, x)


def _coarse(problem: Problem) -> Array:
    """(F, N) from a pose that is the same for all frames: without looking at collisions, with, and once more."""
    start = np.tile(_bent(problem.rules), (len(problem.push), 1))
    x = solve(problem._replace(push=np.zeros_like(problem.push)), start).x
    return solve(problem, mended(problem, solve(problem, x))).x


def _finer(x: Array, frames: int, rules: Rules) -> Array:
    """Every frame's unknowns from those of each :data:`COARSE`-th."""
    at = np.arange(frames) / COARSE
    fine = CubicSpline(np.arange(len(x)), x)(at) if len(x) > 1 else np.tile(x, (frames, 1))
    return np.clip(fine, rules.low, rules.high)


def _bent(rules: Rules) -> Array:
    """(N,) the rest pose with each hinge bent a little towards the middle of its limits: straight legs bend no way."""
    return np.concatenate((rules.rest[:ROOT], 0.8 * rules.rest[ROOT:] + 0.1 * (rules.low[ROOT:] + rules.high[ROOT:])))


def _as_motion(robot: Robot, aims: Aims, found: Array, times: Times, motion: Motion) -> Motion:
    place = aims.place + found[:, :3]
    turn = rot.continuous(rot.multiply(rot.exp(found[:, 3:6]), rot.from_matrix(aims.turn)))
    values = np.hstack((place, turn, found[:, ROOT:]))
    if len(times) > 1 and motion.fps != RATE:
        values = CubicSpline(times, values)(motion.times)
    angles = np.clip(values[: len(motion), 7:], robot.body.low, robot.body.high)
    angles = held_back(angles, robot.body.speed / motion.fps)
    return hinge_motion(robot.body, values[:, :3], rot.normalise(values[:, 3:7]), angles, motion.fps, motion.name)


def held_back(angles: Array, most: Array) -> Array:
    """Angles (F, n) that change by no more than ``most`` (n,) from frame to frame; the same where they do not.

    The mean of one pass forwards and one backwards, each held back by the last: both are within limits, so their mean
    is; it lags on neither side.

    Examples
    --------
    >>> held_back(np.array([[0.0], [0.0], [4.0], [4.0]]), np.array([2.0])).ravel().tolist()
    [0.0, 1.0, 3.0, 4.0]
    """
    if len(angles) < 2 or (np.abs(np.diff(angles, axis=0)) <= most).all():
        return angles
    forward, backward = angles.copy(), angles.copy()
    for f in range(1, len(angles)):
        forward[f] = np.clip(angles[f], forward[f - 1] - most, forward[f - 1] + most)
        backward[-1 - f] = np.clip(angles[-1 - f], backward[-f] - most, backward[-f] + most)
    return (forward + backward) / 2
