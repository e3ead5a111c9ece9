"""Robots of MJCF files."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import BodyError, OnbeatError
from onbeat.motion import rotations as rot
from onbeat.robots.description.description import AssumedWarning
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot, robot_from, robot_named


def leg(side: str, y: float) -> str:
    return f"""<body name="{side}_thigh" pos="0 {y} -0.05" quat="0.95 0 0.1 0.3">
      <joint name="{side}_hip_x" axis="1 0 0" range="-30 30" pos="0 0 0.02"/>
      <joint name="{side}_hip_y" axis="0 1 0.1" range="-90 30" pos="0.01 0 0.02" armature="0.02"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.35" size="0.05" mass="3"/>
      <body name="{side}_foot" pos="0 0 -0.4">
        <joint name="{side}_ankle" axis="0 1 0" range="-40 40" pos="0 0 0.01" actuatorfrcrange="-20 20"/>
        <geom type="box" size="0.1 0.04 0.02" pos="0.03 0 -0.04" mass="1"/>
        <body name="{side}_plate"><geom type="box" size="0.02 0.02 0.01" mass="0.1" contype="0" conaffinity="0"/></body>
      </body></body>"""


ROBOT = f"""<mujoco model="walker"><worldbody><geom type="plane" size="1 1 1"/><light pos="0 0 3"/>
  <body name="table" pos="2 0 0"><geom type="box" size="0.1 0.1 0.1" mass="1"/></body>
  <body name="pelvis" pos="0 0 1"><freejoint/><geom type="sphere" size="0.1" mass="10"/>
    {leg("left", 0.1)}{leg("right", -0.1)}
    <body name="head" pos="0 0 0.3"><joint name="neck" axis="0 0 1"/><geom size="0.1" mass="3"/></body>
  </body></worldbody>
  <actuator><motor joint="left_hip_x" gear="50" forcerange="-2 2" forcelimited="true"/></actuator></mujoco>"""


def read(text: str, folder: Path) -> Robot:
    (folder / "walker.xml").write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return robot_from(folder / "walker.xml")


def test_every_body_is_where_mujoco_has_it(tmp_path: Path):
    robot, public = read(ROBOT, tmp_path), engine().MjModel.from_xml_string(ROBOT)
    assert robot.body.names == (
        "left_hip_x", "left_hip_y", "left_ankle", "right_hip_x", "right_hip_y", "right_ankle", "neck",
    )  # fmt: skip
    rng = np.random.default_rng(0)
    here, there = engine().MjData(robot.model), engine().MjData(public)
    for _ in range(20):
        here.qpos[:3], here.qpos[3:7] = rng.normal(size=3), rot.normalise(rng.normal(size=4))
        here.qpos[7:] = there.qpos[7:] = rng.uniform(-1, 1, 7)
        there.qpos[:7] = here.qpos[:7]
        engine().mj_forward(robot.model, here)
        engine().mj_forward(public, there)
        for joint in robot.body.names:
            mine, other = robot.model.joint(joint).id, public.joint(joint).id
            np.testing.assert_allclose(here.xanchor[mine], there.xanchor[other], atol=1e-9)
            np.testing.assert_allclose(here.xaxis[mine], there.xaxis[other], atol=1e-9)
        top = public.body("pelvis").id
        np.testing.assert_allclose(here.subtree_com[1], there.subtree_com[top], atol=1e-5)


def test_masses_limits_and_torques_are_taken(tmp_path: Path):
    robot = read(ROBOT, tmp_path)
    assert robot.mass == pytest.approx(10 + 3 + 2 * 4.1, abs=1e-3)  # what is between two hinges of a body has a little
    np.testing.assert_allclose(np.degrees(robot.body.low[:3]), [-30, -90, -40])
    assert (robot.body.low[-1], robot.body.high[-1]) == (-math.pi, math.pi)
    np.testing.assert_allclose(robot.torque[[0, 2]], [100, 20])
    assert robot.model.dof_armature[7] == 0.02


def test_the_table_is_not_the_robot_and_a_missing_free_joint_is_given(tmp_path: Path):
    robot = read(ROBOT.replace("<freejoint/>", ""), tmp_path)
    assert robot.model.jnt_type[0] == engine().mjtJoint.mjJNT_FREE
    assert "table" not in robot.mjcf


def test_a_packaged_robot_comes_back_from_its_own_text(tmp_path: Path):
    packaged = robot_named("talos")
    robot = read(packaged.mjcf, tmp_path)
    assert robot.body.names == packaged.body.names
    assert robot.mass == pytest.approx(packaged.mass, abs=1e-9)
    np.testing.assert_allclose(robot.torque, packaged.torque)
    for side, foot in robot.feet.items():
        np.testing.assert_allclose(foot.corners, packaged.feet[side].corners, atol=0.006)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('<joint name="neck" axis="0 0 1"/>', '<joint name="neck" type="ball"/>', "joint 'neck' is a ball"),
        ('<joint name="neck" axis="0 0 1"/>', '<joint axis="0 0 1"/>', "a hinge of body 'head' has no name"),
        ('axis="0 0 1"', 'axis="0 0 0"', "MuJoCo cannot read it"),
        ('range="-30 30"', 'range="30 -30"', "joint 'left_hip_x' has a range from 30 to -30"),
        ('<geom size="0.1" mass="3"/>', "", "MuJoCo cannot read it"),
        ('<geom size="0.1" mass="3"/>', '<geom type="mesh" mesh="skull" mass="3"/>', "skull"),
        ('name="left_foot"', 'name="left_hoof"', "no left foot found"),
        ("<mujoco ", "<!DOCTYPE x><mujoco ", "DOCTYPE"),
        ("</mujoco>", "", "is no XML"),
        ('<mujoco model="walker">', '<mujoco><worldbody/></mujoco><mujoco model="walker">', "is no XML"),
    ],
)
def test_what_cannot_be_is_told(tmp_path: Path, old: str, new: str, told: str):
    assert old in ROBOT
    with pytest.raises(OnbeatError) as error:
        read(ROBOT.replace(old, new, 1), tmp_path)
    assert told in str(error.value)
    assert "walker.xml" in str(error.value)


def test_an_empty_world_and_another_xml_are_told(tmp_path: Path):
    with pytest.raises(BodyError, match="no body found"):
        read("<mujoco/>", tmp_path)
    with pytest.raises(BodyError, match="<robot> found"):
        read("<robot/>", tmp_path)


MESHES = """<asset><mesh name="shin" file="shin.stl"/><mesh file="skull.obj"/></asset><worldbody>"""


@pytest.mark.filterwarnings("ignore:.*no speed is told for")
def test_meshes_that_are_not_there_are_left_out_and_told(tmp_path: Path):
    text = ROBOT.replace("<worldbody>", MESHES).replace(
        '<geom size="0.1" mass="3"/>', '<geom size="0.1" mass="3"/><geom type="mesh" mesh="skull" density="0"/>'
    )
    text = text.replace("<asset>", '<compiler meshdir="parts"/><asset>')
    (tmp_path / "walker.xml").write_text(text)
    with pytest.warns(AssumedWarning, match=r"2 meshes are not where it says \(parts.shin\.stl") as told:
        robot = robot_from(tmp_path / "walker.xml")
    assert len(told) == 2
    whole = read(ROBOT, tmp_path)
    assert robot.body.names == whole.body.names
    assert robot.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(robot.feet["left"].corners, whole.feet["left"].corners)


def test_a_link_that_weighs_only_what_a_missing_mesh_does_is_told(tmp_path: Path):
    text = ROBOT.replace("<worldbody>", MESHES).replace(
        '<geom size="0.1" mass="3"/>', '<geom type="mesh" mesh="skull" mass="3"/>'
    )
    with pytest.raises(BodyError, match=r"cannot read it without the 2 meshes that are not where it says.*mass"):
        read(text, tmp_path)
