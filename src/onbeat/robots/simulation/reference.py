"""What a robot is told to do, at the ticks of its controller: postures, and the forces and torques that go with them.

By inverse dynamics, once for the whole dance before it begins: a robot knows its own model and what it is about to do.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline

from onbeat._shapes import Array, Bools, Positions, frozen
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot
from onbeat.robots.state import DEGREE, configurations, derivatives

SIDES = ("left", "right")
TOUCHING = 0.004
"""Metres over the floor under which a corner of a sole is meant to stand on it."""
LONGEST = 3600.0
"""Seconds of a dance at most."""


class Reference(NamedTuple):
    """T ticks of what a robot of n hinges is told, all in the world; the first ``settling`` are its first pose at rest.

    Compiled loops take it as it is: it holds arrays alone.
    """

    qpos: Array
    """(T, 7 + n)."""
    qvel: Array
    """(T, 6 + n)."""
    torque: Array
    """(T, n) N·m of the hinges, were nothing touching the robot."""
    root: Array
    """(T, 3, 3) the root's orientation."""
    spin: Array
    """(T, 3) rad/s, the root's angular velocity."""
    centre: Positions
    """(T, 3) the centre of mass."""
    velocity: Array
    """(T, 3) m/s of it."""
    force: Array
    """(T, 3) N that the floor has to give."""
    moment: Array
    """(T, 3) N·m about the centre of mass that it has to give."""
    turns: Array
    """(T, 2, 3, 3) the feet's orientations."""
    corners: Positions
    """(T, 2, 4, 3) the soles' corners."""
    touching: Bools
    """(T, 2, 4) which of them are meant to stand on the floor."""


def reference(robot: Robot, motion: Motion, rate: float, settling: float) -> Reference:
    """The reference of a motion, ``rate`` ticks a second, after ``settling`` seconds of its first pose at rest.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or longer than :data:`LONGEST`.
    """
    if motion.duration > LONGEST:
        raise BodyError(f"a dance of {motion.duration:.0f} s is too long to simulate; {LONGEST:.0f} s are the most")
    path = resampled(configurations(robot, motion), motion.fps, rate)
    speeds = derivatives(robot, path, rate)
    still = round(settling * rate)
    qpos = np.concatenate((np.repeat(path[:1], still, axis=0), path))
    qvel, qacc = (np.concatenate((np.zeros((still, part.shape[1])), part)) for part in speeds)
    return dynamics(robot, qpos, qvel, qacc)


def resampled(qpos: Array, fps: float, rate: float) -> Array:
    """Configurations (T, 7 + n) at another rate, on the spline of the fifth degree through those (F, 7 + n) at ``fps``.

    Examples
    --------
    >>> path = np.array([[0.0, 0, 1, 1, 0, 0, 0], [1.0, 0, 1, 1, 0, 0, 0]])
    >>> resampled(path, fps=1, rate=2)[:, 0].tolist()
    [0.0, 0.5, 1.0]
    """
    path = np.hstack((qpos[:, :3], rot.continuous(qpos[:, 3:7]), qpos[:, 7:]))
    times = np.arange(len(path)) / fps
    ticks = np.arange(int(np.floor(times[-1] * rate + 1e-6)) + 1) / rate
    if len(path) > 1:
        path = make_interp_spline(times, path, k=min(DEGREE, len(path) - 1))(ticks)
    return np.hstack((path[:, :3], rot.normalise(path[:, 3:7]), path[:, 7:]))


def dynamics(robot: Robot, qpos: Array, qvel: Array, qacc: Array) -> Reference:
    """The reference of configurations (T, 7 + n), and their velocities and accelerations (T, 6 + n), at its ticks."""
    mujoco, model = engine(), robot.model
    data, needed = mujoco.MjData(model), np.zeros(model.nv)
    feet = [model.body(robot.feet[side].link).id for side in SIDES]
    soles = np.stack([robot.feet[side].corners for side in SIDES])
    out = _empty(len(qpos), model.nu)
    for tick in range(len(qpos)):
        data.qpos[:], data.qvel[:], data.qacc[:] = qpos[tick], qvel[tick], qacc[tick]
        _moved(mujoco, model, data)
        mujoco.mj_rne(model, data, 1, needed)
        out.torque[tick] = needed[6:] + model.dof_armature[6:] * qacc[tick, 6:]
        out.root[tick] = data.xmat[1].reshape(3, 3)
        out.force[tick], out.moment[tick] = needed[:3], needed[3:6]
        out.centre[tick], out.velocity[tick] = data.subtree_com[1], data.subtree_linvel[1]
        out.turns[tick] = data.xmat[feet].reshape(2, 3, 3)
        out.corners[tick] = data.xpos[feet][:, None]
    spin = np.einsum("tij,tj->ti", out.root, qvel[:, 3:6])
    about_root = np.einsum("tij,tj->ti", out.root, out.moment)
    moment = about_root + np.cross(qpos[:, :3] - out.centre, out.force)
    corners = out.corners + np.einsum("tfij,fcj->tfci", out.turns, soles)
    touching = corners[..., 2] < TOUCHING
    done = out._replace(qpos=qpos, qvel=qvel, spin=spin, moment=moment, corners=corners, touching=touching)
    parts = done._asdict()
    return Reference(**{name: frozen(part, part.dtype.type) for name, part in parts.items()})


def _moved(mujoco: Any, model: Any, data: Any) -> None:
    """Places and velocities of all bodies, and of the centre of mass."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_comVel(model, data)
    mujoco.mj_subtreeVel(model, data)


def _empty(ticks: int, hinges: int) -> Reference:
    shapes = {"qpos": (7 + hinges,), "qvel": (6 + hinges,), "torque": (hinges,), "root": (3, 3)}
    shapes |= {"turns": (2, 3, 3), "corners": (2, 4, 3)}
    arrays: dict[str, Any] = {name: np.zeros((ticks, *shapes.get(name, (3,)))) for name in Reference._fields}
    return Reference(**arrays)
