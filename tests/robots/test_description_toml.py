"""Descriptions of robots as people write them."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.errors import BodyError, LimitError
from onbeat.robots.description.toml import described, described_robots, description_of, read_description
from onbeat.robots.model import robot_from

LEG = """
[links.{side}_leg]
parent = "pelvis"
joint = "{side}_hip"
origin = [0, {y}, 0]
axis = [0, 1, 0]
position = [-1, 1]
speed = 5
torque = 50
mass = 2
centre = [0, 0, -0.2]
inertia = [0.02, 0.02, 0.01, 0, 0, 0]
"""
FOOT = """
[feet.{side}]
link = "{side}_leg"
corners = [[0.1, 0.05, -0.4], [0.1, -0.05, -0.4], [-0.1, -0.05, -0.4], [-0.1, 0.05, -0.4]]
"""
ROBOT = "\n".join((
    'version = 1\nname = "two legs"\n[root]\nlink = "pelvis"\nmass = 5\ncentre = [0, 0, 0]',
    "inertia = [0.05, 0.05, 0.05, 0, 0, 0]",
    *(LEG.format(side=side, y=y) for side, y in (("left", 0.1), ("right", -0.1))),
    *(FOOT.format(side=side) for side in ("left", "right")),
))  # fmt: skip


def test_what_is_written_is_read():
    robot = description_of(ROBOT, "two.toml")
    assert (robot.name, robot.root.mass, list(robot.links)) == ("two legs", 5, ["left_leg", "right_leg"])
    assert robot.links["right_leg"].origin == (0, -0.1, 0)
    assert robot.links["left_leg"].rpy == (0, 0, 0)
    assert robot.feet["left"].corners[3] == (-0.1, 0.05, -0.4)


def test_a_file_is_a_robot(tmp_path: Path):
    (tmp_path / "two.toml").write_text(ROBOT)
    robot = robot_from(tmp_path / "two.toml")
    assert (robot.name, robot.body.names, robot.mass) == ("two", ("left_hip", "right_hip"), 9)
    assert robot.model.qpos0[2] == 0.4


@pytest.mark.parametrize("name", described_robots())
def test_the_packaged_ones_tell_their_source_and_licence(name: str):
    description = described(name)
    assert len(description.source) > 10
    assert len(description.licence) > 5
    assert all(link.capsules for link in (description.root,))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("mass = 2", "mass = -2", "link 'left_leg' cannot be"),
        ("mass = 2", "", "missing required field `mass`"),
        ("mass = 2", "mass = 2\nwight = 3", "wight"),
        ("mass = 2", 'mass = "two"', "left_leg"),
        ("mass = 2", "mass = nan", "left_leg"),
        ("mass = 2", "mass = ", "cannot be"),
        ("version = 1", "version = 9", "version 9"),
        ("position = [-1, 1]", "position = [1, -1]", "'left_hip' turns from 1 to -1"),
        ("position = [-1, 1]", "position = [-inf, 1]", "'left_hip' has a number"),
        ("axis = [0, 1, 0]", "axis = [0, 0, 0]", "'left_hip' turns about an axis of no length"),
        (
            "inertia = [0.02, 0.02, 0.01, 0, 0, 0]",
            "inertia = [0.02, 0.02, 0.01, 0.5, 0, 0]",
            "'left_leg' has an inertia",
        ),
        ("inertia = [0.02, 0.02, 0.01, 0, 0, 0]", "inertia = [0.09, 0.02, 0.01, 0, 0, 0]", "sum of the others"),
        ('joint = "right_hip"', 'joint = "left_hip"', "'left_hip' of link 'right_leg' is there twice"),
        ('parent = "pelvis"', 'parent = "spine"', "'left_leg' hangs on 'spine'"),
        ('parent = "pelvis"', 'parent = "left_leg"', "'left_leg' hangs on 'left_leg'"),
        ('parent = "pelvis"', 'parent = "right_leg"', "'left_leg' is not in its place"),
        ("[feet.right]", "[feet.middle]", "feet left and right are expected"),
        ('[feet.right]\nlink = "right_leg"', '[feet.right]\nlink = "wing"', "'wing', which is no link"),
        ("corners = [[0.1, 0.05, -0.4]", "corners = [[inf, 0.05, -0.4]", "has a number that no robot has"),
    ],
)
def test_what_cannot_be_is_told(old: str, new: str, told: str):
    assert old in ROBOT
    with pytest.raises(BodyError) as error:
        description_of(ROBOT.replace(old, new, 1), "two.toml")
    assert told in str(error.value)
    assert str(error.value).startswith("two.toml")


def test_a_file_that_is_not_there_is_told(tmp_path: Path):
    with pytest.raises(LimitError, match="cannot read"):
        read_description(tmp_path / "none.toml")
    (tmp_path / "robot.pdf").write_text("x")
    with pytest.raises(BodyError, match=r"\.urdf, \.xml \(MJCF\) or \.toml is expected"):
        robot_from(tmp_path / "robot.pdf")
