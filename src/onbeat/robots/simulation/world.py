"""A robot on its floor in MuJoCo: motors with limits, friction, sensors, and feedback that the robot could run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import BodyError
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot
from onbeat.robots.simulation import disturb, feedback
from onbeat.robots.simulation.estimator import Estimate, Noise, Truth
from onbeat.robots.simulation.reference import SIDES, Reference
from onbeat.robots.simulation.servo import Gains, Servos, servos

Feedback = Literal["none", "truth", "estimate"]
STEP = 0.001
"""Seconds of a step of the simulation."""
STEPS = 2
"""Of it to a tick of the controller, which is at 500 Hz."""
RATE = 1 / (STEP * STEPS)
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


class World:
    """A robot on its floor, its servos and its controller; it begins in the first pose of what it is told.

    Parameters
    ----------
    robot, told, options, rng : as in :func:`onbeat.robots.simulate.simulate`.
    settling : seconds after which the clock of pushes begins.
    """

    def __init__(
        self, robot: Robot, told: Reference, options: Options, rng: np.random.Generator, settling: float = 0.0
    ) -> None:
        mujoco = engine()
        self._mujoco, self._told, self._options, self._rng = mujoco, told, options, rng
        self._balanced, self._settling = options.feedback != "none", settling
        self._servos = servos(robot, told.qpos[0], options.gains, standing=not self._balanced)
        self._model = disturbed(robot, self._servos, options, rng)
        self.data = mujoco.MjData(self._model)
        self.up = self.data.xmat[1].reshape(3, 3)[:, 2]
        self._trunk = disturb.trunk_of(robot)
        self._balance = Balance(robot, told)
        self.place(0)

    def place(self, tick: int) -> None:
        """Put the robot where it is meant to be at a tick, moving as it is meant to; its sensors begin there."""
        told, data = self._told, self.data
        self._mujoco.mj_resetData(self._model, data)
        data.qpos[:], data.qvel[:] = told.qpos[tick], told.qvel[tick]
        self._mujoco.mj_forward(self._model, data)
        late = self._options.late if self._balanced else 0
        felt = self._options.feedback == "estimate"
        begun = told if tick == 0 else Reference._make(part[tick:] for part in told)
        self._sensors = Estimate(begun, RATE, late, self._options.noise, self._rng) if felt else Truth(begun, late)
        self._sensors.told = told

    def go_on(self, told: Reference) -> None:
        """From now on ticks are those of another reference: a longer one, or one whose beginning is forgotten."""
        self._told = self._sensors.told = self._balance.told = told

    def step(self, tick: int, now: float | None = None) -> None:
        """One tick: sense, command, and let time go by; ``now`` is its second, where it is not that of its number."""
        told, data = self._told, self.data
        now = tick / RATE - self._settling if now is None else now
        if self._balanced:
            torque = self._balance.torques(*self._sensors.state(data, tick), tick)
        elif self._options.feedforward:
            torque = self._balance.torques(told.qpos[tick], told.qvel[tick], tick)
        else:
            torque = np.zeros_like(told.torque[0])
        data.ctrl[:] = self._servos.command(told.qpos[tick, 7:], told.qvel[tick, 6:], torque)
        disturb.push(data, self._trunk, self._options.pushes, now)
        self._mujoco.mj_step(self._model, data, STEPS)

    def lie(self) -> None:
        """One tick with motors that only brake."""
        data = self.data
        data.ctrl[:] = data.qpos[7:]
        self._mujoco.mj_step(self._model, data, STEPS)


class Balance:
    """The feedback, on the model that the controller has of the robot."""

    def __init__(self, robot: Robot, told: Reference) -> None:
        mujoco, model = engine(), robot.model
        self._mujoco, self._model, self.told = mujoco, model, told
        self._data = data = mujoco.MjData(model)
        self._feet = [int(model.body(robot.feet[side].link).id) for side in SIDES]
        self._law = feedback.law_of(robot, told, inertia_of(model, told))
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
        feedback.torques(self._sensed, self.told, tick, self._law, self._torques)
        return self._torques


def inertia_of(model: Any, told: Reference) -> Array:
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
