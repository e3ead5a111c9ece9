"""Tracking files: both orders, told apart by kinematics; velocities that belong to the path."""

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.conventions import Convention
from onbeat.formats.notes import noted
from onbeat.formats.rates import RateWarning
from onbeat.formats.tracking import ORDERS, is_tracking, tracking_motion, write_tracking
from onbeat.motion import rotations as rot
from onbeat.motion.unitree_g1 import G1, G1_23, LINKS, g1_angles, g1_motion

ISAAC = [
    "left_hip_pitch",
    "right_hip_pitch",
    "waist_yaw",
    "left_hip_roll",
    "right_hip_roll",
    "waist_roll",
    "left_hip_yaw",
    "right_hip_yaw",
    "waist_pitch",
    "left_knee",
    "right_knee",
    "left_shoulder_pitch",
    "right_shoulder_pitch",
    "left_ankle_pitch",
    "right_ankle_pitch",
    "left_shoulder_roll",
    "right_shoulder_roll",
    "left_ankle_roll",
    "right_ankle_roll",
    "left_shoulder_yaw",
    "right_shoulder_yaw",
    "left_elbow",
    "right_elbow",
    "left_wrist_roll",
    "right_wrist_roll",
    "left_wrist_pitch",
    "right_wrist_pitch",
    "left_wrist_yaw",
    "right_wrist_yaw",
]
"""Isaac Lab's order of the G1's joints, as deployed policies list it."""


def dance(frames: int = 40, fps: float = 50.0):
    """A robot that turns by 1 rad/s while it walks along X with 0.5 m/s, and moves all its joints."""
    times = np.arange(frames) / fps
    middle, reach = (G1.low + G1.high) / 2, (G1.high - G1.low) / 6
    angles = middle + reach * np.sin(2 * times[:, None] + np.arange(29))
    path = np.column_stack((0.5 * times, 0 * times, 0 * times + 0.8))
    return g1_motion(path, rot.yaw(times), angles, fps, "dance")


def written(folder, motion, **kwargs) -> dict[str, np.ndarray]:
    write_tracking(motion, folder / "dance.tracking.npz", **kwargs)
    with np.load(folder / "dance.tracking.npz", allow_pickle=False) as file:
        return {key: file[key] for key in file.files}


def unnamed(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {key: value for key, value in arrays.items() if "names" not in key}


def test_isaac_goes_breadth_first():
    assert [G1.names[k - 1] for k in ORDERS["isaac"][1:]] == [f"{name}_joint" for name in ISAAC]
    assert [LINKS[k] for k in ORDERS["isaac"][:4]] == [
        "pelvis",
        "left_hip_pitch_link",
        "right_hip_pitch_link",
        "waist_yaw_link",
    ]
    assert [LINKS[k] for k in ORDERS["isaac"]].index("torso_link") == 9
    assert LINKS.index("torso_link") == 15


def test_the_file_has_what_loaders_take(tmp_path):
    kept = written(tmp_path, dance())
    assert is_tracking(kept)
    assert kept["fps"].tolist() == [50]
    shapes = {key: value.shape for key, value in unnamed(kept).items()}
    assert shapes == {
        "fps": (1,),
        "joint_pos": (40, 29),
        "joint_vel": (40, 29),
        "body_pos_w": (40, 30, 3),
        "body_quat_w": (40, 30, 4),
        "body_lin_vel_w": (40, 30, 3),
        "body_ang_vel_w": (40, 30, 3),
    }
    assert {value.dtype for key, value in unnamed(kept).items() if key != "fps"} == {np.dtype(np.float32)}


@pytest.mark.parametrize("order", ["mujoco", "isaac"])
def test_joints_and_bodies_stand_where_their_names_say(tmp_path, order):
    motion = dance()
    kept = written(tmp_path, motion, joint_order=order)
    joints, bodies = kept["joint_names"].tolist(), kept["body_names"].tolist()
    elbow, hand = joints.index("left_elbow_joint"), bodies.index("left_elbow_link")
    place = motion.skeleton.index("left_elbow_joint")
    assert kept["joint_pos"][:, elbow] == pytest.approx(g1_angles(motion, "")[:, place - 1], abs=1e-6)
    np.testing.assert_allclose(kept["body_pos_w"][:, hand], motion.positions[:, place], atol=1e-6)


def test_links_are_turned_as_the_robots_model_has_them(tmp_path):
    zero = g1_motion(np.zeros((2, 3)), np.tile(rot.IDENTITY, (2, 1)), np.zeros((2, 29)), 50)
    kept = written(tmp_path, zero)
    bodies = kept["body_names"].tolist()
    for link, q in (
        ("left_hip_roll_link", [0.996179, 0, -0.0873386, 0]),
        ("left_knee_link", [1, 0, 0, 0]),
        ("right_shoulder_pitch_link", [0.990264, -0.139201, 0, 0.0001]),
    ):
        np.testing.assert_allclose(kept["body_quat_w"][0, bodies.index(link)], q, atol=2e-5)


def test_velocities_are_the_derivatives_of_the_path(tmp_path):
    motion = dance()
    kept = written(tmp_path, motion)
    np.testing.assert_allclose(kept["body_lin_vel_w"][:, 0], np.tile([0.5, 0, 0], (40, 1)), atol=1e-6)
    np.testing.assert_allclose(kept["body_ang_vel_w"][:, 0], np.tile([0, 0, 1], (40, 1)), atol=1e-6)
    knee, moved = LINKS.index("left_knee_link"), g1_angles(motion, "")
    expected = 2 * (G1.high - G1.low)[3] / 6 * np.cos(2 * motion.times + 3)
    np.testing.assert_allclose(kept["joint_vel"][1:-1, 3], expected[1:-1], atol=1e-3)
    steps = np.diff(kept["body_pos_w"][:, knee].astype(float), axis=0) * 50
    np.testing.assert_allclose(kept["body_lin_vel_w"][1:-1, knee], (steps[1:] + steps[:-1]) / 2, atol=1e-4)
    assert np.abs(moved).max() < 3


def test_the_angular_velocity_is_in_the_world(tmp_path):
    lying = rot.about(np.array([1.0, 0, 0]), np.pi / 2)
    turns = rot.multiply(rot.yaw(np.arange(9) / 50), lying)
    kept = written(tmp_path, g1_motion(np.zeros((9, 3)), turns, np.zeros((9, 29)), 50))
    np.testing.assert_allclose(kept["body_ang_vel_w"][:, 5], np.tile([0, 0, 1], (9, 1)), atol=1e-5)


@pytest.mark.parametrize("order", ["mujoco", "isaac"])
@pytest.mark.parametrize("names", [True, False])
def test_either_order_is_read_with_names_and_without(tmp_path, order, names):
    motion = dance()
    kept = written(tmp_path, motion, joint_order=order)
    with noted() as notes:
        again = tracking_motion(kept if names else unnamed(kept), "dance.tracking.npz")
    assert [(note.about, note.taken) for note in notes] == [("joints", "by name" if names else order)]
    np.testing.assert_allclose(again.positions, motion.positions, atol=3e-6)
    assert (again.name, again.fps) == ("dance", 50)


def test_some_bodies_in_any_order_tell_the_order_of_the_joints(tmp_path):
    motion = dance()
    kept = unnamed(written(tmp_path, motion, joint_order="isaac"))
    for key in ("body_pos_w", "body_quat_w"):
        kept[key] = kept[key][:, [0, 20, 8, 13, 2]]
    np.testing.assert_allclose(tracking_motion(kept, "a").positions, motion.positions, atol=3e-6)


def test_names_may_be_in_any_order_and_of_the_robot_with_23_joints(tmp_path):
    motion = dance()
    kept = written(tmp_path, motion)
    pick = [G1.names.index(name) for name in reversed(G1_23)]
    kept["joint_pos"], kept["joint_names"] = kept["joint_pos"][:, pick], np.array(G1.names)[pick]
    again = g1_angles(tracking_motion(kept, "a"), "")
    np.testing.assert_allclose(again[:, pick], g1_angles(motion, "")[:, pick], atol=1e-6)
    assert not again[:, G1.names.index("waist_pitch_joint")].any()


@pytest.mark.parametrize("fps", [np.array([60]), np.array(60.0), 60, np.array([[60.0]], np.float32)])
def test_the_rate_may_be_a_number_or_an_array_of_one(tmp_path, fps):
    assert tracking_motion(written(tmp_path, dance()) | {"fps": fps}, "a").fps == 60


def test_fifty_frames_a_second_are_assumed_with_a_warning(tmp_path):
    kept = written(tmp_path, dance())
    del kept["fps"]
    with pytest.warns(RateWarning, match="50 frames a second"):
        assert tracking_motion(kept, "a").fps == 50
    assert tracking_motion(kept, "a", 25).fps == 25


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("joint_pos", None, "no joint_pos found; an array of shape (40, …)"),
        ("joint_pos", np.zeros((39, 29)), "joint_pos has the shape (39, 29)"),
        ("joint_pos", np.zeros((40, 29, 1)), "joint_pos has the shape (40, 29, 1)"),
        ("joint_pos", np.zeros((40, 29), complex), "joint_pos holds no numbers"),
        ("joint_pos", np.full((40, 29), "a"), "joint_pos holds no numbers"),
        ("joint_pos", np.zeros((40, 12)), "12 joints found; the Unitree G1 has 29"),
        ("joint_pos", np.zeros((40, 29)), "is it another robot than the Unitree G1"),
        ("joint_pos", np.full((40, 29), np.nan), "frame 0 of joint_pos is not a number"),
        ("body_pos_w", np.zeros((0, 30, 3)), "body_pos_w has no frames"),
        ("body_pos_w", np.zeros((40, 0, 3)), "body_quat_w has the shape (40, 30, 4)"),
        ("body_pos_w", np.zeros((40, 90)), "body_pos_w has the shape (40, 90); (frames, …, 3) is expected"),
        ("body_quat_w", np.zeros((40, 30, 4)), "frame 0 has a root quaternion of length 0"),
        ("fps", np.array([0]), "fps is [0]; a number from 0.1 to 10000"),
        ("fps", np.array([30, 30]), "fps is [30 30]"),
        ("fps", np.array("fast"), "fps is fast"),
        ("joint_names", np.array(["a"] * 29), "joint_names lacks left_hip_pitch_joint"),
        ("joint_names", np.array(["a"] * 7), "joint_names has the shape (7,); 29 names are expected"),
    ],
)
def test_what_is_wrong_is_told(tmp_path, key, value, message):
    kept = unnamed(written(tmp_path, dance()))
    kept = {k: v for k, v in kept.items() if k != key} if value is None else kept | {key: value}
    with pytest.raises(FormatError) as refused:
        tracking_motion(kept, "dance.npz")
    assert "dance.npz: " in str(refused.value)
    assert message in str(refused.value)


def test_a_body_for_each_of_a_million_is_refused():
    many = {
        "body_pos_w": np.zeros((1, 10**6, 3)),
        "body_quat_w": np.zeros((1, 10**6, 4)),
        "joint_pos": np.zeros((1, 29)),
    }
    with pytest.raises(FormatError, match="holds 1000000 bodies"):
        tracking_motion(many | {"fps": 50}, "a")


def test_what_cannot_be_written_is_refused(tmp_path, swinger):
    with pytest.raises(FormatError, match="Retarget it"):
        write_tracking(swinger, tmp_path / "a.npz")
    with pytest.raises(FormatError, match="metres with Z up"):
        write_tracking(dance(), tmp_path / "a.npz", Convention("y", "cm"))
    with pytest.raises(FormatError, match="mujoco or isaac is expected"):
        write_tracking(dance(), tmp_path / "a.npz", joint_order="alphabet")


def test_a_single_frame_stands_still(tmp_path):
    kept = written(tmp_path, dance(1))
    assert not kept["joint_vel"].any()
    assert np.abs(kept["body_ang_vel_w"]).max() < 1e-9
    assert len(tracking_motion(kept, "a")) == 1


def test_the_same_motion_makes_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        write_tracking(dance(), tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
