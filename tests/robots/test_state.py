"""Configurations of a robot and their derivatives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.formats.read import read_motion
from onbeat.motion import rotations as rot
from onbeat.robots.engine import engine
from onbeat.robots.model import robot_named
from onbeat.robots.state import configurations, derivatives, motion_of

G1 = robot_named("g1")


def path(times: np.ndarray, robot=G1) -> np.ndarray:
    """A smooth path that turns about all axes; the root turns through the half turn where quaternions change sign."""
    rng = np.random.default_rng(3)
    rates, phases = rng.uniform(1, 6, 40), rng.uniform(0, 6, 40)
    waves = np.sin(times[:, None] * rates + phases)
    q = rot.multiply(rot.about(np.array([0, 0, 1.0]), 3 * times), rot.exp(0.5 * waves[:, :3]))
    middle, half = (robot.body.low + robot.body.high) / 2, (robot.body.high - robot.body.low) / 2
    angles = middle + 0.9 * half * waves[:, 6 : 6 + len(half)]
    return np.hstack((waves[:, 3:6], q, angles))


@pytest.mark.parametrize("name", ["g1", "hrp4c", "talos"])
def test_configurations_are_a_motion_and_back(name: str):
    robot = robot_named(name)
    rng = np.random.default_rng(0)
    qpos = np.hstack((rng.normal(size=(50, 7)), rng.uniform(robot.body.low, robot.body.high, (50, len(robot.torque)))))
    qpos[:, 3:7] = rot.normalise(qpos[:, 3:7])
    motion = motion_of(robot, qpos, 50, "wild")
    assert (motion.fps, motion.name, len(motion)) == (50, "wild", 50)
    np.testing.assert_allclose(configurations(robot, motion), qpos, atol=1e-12)


def test_the_motion_has_its_joints_where_the_engine_has_them():
    qpos = path(np.arange(20) / 10)
    motion, data = motion_of(G1, qpos, 10), engine().MjData(G1.model)
    for frame, row in enumerate(qpos):
        data.qpos[:] = row
        engine().mj_kinematics(G1.model, data)
        np.testing.assert_allclose(motion.positions[frame, G1.body.joints], data.xanchor[1:], atol=1e-9)


def test_velocities_take_one_configuration_to_the_next():
    fps, step = 120.0, 1e-5
    times = np.arange(121) / fps
    qvel, qacc = derivatives(G1, path(times), fps)
    for frame in (20, 60, 100):
        before, here, after = path(times[frame] + step * np.arange(-1, 2))
        velocities = np.zeros((2, G1.model.nv))
        engine().mj_differentiatePos(G1.model, velocities[0], step, before, here)
        engine().mj_differentiatePos(G1.model, velocities[1], step, here, after)
        np.testing.assert_allclose(qvel[frame], velocities.mean(axis=0), atol=1e-4)
        np.testing.assert_allclose(qacc[frame], np.diff(velocities, axis=0)[0] / step, atol=2e-2)


def test_derivatives_hardly_depend_on_the_rate():
    slow = derivatives(G1, path(np.arange(61) / 30), 30)
    fast = derivatives(G1, path(np.arange(241) / 120), 120)
    np.testing.assert_allclose(slow.qvel[5:-5], fast.qvel[::4][5:-5], atol=0.01)
    np.testing.assert_allclose(slow.qacc[5:-5], fast.qacc[::4][5:-5], atol=0.5)
    assert np.abs(fast.qacc).max() > 50


def test_a_change_of_a_quaternions_sign_is_no_movement():
    qpos = path(np.arange(30) / 60)
    flipped = qpos.copy()
    flipped[11:23, 3:7] *= -1
    np.testing.assert_allclose(derivatives(G1, flipped, 60).qacc, derivatives(G1, qpos, 60).qacc, atol=1e-6)


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 5, 6, 7])
def test_few_frames_that_stand_still_are_at_rest(frames: int):
    qvel, qacc = derivatives(G1, np.repeat(path(np.zeros(1)), frames, axis=0), 30)
    assert qvel.shape == qacc.shape == (frames, 35)
    np.testing.assert_allclose(np.concatenate((qvel, qacc)), 0, atol=1e-9)


def test_a_root_below_another_joint_is_read_where_it_is():
    qpos = path(np.arange(10) / 10)
    motion = motion_of(G1, qpos, 10)
    skeleton = motion.skeleton
    names, parents = ("world", *skeleton.names), [-1, *(skeleton.parents + 1)]
    offsets = np.vstack((np.zeros((1, 3)), skeleton.offsets))
    hung = type(skeleton)(names, parents, offsets, [False, *skeleton.end_sites])
    rotations = np.concatenate((np.tile(rot.IDENTITY, (10, 1, 1)), motion.rotations), axis=1)
    found = configurations(G1, type(motion)(hung, rotations, motion.root_positions, 10))
    np.testing.assert_allclose(found, qpos, atol=1e-12)


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda q: q[:, :-1], "(frames, 36) is expected"),
        (lambda q: q[:0], "(0, 36)"),
        (lambda q: np.where(np.arange(len(q))[:, None] == 3, np.nan, q), "frame 3"),
        (lambda q: q * (np.arange(36) > 6), "turned in no way"),
    ],
)
def test_what_is_no_configuration_is_told(spoil, told: str):
    qpos = spoil(path(np.arange(8) / 10))
    for function in (motion_of, derivatives):
        with pytest.raises(BodyError) as error:
            function(G1, qpos, 30)
        assert told in str(error.value)
    with pytest.raises(BodyError, match="rate above zero"):
        derivatives(G1, path(np.zeros(2)), 0.0)


def test_a_real_dance_comes_back_as_it_was(data: Path):
    file = next((data / "g1_moves").rglob("*.csv"))
    motion = read_motion(file, fps=60)
    qpos = configurations(G1, motion)
    back = configurations(G1, motion_of(G1, qpos, motion.fps))
    np.testing.assert_allclose(back, qpos, atol=1e-12)
