"""Motions of a robot as an engine's configurations and back, and their derivatives.

A configuration ``qpos`` is ``x y z``, ``w x y z`` of the root in the world, and the hinges' angles in the order of the
model; a velocity ``qvel`` is the root's in the world, its angular velocity in its own frame, and the hinges'.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline

from onbeat._shapes import Array, frozen
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_angles, hinge_motion
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot

DEGREE = 5
"""Of the splines: a curve of this degree has an acceleration without corners."""

_ROUNDED = 1e-5
"""A quaternion whose length is nearer to one than this was only rounded, and is kept as it is."""


class Derivatives(NamedTuple):
    """Velocities and accelerations (F, 6 + n) of configurations, as MuJoCo has them."""

    qvel: Array
    qacc: Array


def configurations(robot: Robot, motion: Motion) -> Array:
    """The configurations (F, 7 + n) of a motion of the robot.

    Raises
    ------
    BodyError
        If the motion's skeleton is not the robot's, or a joint is turned out of its hinge.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> g1 = robot_named("g1")
    >>> bent = motion_of(g1, np.concatenate([[0, 0, 0.8, 1, 0, 0, 0], np.full(29, 0.1)])[None], fps=50)
    >>> configurations(g1, bent)[0, [2, 3, 7, 35]].round(9).tolist()
    [0.8, 1.0, 0.1, 0.1]
    """
    angles = hinge_angles(robot.body, motion)
    root = int(robot.body.found_in(motion.skeleton)[0])
    if root == 0:
        return np.hstack((motion.root_positions, motion.rotations[:, 0], angles))
    return np.hstack((motion.positions[:, root], motion.world_rotations[:, root], angles))


def motion_of(robot: Robot, qpos: Array, fps: float, name: str = "") -> Motion:
    """The motion that configurations (F, 7 + n) are; the inverse of :func:`configurations`.

    Raises
    ------
    BodyError
        If there are not 7 + n columns, or a frame's root has no orientation or a value is no number.
    """
    qpos = _checked(robot, qpos)
    turns = qpos[:, 3:7]
    off = np.abs(np.linalg.norm(turns, axis=1, keepdims=True) - 1) > _ROUNDED
    return hinge_motion(robot.body, qpos[:, :3], np.where(off, rot.normalise(turns), turns), qpos[:, 7:], fps, name)


def derivatives(robot: Robot, qpos: Array, fps: float) -> Derivatives:
    """Velocities and accelerations of a smooth path of configurations, at its frames.

    Through the frames goes a spline of the fifth degree; of fewer than six frames of a lower one, and a single frame
    is at rest. With the spline of the quaternions ``q(t)``, which is of unit length at the frames,

        ω = 2 vec(q* q̇) / |q|²,   ω̇ = 2 (vec(q* q̈) − (q·q̇) ω) / |q|².

    Parameters
    ----------
    robot : n hinges.
    qpos : (F, 7 + n) as :func:`configurations` makes it.
    fps : its frames a second.

    Raises
    ------
    BodyError
        If there are not 7 + n columns, a value is no number, or the rate is not above zero.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> g1, times = robot_named("g1"), np.arange(60) / 60
    >>> qpos = np.zeros((60, 36))
    >>> qpos[:, 3:7] = rot.about(np.array([0, 0, 1.0]), times**2)
    >>> qvel, qacc = derivatives(g1, qpos, 60)
    >>> qvel[30, 5].round(6).item(), qacc[30, 5].round(6).item()
    (1.0, 2.0)
    """
    qpos = _checked(robot, qpos)
    if not (np.isfinite(fps) and fps > 0):
        raise BodyError(f"configurations at {fps} frames a second have no velocity; a rate above zero is expected")
    frames, columns = qpos.shape
    if frames == 1:
        return Derivatives(frozen(np.zeros((1, columns - 1))), frozen(np.zeros((1, columns - 1))))
    path = np.hstack((qpos[:, :3], rot.continuous(rot.normalise(qpos[:, 3:7])), qpos[:, 7:]))
    times = np.arange(frames) / fps
    spline = make_interp_spline(times, path, k=min(DEGREE, frames - 1))
    first, second = spline(times, 1), spline(times, 2)
    turning, quickening = angular(path[:, 3:7], first[:, 3:7], second[:, 3:7])
    return Derivatives(
        frozen(np.hstack((first[:, :3], turning, first[:, 7:]))),
        frozen(np.hstack((second[:, :3], quickening, second[:, 7:]))),
    )


def angular(q: Array, first: Array, second: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration (F, 3) in the turning frame, of quaternions and their derivatives (F, 4)."""
    turning = 2 * rot.multiply(rot.inverse(q), first)[:, 1:]
    slack = np.sum(q * first, axis=1, keepdims=True)
    return turning, 2 * (rot.multiply(rot.inverse(q), second)[:, 1:] - slack * turning)


def _checked(robot: Robot, qpos: Array) -> Array:
    qpos = np.asarray(qpos, np.float64)
    columns = 7 + len(robot.body.names)
    if qpos.ndim != 2 or qpos.shape[1] != columns or len(qpos) == 0:
        raise BodyError(f"configurations of shape {qpos.shape} are not {robot.name}'s; (frames, {columns}) is expected")
    if not (np.abs(qpos) < 1e9).all():
        frame = int(np.argmin((np.abs(qpos) < 1e9).all(axis=1)))
        raise BodyError(f"frame {frame} of the configurations has a value that no robot can have")
    length = np.linalg.norm(qpos[:, 3:7], axis=1)
    if length.min() < 0.5:
        raise BodyError(f"frame {int(length.argmin())} of the configurations has a root that is turned in no way")
    return qpos
