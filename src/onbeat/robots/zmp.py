"""The zero-moment point: where on the floor the floor's force has to press for a robot to move as it does.

With the force f and the moment τ (about the root's place p) that the floor has to give, found by inverse dynamics,

    x = p_x − (τ_y + p_z f_x) / f_z,  y = p_y + (τ_x − p_z f_y) / f_z

(Vukobratović and Borovac 2004). As long as this point lies inside the support polygon the feet stay where they are.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot

FREE = 0.05
"""Part of the weight under which nothing presses on the floor; the point is then far away rather than undefined."""
GRAVITY = 9.81
"""m/s², as in the models."""


def zmp(robot: Robot, qpos: Array, qvel: Array, qacc: Array) -> Array:
    """The zero-moment points (F, 2) in metres on the floor z = 0, by recursive Newton–Euler on the whole body.

    Parameters
    ----------
    robot : the model.
    qpos : (F, 7 + n) place and quaternion wxyz of the root, angles.
    qvel, qacc : (F, 6 + n) velocities and accelerations; of the root's turn in its own frame, as MuJoCo has them.

    Raises
    ------
    BodyError
        If the shapes are not the robot's.
    """
    return points(robot, qpos[:, :3], *floor_wrench(robot, qpos, qvel, qacc))


def points(robot: Robot, root: Positions, force: Array, moment: Array) -> Array:
    """The zero-moment points (F, 2) of forces and moments about the root's places, all (F, 3)."""
    up = np.maximum(force[:, 2], FREE * robot.mass * GRAVITY)
    x = root[:, 0] - (moment[:, 1] + root[:, 2] * force[:, 0]) / up
    y = root[:, 1] + (moment[:, 0] - root[:, 2] * force[:, 1]) / up
    return np.stack((x, y), axis=1)


def floor_wrench(robot: Robot, qpos: Array, qvel: Array, qacc: Array) -> tuple[Array, Array]:
    """Force (F, 3) in N and moment (F, 3) in N·m about the root's place that the floor has to give, in the world."""
    mujoco, model = engine(), robot.model
    _check_shapes(model.nq, model.nv, qpos, qvel, qacc)
    data = mujoco.MjData(model)
    result, wrench = np.zeros(model.nv), np.empty((len(qpos), 6))
    for frame in range(len(qpos)):
        data.qpos[:], data.qvel[:], data.qacc[:] = qpos[frame], qvel[frame], qacc[frame]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 1, result)
        wrench[frame] = result[:6]
    return wrench[:, :3], rot.rotate(qpos[:, 3:7], wrench[:, 3:])


def link_centres(robot: Robot, qpos: Array) -> Positions:
    """The centres of mass (F, bodies, 3) in metres of the model's bodies; the first is the world."""
    mujoco, model = engine(), robot.model
    _check_shapes(model.nq, model.nv, qpos)
    data, out = mujoco.MjData(model), np.empty((len(qpos), model.nbody, 3))
    for frame in range(len(qpos)):
        data.qpos[:] = qpos[frame]
        mujoco.mj_kinematics(model, data)
        out[frame] = data.xipos
    return out


def centres_of_mass(robot: Robot, qpos: Array) -> Positions:
    """The whole body's centre of mass (F, 3) in metres."""
    mass = robot.model.body_mass
    return np.einsum("fbd,b->fd", link_centres(robot, qpos), mass / mass.sum())


def _check_shapes(positions: int, velocities: int, qpos: Array, *rates: Array) -> None:
    frames = len(qpos)
    if qpos.shape != (frames, positions) or any(rate.shape != (frames, velocities) for rate in rates):
        found = ", ".join(str(values.shape) for values in (qpos, *rates))
        raise BodyError(f"configurations and rates of shapes {found}; (frames, {positions}) and (…, {velocities}) fit")
