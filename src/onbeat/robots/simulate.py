"""A dance on a robot in MuJoCo: motors with limits, a floor with friction, and feedback that the robot could run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import BodyError
from onbeat.motion.motion import Motion
from onbeat.robots import disturb, feedback
from onbeat.robots.engine import engine
from onbeat.robots.estimator import Estimate, Noise, Truth
from onbeat.robots.fall import Ground, fallen
from onbeat.robots.model import Robot
from onbeat.robots.reference import SIDES, Reference, reference
from onbeat.robots.servo import Gains, Servos, servos
from onbeat.robots.trial import Recorder, Trial

Feedback = Literal["none", "truth", "estimate"]
STEP = 0.001
"""Seconds of a step of the simulation."""
STEPS = 2
"""Of it to a tick of the controller, which is at 500 Hz."""
RATE = 1 / (STEP * STEPS)
SETTLING = 1.0
"""Seconds for which the first pose is held before the dance begins."""
LATE = 0.01
"""Seconds between a sensor and what is done about it, unless told."""


@dataclass(frozen=True)
class Options:
    """How a dance is simulated.

    Parameters
    ----------
    feedback : "none": the servos alone; "truth": balanced by the robot's real state; "estimate": by what its sensors
        tell.
    gains : of the servos.
    feedforward : whether the servos get the torques that the dance needs by inverse dynamics.
    friction : of everything on the floor; the model's own where it is None.
    mass_scale, mass_spread : how much heavier all bodies are than the controller thinks, and by up to which part more
        or less each.
    delay : seconds by which the feedback is late; None: not at all by the truth, :data:`LATE` by estimates.
    noise : of the sensors.
    pushes : on the trunk.
    """

    feedback: Feedback = "estimate"
    gains: Gains = field(default_factory=Gains)
    feedforward: bool = True
    friction: float | None = None
    mass_scale: float = 1.0
    mass_spread: float = 0.0
    delay: float | None = None
    noise: Noise = field(default_factory=Noise)
    pushes: Sequence[disturb.Push] = ()

    @property
    def late(self) -> int:
        """Ticks by which the feedback is late."""
        delay = (LATE if self.feedback == "estimate" else 0.0) if self.delay is None else self.delay
        if not 0 <= delay <= 1:
            raise BodyError(f"feedback that is late by {delay:g} s cannot be; 0 to 1 s are expected")
        return round(delay * RATE)


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
    world = _World(robot, told, options, rng)
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


class _World:
    """A robot on its floor, its servos and its controller."""

    def __init__(self, robot: Robot, told: Reference, options: Options, rng: np.random.Generator) -> None:
        mujoco = engine()
        self._mujoco, self._told, self._options = mujoco, told, options
        balanced = options.feedback != "none"
        self._servos = servos(robot, told.qpos[0], options.gains, standing=not balanced)
        self._model = disturbed(robot, self._servos, options, rng)
        self.data = mujoco.MjData(self._model)
        self.data.qpos[:] = told.qpos[0]
        mujoco.mj_forward(self._model, self.data)
        self.up = self.data.xmat[1].reshape(3, 3)[:, 2]
        self._trunk = disturb.trunk_of(robot)
        self._balance = _Balance(robot, told)
        sensors = options.late if balanced else 0
        self._sensors = (
            Estimate(told, RATE, sensors, options.noise, rng)
            if options.feedback == "estimate"
            else Truth(told, sensors)
        )

    def step(self, tick: int) -> None:
        """One tick: sense, command, and let time go by."""
        told, data = self._told, self.data
        if self._options.feedback != "none":
            torque = self._balance.torques(*self._sensors.state(data, tick), tick)
        elif self._options.feedforward:
            torque = self._balance.torques(told.qpos[tick], told.qvel[tick], tick)
        else:
            torque = np.zeros_like(told.torque[0])
        data.ctrl[:] = self._servos.command(told.qpos[tick, 7:], told.qvel[tick, 6:], torque)
        disturb.push(data, self._trunk, self._options.pushes, tick / RATE - SETTLING)
        self._mujoco.mj_step(self._model, data, STEPS)


class _Balance:
    """The feedback, on the model that the controller has of the robot."""

    def __init__(self, robot: Robot, told: Reference) -> None:
        mujoco, model = engine(), robot.model
        self._mujoco, self._model, self._told = mujoco, model, told
        self._data = data = mujoco.MjData(model)
        self._feet = [int(model.body(robot.feet[side].link).id) for side in SIDES]
        self._law = feedback.law_of(robot, told, _inertia(model, told))
        self._torques = np.zeros(model.nu)
        # Views of both feet, which MuJoCo fills: the left one's row and, so many rows on or back, the right one's.
        rows = slice(self._feet[0], None, self._feet[1] - self._feet[0])
        self._jacobians = np.zeros((2, 6, model.nv))
        self._sensed = feedback.Sensed(
            data.xmat[1], data.qvel, data.subtree_com[1], data.subtree_linvel[1],
            data.xpos[rows][:2], data.xmat[rows][:2], self._jacobians,
        )  # fmt: skip

    def torques(self, qpos: Array, qvel: Array, tick: int) -> Array:
        """(n,) N·m for the state that the robot is taken to be in."""
        mujoco, model, data = self._mujoco, self._model, self._data
        data.qpos[:], data.qvel[:] = qpos, qvel
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        for foot, jacobian in zip(self._feet, self._jacobians, strict=True):
            mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], foot)
        feedback.torques(self._sensed, self._told, tick, self._law, self._torques)
        return self._torques


def _inertia(model: Any, told: Reference) -> Array:
    """(3,) kg·m² of the robot in its first pose about its centre of mass, about x, y and z."""
    mujoco = engine()
    data, full = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:] = told.qpos[0]
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, full)
    turn, arm = told.root[0], told.centre[0] - told.qpos[0, :3]
    about_root = turn @ full[3:6, 3:6] @ turn.T
    return np.diag(about_root) - model.body_mass.sum() * (arm @ arm - arm**2)


def disturbed(robot: Robot, fitted: Servos, options: Options, rng: np.random.Generator) -> Any:
    """A copy of the robot's model with servos for motors, and with whatever is wrong with it and its floor."""
    mujoco = engine()
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    model.opt.timestep = STEP
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    # MuJoCo 4.0.0 factors sparse constraint matrices wrongly (its issue 3767).
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    fitted.fitted(model)
    disturb.loaded(model, options.mass_scale, options.mass_spread, rng)
    mujoco.mj_setConst(model, mujoco.MjData(model))
    if options.friction is not None:
        disturb.slippery(model, options.friction)
    return model
