"""Dances as ROS 2 bags, written and read back."""

from __future__ import annotations

import builtins
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError, MissingExtraError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.model import robot_named
from onbeat.robots.sequences.mcap import JOINTS, read_mcap, write_mcap
from onbeat.robots.state import configurations, derivatives, motion_of

G1 = robot_named("g1")


def dance(frames: int = 80, fps: float = 50) -> Motion:
    times = np.arange(frames) / fps
    qpos = np.zeros((frames, 36))
    qpos[:, :3] = np.column_stack((np.sin(times), times, 0.78 + 0 * times))
    qpos[:, 3:7] = rot.about(np.array([0, 0, 1.0]), 2 * np.pi * times)
    qpos[:, 7:] = 0.1 * np.sin(times[:, None] + np.arange(29))
    return motion_of(G1, qpos, fps)


def test_a_dance_comes_back(tmp_path: Path):
    motion = dance()
    write_mcap(G1, motion, tmp_path / "dance.mcap")
    back = read_mcap(G1, tmp_path / "dance.mcap")
    assert (back.fps, back.name) == (50, "dance")
    np.testing.assert_allclose(configurations(G1, back), configurations(G1, motion), atol=1e-12)


def test_another_program_finds_joints_velocities_and_times(tmp_path: Path):
    from rosbags.rosbag2 import Reader
    from rosbags.typesys import Stores, get_typestore

    motion, types = dance(), get_typestore(Stores.ROS2_JAZZY)
    write_mcap(G1, motion, tmp_path / "dance.mcap")
    with Reader(tmp_path / "dance.mcap") as reader:
        [(kind, data)] = [(c.msgtype, data) for c, _, data in reader.messages() if c.topic == JOINTS]
        message = types.deserialize_cdr(data, kind)
    assert kind == "trajectory_msgs/msg/JointTrajectory"
    assert message.joint_names == list(G1.body.names)
    assert (message.points[51].time_from_start.sec, message.points[51].time_from_start.nanosec) == (1, 20_000_000)
    qvel, qacc = derivatives(G1, configurations(G1, motion), motion.fps)
    np.testing.assert_allclose([point.velocities for point in message.points], qvel[:, 6:], atol=1e-12)
    np.testing.assert_allclose([point.accelerations for point in message.points], qacc[:, 6:], atol=1e-12)


def test_the_same_dance_is_the_same_bytes(tmp_path: Path):
    for name in ("one.mcap", "two.mcap"):
        write_mcap(G1, dance(), tmp_path / name)
    assert (tmp_path / "one.mcap").read_bytes() == (tmp_path / "two.mcap").read_bytes()


def test_another_robots_bag_is_told(tmp_path: Path):
    write_mcap(G1, dance(4), tmp_path / "dance.mcap")
    with pytest.raises(FormatError, match="no joint L_HIP_Y"):
        read_mcap(robot_named("hrp4c"), tmp_path / "dance.mcap")


@pytest.mark.parametrize("keep", [0, 8, 60, 2000, -1])
def test_a_damaged_bag_is_told(tmp_path: Path, keep: int):
    write_mcap(G1, dance(), tmp_path / "dance.mcap")
    data = (tmp_path / "dance.mcap").read_bytes()
    (tmp_path / "dance.mcap").write_bytes(data[:keep])
    with pytest.raises(FormatError, match=r"dance\.mcap"):
        read_mcap(G1, tmp_path / "dance.mcap")


def test_a_missing_bag_is_told(tmp_path: Path):
    with pytest.raises(FormatError, match="cannot read"):
        read_mcap(G1, tmp_path / "none.mcap")


def test_without_the_extra_a_line_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    real = builtins.__import__

    def without(name: str, *args: object, **others: object) -> object:
        if name.startswith("rosbags"):
            raise ImportError(name)
        return real(name, *args, **others)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=r'pip install "onbeat\[ros\]"'):
        write_mcap(G1, dance(4), tmp_path / "dance.mcap")
    assert not list(tmp_path.iterdir())
