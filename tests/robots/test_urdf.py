"""Robots of URDF files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import BodyError, LimitError, OnbeatError
from onbeat.robots.model import Robot, robot_from

INERTIA = '<inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/>'
INERTIAL = f'<inertial><origin xyz="0 0 -0.2"/><mass value="2"/>{INERTIA}</inertial>'
LIMIT = '<limit lower="-1" upper="1" velocity="5" effort="50"/>'
BOX = '<collision><origin xyz="0.02 0 -0.03"/><geometry><box size="0.2 0.1 0.04"/></geometry></collision>'


def leg(side: str, y: float) -> str:
    return f"""
<link name="{side}_thigh">{INERTIAL}</link><link name="{side}_shin">{INERTIAL}</link>
<link name="{side}_foot">{INERTIAL.replace("-0.2", "-0.02")}{BOX}</link><link name="{side}_frame"/>
<joint name="{side}_hip" type="revolute"><parent link="pelvis"/><child link="{side}_thigh"/>
<origin xyz="0 {y} 0"/><axis xyz="0 1 0"/>{LIMIT}</joint>
<joint name="{side}_knee" type="revolute"><parent link="{side}_thigh"/><child link="{side}_shin"/>
<origin xyz="0 0 -0.4" rpy="0 0 0.3"/><axis xyz="0 1 0"/>{LIMIT}</joint>
<joint name="{side}_ankle" type="revolute"><parent link="{side}_shin"/><child link="{side}_foot"/>
<origin xyz="0 0 -0.4" rpy="0 0 -0.3"/><axis xyz="0 1 0"/>{LIMIT}</joint>
<joint name="{side}_fixed" type="fixed"><parent link="{side}_foot"/><child link="{side}_frame"/></joint>"""


PELVIS = f'<link name="pelvis">{INERTIAL.replace("-0.2", "0")}</link>'
HEAD = f"""<link name="stem">{INERTIAL}</link><link name="head">{INERTIAL}</link>
<joint name="stem_joint" type="fixed"><parent link="pelvis"/><child link="stem"/><origin xyz="0 0 0.4"/></joint>
<joint name="neck" type="continuous"><parent link="stem"/><child link="head"/><origin xyz="0 0 0.1"/></joint>"""
ROBOT = f'<robot name="walker">{PELVIS}{leg("left", 0.1)}{leg("right", -0.1)}{HEAD}</robot>'


def read(text: str, folder: Path, name: str = "walker.urdf") -> Robot:
    (folder / name).write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return robot_from(folder / name)


def test_hinges_are_found_and_what_is_fixed_is_merged(tmp_path: Path):
    robot = read(ROBOT, tmp_path)
    assert robot.body.names == ("left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle", "neck")
    assert abs(robot.mass - 18) < 1e-9
    # The root is the pelvis and, 0.4 m above it, the stem: 2 kg each, the stem's centre 0.2 m below its origin.
    pelvis = robot.model.body("pelvis")
    np.testing.assert_allclose(pelvis.mass, 4)
    np.testing.assert_allclose(pelvis.ipos, [0, 0, 0.1], atol=1e-12)
    np.testing.assert_allclose(sorted(pelvis.inertia), [0.02, 0.08, 0.08], atol=1e-12)
    np.testing.assert_allclose(robot.model.body("head").pos, [0, 0, 0.5], atol=1e-12)


def test_soles_are_the_lowest_of_the_shapes(tmp_path: Path):
    robot = read(ROBOT, tmp_path)
    foot = robot.feet["left"]
    assert foot.link == "left_foot"
    np.testing.assert_allclose(foot.corners[:, 2], -0.05)
    np.testing.assert_allclose(foot.corners[:, :2], [[0.12, 0.05], [0.12, -0.05], [-0.08, -0.05], [-0.08, 0.05]])
    assert robot.model.qpos0[2] == pytest.approx(0.85)


def test_what_is_assumed_is_told(tmp_path: Path):
    text = ROBOT.replace(BOX, "").replace('effort="50"', "").replace('velocity="5"', 'velocity="0"')
    (tmp_path / "walker.urdf").write_text(text)
    with pytest.warns(UserWarning, match="assumed") as told:
        robot = robot_from(tmp_path / "walker.urdf")
    message = str(told[0].message)
    assert "left_foot has no shape: a sole of" in message
    assert "no speed is told for left_hip" in message
    assert "no torque is told for left_hip" in message
    assert (robot.body.speed == 10).all()
    assert (robot.torque == 72).all()


def test_meshes_are_read_where_they_are(tmp_path: Path):
    corners = np.array([(x, y, z) for x in (-50, 150) for y in (-40, 40) for z in (-60, 0)], float)
    lines = [f"vertex {x} {y} {z}" for x, y, z in corners]
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "foot.STL").write_text("solid foot\n" + "\n".join(lines) + "\nendsolid\n")
    mesh = '<mesh filename="package://walker_description/meshes/foot.STL" scale="0.001 0.001 0.001"/>'
    text = ROBOT.replace('<origin xyz="0.02 0 -0.03"/><geometry><box size="0.2 0.1 0.04"/>', "<geometry>" + mesh)
    corners = read(text, tmp_path).feet["right"].corners
    np.testing.assert_allclose(corners[:, :2], [[0.15, 0.04], [0.15, -0.04], [-0.05, -0.04], [-0.05, 0.04]])
    np.testing.assert_allclose(corners[:, 2], -0.06)


@pytest.mark.filterwarnings("ignore:.*no speed is told for neck")
def test_meshes_that_are_not_there_are_told(tmp_path: Path):
    mesh = '<visual><geometry><mesh filename="shin.dae"/></geometry></visual></link><link name="left_foot">'
    (tmp_path / "walker.urdf").write_text(ROBOT.replace('</link>\n<link name="left_foot">', f"{mesh}", 1))
    with pytest.warns(UserWarning, match=r"1 meshes are not beside it \(shin\.dae"):
        robot_from(tmp_path / "walker.urdf")


def test_followers_and_held_joints_are_still(tmp_path: Path):
    text = ROBOT.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><mimic joint="neck"/>', 1)
    assert "left_hip" not in read(text, tmp_path).body.names
    text = ROBOT.replace('lower="-1" upper="1"', 'lower="0" upper="0"', 1)
    robot = read(text, tmp_path)
    assert "left_hip" not in robot.body.names
    assert abs(robot.mass - 18) < 1e-9


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', "joint 'left_hip' turns about an axis of no length"),
        ('lower="-1" upper="1"', 'lower="1" upper="-1"', "joint 'left_hip' turns from 1 to -1 rad"),
        (LIMIT, "", "joint 'left_hip': a revolute joint needs a <limit"),
        (
            f'<link name="left_shin">{INERTIAL}</link>',
            '<link name="left_shin"/>',
            "which joint 'left_knee' turns, has no mass",
        ),
        ('<mass value="2"/>', "", "link 'pelvis': an <inertial> has a <mass>"),
        ('ixx="0.02"', 'ixx="0.9"', "link 'pelvis' has an inertia that no body has"),
        ('ixx="0.02"', 'ixx="1e300"', "link 'pelvis': a mass or an inertia found that no robot has"),
        ('<child link="left_shin"/>', '<child link="right_shin"/>', "link 'right_shin' hangs on two joints"),
        ('<parent link="pelvis"/>', '<parent link="left_shin"/>', "in a loop of joints"),
        ('<parent link="pelvis"/>', '<parent link="hips"/>', "joint 'left_hip' joins link 'hips', which is not there"),
        ('<parent link="pelvis"/>', "", "joint 'left_hip' has no <parent"),
        ('type="revolute"', 'type="ball"', "joint 'left_hip': type 'ball' found"),
        ('name="left_hip"', "", "a joint without a name"),
        ('xyz="0 0.1 0"', 'xyz="0 0.1"', "joint 'left_hip': xyz: three numbers are expected"),
        ('xyz="0 0.1 0"', 'xyz="0 nan 0"', "left_hip"),
        ('xyz="0 0.1 0"', 'xyz="0 1e300 0"', "left_hip"),
        ('<box size="0.2 0.1 0.04"/>', '<sphere radius="-1"/>', "radius of -1 m"),
        ("</robot>", '<link name="lost"/></robot>', "lost hang on nothing"),
        ("<robot ", "<mujoco ", "is no XML"),
        ("<robot ", "<!DOCTYPE x><robot ", "DOCTYPE"),
        ("</robot>", "", "is no XML"),
    ],
)
def test_what_cannot_be_is_told(tmp_path: Path, old: str, new: str, told: str):
    assert old in ROBOT
    with pytest.raises(OnbeatError) as error:
        read(ROBOT.replace(old, new, 1), tmp_path)
    assert told in str(error.value)
    assert "walker.urdf" in str(error.value)


def test_a_robot_without_feet_is_told(tmp_path: Path):
    with pytest.raises(BodyError, match=r"no left foot found.*left_thigh"):
        read(ROBOT.replace("left_foot", "left_hoof").replace("left_ankle", "left_fetlock"), tmp_path)


def test_links_that_all_hang_on_another_are_told(tmp_path: Path):
    loop = '<robot><link name="a"/><link name="b"/>' + "".join(
        f'<joint name="{p}{c}" type="fixed"><parent link="{p}"/><child link="{c}"/></joint>' for p, c in ("ab", "ba")
    )
    with pytest.raises(BodyError, match="make a loop through joint 'ab'"):
        read(loop + "</robot>", tmp_path)


def test_a_file_that_is_not_there_is_told(tmp_path: Path):
    with pytest.raises(LimitError, match="cannot read"):
        robot_from(tmp_path / "none.urdf")


def test_roles_are_told_beside_it(tmp_path: Path):
    (tmp_path / "walker.roles.toml").write_text('[joints]\nchest = "neck"\nleft_hip = "left_knee"\n')
    robot = read(ROBOT, tmp_path)
    assert (robot.roles["chest"], robot.roles["left_hip"]) == ("neck", "left_knee")
    (tmp_path / "walker.roles.toml").write_text('[joints]\nchest = "nick"\n')
    with pytest.raises(BodyError, match=r"walker\.urdf: chest is to be 'nick', which is no joint"):
        read(ROBOT, tmp_path)
