"""Position servos as a robot's motor drivers run them: stiffness, damping and a torque on top, within the torque limit.

    τ = clip(kp (q* − q) + kd (q̇* − q̇) + τ*, ±τ_max)

with ``kp = I ω²`` and ``kd = 2 ζ I ω`` from a natural frequency ω and a damping ratio ζ, and I the inertia that the
motor sees: its rotor's, geared, and the limb's. A hinge of a leg that carries the robot sees half of the robot above
it as well. The drivers sit in the joints: no delay is between them and what they measure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.errors import BodyError
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot


@dataclass(frozen=True)
class Gains:
    """How stiff the servos are.

    Parameters
    ----------
    hz : natural frequency of a hinge that moves a limb.
    ratio : damping ratio.
    standing_hz : natural frequency of the whole robot on the legs' servos, where nothing else balances it.
    """

    hz: float = 4.0
    ratio: float = 1.0
    standing_hz: float = 2.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not (np.isfinite(value) and 0 < value <= 100):
                raise BodyError(f"servos with {name} = {value:g} cannot be; a number above 0 and up to 100 is expected")


@dataclass(frozen=True, eq=False)
class Servos:
    """Stiffness (n,) in N·m/rad and damping (n,) in N·m·s/rad of each hinge's servo."""

    stiffness: Array
    damping: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffness", frozen(self.stiffness))
        object.__setattr__(self, "damping", frozen(self.damping))

    def fitted(self, model: Any) -> None:
        """Make the motors of a model these servos; the damping is then part of MuJoCo's implicit step."""
        mujoco = engine()
        model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
        model.actuator_gainprm[:, 0] = self.stiffness
        model.actuator_biasprm[:, 1] = -self.stiffness
        model.actuator_biasprm[:, 2] = -self.damping
        model.actuator_ctrllimited[:] = 0

    def command(self, angles: Array, speeds: Array, torques: Array) -> Array:
        """The one number (n,) for each servo that asks for an angle, a speed and a torque on top."""
        return angles + (self.damping * speeds + torques) / self.stiffness


def servos(robot: Robot, qpos: Array, gains: Gains, standing: bool) -> Servos:
    """The servos of a robot; for a configuration (7 + n,) about which it moves.

    Parameters
    ----------
    robot : n hinges.
    qpos : a pose of the dance.
    gains : how stiff.
    standing : whether the legs' servos carry the robot by themselves.
    """
    mujoco, model = engine(), robot.model
    data, inertia = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, inertia)
    moved, omega = np.diag(inertia)[6:], 2 * np.pi * gains.hz
    stiffness, damping = moved * omega**2, 2 * gains.ratio * moved * omega
    if standing:
        omega = 2 * np.pi * gains.standing_hz
        carried = _carried(robot, data)
        stiffness = np.maximum(stiffness, carried * omega**2)
        damping = np.maximum(damping, 2 * gains.ratio * carried * omega)
    return Servos(stiffness, damping)


def _carried(robot: Robot, data: Any) -> Array:
    """(n,) kg·m² of half the robot about each hinge of its legs, as a point at its centre; zero for the others."""
    model = robot.model
    out = np.zeros(model.nu)
    for foot in robot.feet.values():
        link = model.body(foot.link).id
        while model.body_jntnum[link] == 1 and model.body_parentid[link] > 0:
            joint = int(model.body_jntadr[link])
            arm = data.subtree_com[1] - data.xanchor[joint]
            across = np.linalg.norm(np.cross(data.xaxis[joint], arm))
            out[joint - 1] = robot.mass / 2 * across**2
            link = int(model.body_parentid[link])
    return out
