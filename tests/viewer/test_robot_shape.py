"""Robots are drawn by their own capsules, each part in its colour, hung on the joints that carry them."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.robots.ik.collision import capsules_of
from onbeat.robots.model import Robot, robot_named
from onbeat.viewer.robot_shape import ROBOT, robot_shape

pytest.importorskip("mujoco")


def still(robot: Robot) -> Motion:
    angles = np.zeros((2, len(robot.body.names)))
    return hinge_motion(robot.body, np.zeros((2, 3)), np.tile(rot.IDENTITY, (2, 1)), angles, 30.0)


def test_parts_have_their_colours():
    g1 = robot_named("g1")
    _, shape = robot_shape(still(g1), g1)
    by_joint = dict[str, set[str]]()
    for joint, capsule in zip(capsules_of(g1).joints.tolist(), shape, strict=True):
        by_joint.setdefault(g1.body.skeleton.names[joint], set()).add(capsule.group)
    assert by_joint["pelvis"] == {"hips"}
    assert by_joint["left_hip_pitch_joint"] == by_joint["left_knee_joint"] == {"left_leg"}
    assert by_joint["right_ankle_roll_joint"] == {"right_foot"}
    assert by_joint["right_shoulder_pitch_joint"] == by_joint["right_elbow_joint"] == {"right_arm"}
    assert by_joint["left_wrist_yaw_joint"] == {"left_hand"}
    assert by_joint["waist_pitch_joint"] == {"torso", "head"}


@pytest.mark.parametrize("name", ["g1", "hrp4c", "talos"])
def test_a_robot_has_all_its_parts_and_moves_as_before(name: str):
    robot = robot_named(name)
    dressed, shape = robot_shape(still(robot), robot)
    assert {one.group for one in shape} == set(ROBOT)
    assert (dressed.positions[:, : len(robot.body.skeleton)] == still(robot).positions).all()


@pytest.mark.parametrize("name", ["g1", "hrp4c", "talos"])
def test_what_is_round_has_a_direction_too(name: str):
    robot = robot_named(name)
    dressed, shape = robot_shape(still(robot), robot)
    ends = dressed.positions[0, [(one.joint_a, one.joint_b) for one in shape]]
    assert (np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1) > 5e-6).all()


def test_animated_offsets_are_kept():
    g1 = robot_named("g1")
    plain = still(g1)
    offsets = np.tile(g1.body.skeleton.offsets, (2, 1, 1))
    offsets[1, g1.body.skeleton.index("left_elbow_joint"), 2] -= 0.05
    moved = Motion(plain.skeleton, plain.rotations, plain.root_positions, 30.0, translations=offsets)
    dressed, _ = robot_shape(moved, g1)
    assert (dressed.positions[:, : len(plain.skeleton)] == moved.positions).all()
