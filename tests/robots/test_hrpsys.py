"""Sequences for hrpsys' player are written and read back."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.model import robot_named
from onbeat.robots.sequences.hrpsys import read_hrpsys, write_hrpsys
from onbeat.robots.state import configurations, motion_of

ROBOT = robot_named("hrp4c")


def dance(frames: int = 90, fps: float = 60) -> Motion:
    """Turns once and a half about the vertical, waving all hinges."""
    times = np.arange(frames) / fps
    qpos = np.zeros((frames, 7 + len(ROBOT.torque)))
    qpos[:, :3] = np.column_stack((np.sin(times), times, 0.78 + 0 * times))
    qpos[:, 3:7] = rot.multiply(rot.about(np.array([0, 0, 1.0]), 2 * np.pi * times), rot.exp(np.full((frames, 3), 0.1)))
    qpos[:, 7:] = 0.3 * np.sin(times[:, None] + np.arange(len(ROBOT.torque)))
    return motion_of(ROBOT, qpos, fps)


def test_a_dance_comes_back(tmp_path: Path):
    motion = dance()
    zmp = motion.root_positions[:, :2] + 0.02
    paths = write_hrpsys(ROBOT, motion, zmp, tmp_path / "dance.pos")
    assert [path.name for path in paths] == ["dance.pos", "dance.waist", "dance.zmp"]
    for name in ("dance", "dance.zmp"):
        back = read_hrpsys(ROBOT, tmp_path / name)
        assert (back.motion.fps, len(back.motion)) == (60, 90)
        mine, other = configurations(ROBOT, motion), configurations(ROBOT, back.motion)
        np.testing.assert_allclose(other[:, [0, 1, 2, *range(7, 39)]], mine[:, [0, 1, 2, *range(7, 39)]], atol=1e-8)
        assert rot.angle_between(mine[:, 3:7], other[:, 3:7]).max() < 1e-7
        np.testing.assert_allclose(back.zmp, np.column_stack((zmp, np.zeros(90))), atol=1e-8)


def test_the_lines_are_what_the_player_takes(tmp_path: Path):
    turned = np.array([0.1, 0, 0.8, *rot.about(np.array([0, 0, 1.0]), math.pi / 2), *np.zeros(32)])
    turned[7 + 3] = 0.5
    motion = motion_of(ROBOT, np.tile(turned, (2, 1)), 100)
    pos, waist, zmp = write_hrpsys(ROBOT, motion, np.array([[0.1, 0.2]] * 2), tmp_path / "still")
    assert len(pos.read_text().splitlines()) == 2
    second = [float(word) for word in pos.read_text().splitlines()[1].split()]
    assert second == [0.01, *[0.5 if n == 3 else 0 for n in range(32)]]
    np.testing.assert_allclose(np.loadtxt(waist)[0], [0, 0.1, 0, 0.8, 0, 0, math.pi / 2], atol=1e-8)
    # 0.2 m to the left of a robot that faces left is 0.2 m before it, and the floor is 0.8 m below its waist.
    np.testing.assert_allclose(np.loadtxt(zmp)[0], [0, 0.2, 0, -0.8], atol=1e-8)


def test_angles_go_on_over_half_a_turn(tmp_path: Path):
    _, waist, _ = write_hrpsys(ROBOT, dance(), np.zeros((90, 2)), tmp_path / "turn")
    yaw = np.loadtxt(waist)[:, 6]
    assert np.abs(np.diff(yaw)).max() < 0.2
    assert yaw[-1] > 8


def test_the_same_dance_is_the_same_bytes(tmp_path: Path):
    for name in ("one", "two"):
        write_hrpsys(ROBOT, dance(), np.zeros((90, 2)), tmp_path / name)
    for suffix in (".pos", ".waist", ".zmp"):
        assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()


def test_a_zmp_for_each_frame_is_needed(tmp_path: Path):
    for zmp in (np.zeros((89, 2)), np.full((90, 2), np.nan)):
        with pytest.raises(FormatError, match=r"\(90, 2\)"):
            write_hrpsys(ROBOT, dance(), zmp, tmp_path / "no")


@pytest.mark.parametrize(
    ("suffix", "text", "told"),
    [
        (".pos", "", "has no line"),
        (".pos", "0 1 2\n", "a time and 32 numbers"),
        (".waist", "0 0 0 0 0 0 0\n", "its times are not those of the .pos"),
        (".waist", "0 0 0 0 0 0 x\n", "dance.waist:1"),
        (".zmp", "0 nan 0 0\n", "dance.zmp:1"),
        (".pos", "".join(f"{t} {' '.join(['0'] * 32)}\n" for t in (0, 0.1, 0.3)), "not those of the .pos"),
        (".zmp", None, "cannot read"),
    ],
)
def test_damaged_files_are_told(tmp_path: Path, suffix: str, text: str | None, told: str):
    write_hrpsys(ROBOT, dance(3), np.zeros((3, 2)), tmp_path / "dance")
    file = tmp_path / f"dance{suffix}"
    if text is None:
        file.unlink()
    else:
        file.write_text(text)
    with pytest.raises(FormatError) as error:
        read_hrpsys(ROBOT, tmp_path / "dance")
    assert told in str(error.value)


def test_uneven_times_are_told(tmp_path: Path):
    for suffix, columns in ((".pos", 32), (".waist", 6), (".zmp", 3)):
        rows = [f"{t} {' '.join(['0'] * columns)}\n" for t in (0, 0.1, 0.3)]
        (tmp_path / f"dance{suffix}").write_text("".join(rows))
    with pytest.raises(FormatError, match="frame 1: its time is not even"):
        read_hrpsys(ROBOT, tmp_path / "dance")
