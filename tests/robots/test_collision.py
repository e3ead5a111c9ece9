"""Capsules of a robot, and how far they are apart."""

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.robots.ik.collision import capsules_of, clearances, nearest
from onbeat.robots.model import robot_named

pytest.importorskip("mujoco")


def test_nearest_points_of_segments_are_those_a_fine_search_finds():
    rng = np.random.default_rng(3)
    parts = np.linspace(0, 1, 201)
    for _ in range(50):
        one, other = rng.normal(size=(2, 2, 3))
        s, t = nearest(one, other)
        found = np.linalg.norm(one[0] + s * (one[1] - one[0]) - other[0] - t * (other[1] - other[0]))
        a = one[0] + parts[:, None] * (one[1] - one[0])
        b = other[0] + parts[:, None] * (other[1] - other[0])
        least = np.linalg.norm(a[:, None] - b[None], axis=-1).min()
        assert found <= least + 1e-12
        assert found > least - 0.05


def test_points_and_parallel_segments_have_a_distance_too():
    point = np.zeros((2, 3))
    line = np.array([[1.0, -1, 0], [1, 1, 0]])
    for one, other in ((point, line), (line, point), (line, line + np.array([0, 0, 1.0])), (point, point + 1)):
        s, t = nearest(one, other)
        assert 0 <= s <= 1
        assert 0 <= t <= 1
    assert nearest(point, line) == (0.0, 0.5)


def test_a_standing_robot_touches_nothing_and_one_with_crossed_forearms_does():
    robot = robot_named("g1")
    capsules = capsules_of(robot)
    angles = np.zeros((2, 29))
    for side, sign in (("left", -1.0), ("right", 1.0)):
        angles[1, robot.body.names.index(f"{side}_shoulder_yaw_joint")] = sign * 1.2
    motion = hinge_motion(robot.body, np.zeros((2, 3)), np.tile(rot.IDENTITY, (2, 1)), angles, 30)
    apart = clearances(motion, capsules).min(axis=1)
    assert apart[0] > 0
    assert apart[1] < 0


def test_distances_agree_with_the_engine():
    import mujoco

    from onbeat.robots.state import configurations

    robot = robot_named("g1")
    capsules, model = capsules_of(robot), robot.model
    rng = np.random.default_rng(0)
    angles = rng.uniform(robot.body.low, robot.body.high, (5, 29))
    motion = hinge_motion(robot.body, np.tile([0.0, 0, 5], (5, 1)), np.tile(rot.IDENTITY, (5, 1)), angles, 30)
    data = mujoco.MjData(model)
    for qpos, apart in zip(configurations(robot, motion), clearances(motion, capsules), strict=True):
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        deepest = min((contact.dist for contact in data.contact), default=0.0)
        assert min(apart.min(), 0.0) == pytest.approx(min(deepest, 0.0), abs=1e-4)
