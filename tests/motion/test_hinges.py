"""Robots as skeletons: frames turned to be the root's, angles in and out, limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from onbeat.errors import BodyError
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import End, Hinge, HingeBody, hinge_angles, hinge_motion, hinge_speeds, limit_violations

TILTS = (0.3, -0.5, 0.7), (-0.2, 0.4, 0.1)
ARM = HingeBody.of(
    "a robot's arm",
    "base",
    [
        Hinge("shoulder", "base", (0.1, 0.2, 0.3), TILTS[0], (0, 1, 0), -1, 2, 3),
        Hinge("elbow", "shoulder", (0, 0.4, 0.1), TILTS[1], (0, 0, 2), 1, 4, 5),
    ],
    [End("hand", "elbow", (0.2, 0, 0.1))],
)


def still(angles) -> Motion:
    angles = np.atleast_2d(np.asarray(angles, float))
    return hinge_motion(ARM, np.zeros((len(angles), 3)), np.tile(rot.IDENTITY, (len(angles), 1)), angles, 30)


def turned(motion: Motion, joint: int, q) -> Motion:
    rotations = np.array(motion.rotations)
    rotations[-1, joint] = rot.multiply(rotations[-1, joint], q)
    return motion.replace(rotations=rotations)


def test_the_hand_is_where_the_tilted_frames_of_the_model_have_it():
    a, b = 0.6, 1.4
    shoulder = Rotation.from_euler("xyz", TILTS[0]) * Rotation.from_rotvec([0, a, 0])
    elbow = Rotation.from_euler("xyz", TILTS[1]) * Rotation.from_rotvec([0, 0, b])
    forearm = elbow.apply([0.2, 0, 0.1])
    hand = np.array([0.1, 0.2, 0.3]) + shoulder.apply(np.array([0, 0.4, 0.1]) + forearm)
    motion = still([a, b])
    assert motion.positions[0, 3] == pytest.approx(hand, abs=1e-12)
    link = rot.multiply(motion.world_rotations[0, 2], ARM.links[1])
    assert rot.angle_between(link, (shoulder * elbow).as_quat(scalar_first=True)) < 1e-7


def test_the_zero_configuration_is_the_rest_pose():
    motion = still([0, 0])
    assert motion.positions[0] == pytest.approx(ARM.skeleton.rest_positions)
    assert motion.rotations[0].tolist() == [rot.IDENTITY.tolist()] * 4
    assert ARM.skeleton.end_sites.tolist() == [False, False, False, True]


def test_axes_are_of_unit_length_and_cannot_be_changed():
    assert np.linalg.norm(ARM.axes, axis=1) == pytest.approx(1, abs=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        ARM.axes[0, 0] = 2


@pytest.mark.parametrize("elbow", [-0.6, 1.0, 2.5, 3.5, 5.6])
def test_angles_come_back_on_the_side_of_their_limits(elbow):
    assert hinge_angles(ARM, still([0.4, elbow]))[0] == pytest.approx([0.4, elbow], abs=1e-12)


def test_the_other_sign_of_a_quaternion_is_the_same_angle():
    motion = still([0.4, 2.0])
    assert hinge_angles(ARM, motion.replace(rotations=-motion.rotations))[0] == pytest.approx([0.4, 2.0])


def test_a_rotation_out_of_the_hinge_is_refused_with_frame_and_joint():
    across = rot.about(np.array([1.0, 0, 0]), np.radians(40))
    with pytest.raises(BodyError, match=r"frame 2: elbow is turned 3\d\.\d° out of its hinge"):
        hinge_angles(ARM, turned(still([[0, 2], [0, 2], [0, 2]]), 2, across))


def test_a_rotation_out_of_the_hinge_by_less_than_half_a_degree_is_let_pass():
    motion = turned(still([0.2, 2]), 2, rot.about(np.array([1.0, 0, 0]), np.radians(0.3)))
    assert hinge_angles(ARM, motion)[0] == pytest.approx([0.2, 2], abs=0.01)


@pytest.mark.parametrize(
    ("names", "parents", "raised", "message"),
    [
        (("base", "shoulder", "knee"), [-1, 0, 1], 0, "it has no joint elbow"),
        (("base", "shoulder", "elbow"), [-1, 0, 0], 0, "elbow is not below shoulder"),
        (("base", "shoulder", "elbow"), [-1, 0, 1], 0.02, "elbow is 20.0 mm from its place"),
    ],
)
def test_another_skeleton_is_refused_for_what_differs(names, parents, raised, message):
    offsets = ARM.skeleton.offsets[:3] + np.array([[0, 0, 0], [0, 0, 0], [0, 0, raised]])
    motion = Motion(Skeleton(names, parents, offsets), np.tile(rot.IDENTITY, (1, 3, 1)), np.zeros((1, 3)), 30)
    with pytest.raises(BodyError, match=message):
        hinge_angles(ARM, motion)


def test_joints_may_be_in_another_order_and_without_ends():
    s = ARM.skeleton
    other = Skeleton(("base", "spare", "shoulder", "elbow"), [-1, 0, 0, 2], s.offsets[[0, 1, 1, 2]])
    rotations = still([0.5, 2.5]).rotations[:, [0, 0, 1, 2]]
    assert hinge_angles(ARM, Motion(other, rotations, np.zeros((1, 3)), 30))[0] == pytest.approx([0.5, 2.5])


def test_bones_that_stretch_are_refused():
    motion = still([[0, 2], [0, 2]])
    lengths = np.tile(ARM.skeleton.offsets, (2, 1, 1))
    assert hinge_angles(ARM, replace(motion, translations=lengths))[1] == pytest.approx([0, 2])
    lengths[1, 1] += 0.01
    with pytest.raises(BodyError, match=r"frame 1: shoulder is moved by 17\.3 mm"):
        hinge_angles(ARM, replace(motion, translations=lengths))


def test_speeds_are_of_central_differences():
    times = np.arange(100) / 50
    angles = np.column_stack((np.sin(2 * times), times))
    assert hinge_speeds(angles, 50)[1:-1, 0] == pytest.approx(2 * np.cos(2 * times[1:-1]), abs=0.002)
    assert hinge_speeds(angles, 50)[:, 1] == pytest.approx(1)
    assert hinge_speeds(angles[:1], 50).tolist() == [[0, 0]]


def test_the_share_of_frames_past_the_limits_is_told_for_each_hinge():
    angles = np.tile([0.0, 2.0], (10, 1))
    angles[:3, 0] = -1.1
    angles[5:, 1] = 3.0
    report = limit_violations(ARM, angles, fps=10)
    assert report.names == ("shoulder", "elbow")
    assert report.angle.tolist() == [0.3, 0]
    assert report.speed.tolist() == [0.2, 0]
    assert limit_violations(ARM, angles, fps=11).speed.tolist() == [0.2, 0.2]
