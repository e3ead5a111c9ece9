"""Damaged descriptions of robots are told as such: no other error, no warning of numpy, no endless reading."""

from __future__ import annotations

import random
import re
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.robots.description.toml import description_of
from onbeat.robots.description.urdf import read_urdf
from onbeat.robots.model import robot_named
from onbeat.robots.sequences.hrpsys import read_hrpsys, write_hrpsys
from onbeat.robots.sequences.mcap import read_mcap, write_mcap
from onbeat.robots.state import motion_of

INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
LINK = f'<inertial><origin xyz="0 0 -0.1"/><mass value="1"/>{INERTIA}</inertial>'
FOOT = '<collision><geometry><box size="0.2 0.1 0.04"/></geometry></collision>'
LEG = (
    f'<link name="S_foot">{LINK}{FOOT}</link><joint name="S_ankle" type="revolute"><parent link="pelvis"/>'
    '<child link="S_foot"/><origin xyz="0 0.1 -0.5" rpy="0 0 0.1"/><axis xyz="0 1 0"/>'
    '<limit lower="-1" upper="1" velocity="5" effort="50"/></joint>'
)
LEGS = "".join(LEG.replace("S_", f"{side}_") for side in ("left", "right"))
URDF = f'<robot name="r"><link name="pelvis">{LINK}</link>{LEGS}</robot>'
TOML = """version = 1
name = "r"
[root]
link = "pelvis"
mass = 1
centre = [0, 0, 0]
inertia = [1, 1, 1, 0, 0, 0]
capsules = [[0, 0, 0, 0, 0, 1, 0.1]]
[links.foot]
parent = "pelvis"
joint = "ankle"
origin = [0, 0, -0.5]
axis = [0, 1, 0]
position = [-1, 1]
speed = 5
torque = 50
mass = 1
centre = [0, 0, 0]
inertia = [1, 1, 1, 0, 0, 0]
[feet]
left = { link = "foot", corners = [[1, 1, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0]] }
right = { link = "foot", corners = [[1, 1, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0]] }
"""
WORDS = ("nan", "inf", "-1", "0", "1e308", "1e-320", "", "x", "ä", "\0", "true", "[]", "{}", '"', "<")
WORDS += ("pelvis", "left_foot", "left_ankle", "foot")


def damaged(text: str, seed: int) -> str:
    """A text of which a word is another one, is twice, or is missing, or which ends early."""
    luck = random.Random(seed)
    for _ in range(luck.randint(1, 3)):
        words = list(re.finditer(r"[\w.\-]+", text))
        if not words:
            break
        word = luck.choice(words)
        new = luck.choice((luck.choice(WORDS), word[0] * 2, luck.choice(words)[0], str(luck.uniform(-9, 9))))
        text = text[: word.start()] + new + text[word.end() :]
        if luck.random() < 0.05:
            text = text[: luck.randrange(len(text) + 1)]
    return text


def told(read: Callable[[], object]) -> str:
    """What is told where it cannot be read, else nothing; what is assumed is passed over, other warnings are errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", r".*r\.urdf", UserWarning)
        try:
            read()
        except OnbeatError as error:
            return str(error)
        return ""


@pytest.mark.parametrize("seed", range(250))
def test_a_damaged_urdf(tmp_path: Path, seed: int):
    (tmp_path / "r.urdf").write_text(damaged(URDF, seed), encoding="utf-8")
    message = told(lambda: read_urdf(tmp_path / "r.urdf"))
    assert not message or "r.urdf" in message


@pytest.mark.parametrize("seed", range(250))
def test_a_damaged_description(seed: int):
    message = told(lambda: description_of(damaged(TOML, seed), "r.toml"))
    assert not message or "r.toml" in message


@pytest.mark.parametrize("seed", range(60))
def test_damaged_sequences(tmp_path: Path, seed: int):
    robot = robot_named("g1")
    qpos = np.tile(np.r_[0, 0, 0.8, 1, np.zeros(32)], (4, 1))
    paths = write_hrpsys(robot, motion_of(robot, qpos, 50), np.zeros((4, 2)), tmp_path / "r")
    file = paths[seed % 3]
    file.write_text(damaged(file.read_text(), seed), encoding="utf-8")
    message = told(lambda: read_hrpsys(robot, tmp_path / "r"))
    assert not message or "r." in message


@pytest.mark.parametrize("seed", range(80))
def test_a_damaged_bag(tmp_path: Path, seed: int):
    robot, luck = robot_named("g1"), random.Random(seed)
    qpos = np.tile(np.r_[0, 0, 0.8, 1, np.zeros(32)], (8, 1))
    write_mcap(robot, motion_of(robot, qpos, 50), tmp_path / "r.mcap")
    data = bytearray((tmp_path / "r.mcap").read_bytes())
    for _ in range(luck.randint(1, 4)):
        data[luck.randrange(len(data))] = luck.randrange(256)
    if seed % 3 == 0:
        del data[luck.randrange(len(data)) :]
    (tmp_path / "r.mcap").write_bytes(bytes(data))
    message = told(lambda: read_mcap(robot, tmp_path / "r.mcap"))
    assert len(message) < 1000


def test_what_is_whole_is_read(tmp_path: Path):
    (tmp_path / "r.urdf").write_text(URDF)
    assert not told(lambda: read_urdf(tmp_path / "r.urdf"))
    assert not told(lambda: description_of(TOML, "r.toml"))
