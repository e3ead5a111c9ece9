"""The zero-moment point by inverse dynamics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.robots.state import configurations, derivatives
from onbeat.robots.zmp import GRAVITY, centres_of_mass, floor_wrench, zmp
from robot_dances import made_dance

ROBOT, DANCE = made_dance()
QPOS = configurations(ROBOT, DANCE)
RATES = derivatives(ROBOT, QPOS, 60)


def test_at_rest_it_is_below_the_centre_of_mass():
    still = np.zeros((len(QPOS), ROBOT.model.nv))
    np.testing.assert_allclose(zmp(ROBOT, QPOS, still, still), centres_of_mass(ROBOT, QPOS)[:, :2], atol=1e-9)


def test_the_wrench_is_what_mujoco_s_inverse_dynamics_find_for_the_root():
    model = mujoco.MjModel.from_xml_string(ROBOT.mjcf)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data = mujoco.MjData(model)
    force, _ = floor_wrench(ROBOT, QPOS, *RATES)
    for frame in (0, 99, 250):
        data.qpos[:], data.qvel[:], data.qacc[:] = QPOS[frame], RATES.qvel[frame], RATES.qacc[frame]
        mujoco.mj_inverse(model, data)
        np.testing.assert_allclose(force[frame], data.qfrc_inverse[:3], atol=1e-8)


def test_it_is_what_linear_and_angular_momentum_say():
    """x = Σ m ((z̈ + g) x − z ẍ − angular) / Σ m (z̈ + g), by finite differences over the bodies."""
    fps, model = 60, ROBOT.model
    data, momenta = mujoco.MjData(model), []
    for q, v in zip(QPOS, RATES.qvel, strict=True):
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        momenta.append((*(model.body_subtreemass[1] * data.subtree_linvel[1]), *data.subtree_angmom[1]))
    rate = np.gradient(np.array(momenta), 1 / fps, axis=0)
    com, up = centres_of_mass(ROBOT, QPOS), rate[:, 2] + ROBOT.mass * GRAVITY
    x = com[:, 0] - (com[:, 2] * rate[:, 0] + rate[:, 4]) / up
    y = com[:, 1] - (com[:, 2] * rate[:, 1] - rate[:, 3]) / up
    away = np.abs(zmp(ROBOT, QPOS, *RATES) - np.stack((x, y), axis=1))[5:-5]
    assert away.max() < 0.02
    assert np.median(away) < 2e-3


def test_falling_freely_it_is_no_surprise():
    qacc = np.zeros((1, ROBOT.model.nv))
    qacc[:, 2] = -GRAVITY
    assert np.isfinite(zmp(ROBOT, QPOS[:1], 0 * qacc, qacc)).all()


def test_other_shapes_are_told():
    with pytest.raises(BodyError, match="shapes"):
        zmp(ROBOT, QPOS, RATES.qvel[:-1], RATES.qacc)
