"""The robots that are known by name, beside the public descriptions they are read off."""

from __future__ import annotations

import copy
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from onbeat.errors import BodyError
from onbeat.limits.named import robot_limits
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.hinges import HingeBody
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.description.toml import described
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot, robot_from, robot_named, robot_of

NAMES = ("g1", "hrp4c", "talos")


def configuration(robot: Robot, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.concatenate(
        (rng.normal(size=3), rot.normalise(rng.normal(size=4)), rng.uniform(robot.body.low, robot.body.high))
    )


def posed(model: Any, qpos: np.ndarray) -> Any:
    data = engine().MjData(model)
    data.qpos[:] = qpos
    engine().mj_forward(model, data)
    return data


@pytest.mark.parametrize("name", NAMES)
def test_the_model_has_the_bodys_hinges_in_order(name: str):
    robot = robot_named(name)
    model, body = robot.model, robot.body
    assert tuple(model.joint(j).name for j in range(1, model.njnt)) == body.names
    assert [model.joint(int(model.actuator_trnid[m, 0])).name for m in range(model.nu)] == list(body.names)
    np.testing.assert_allclose(model.jnt_range[1:], np.column_stack((body.low, body.high)), atol=1e-9)
    for limit in (model.actuator_forcerange, model.jnt_actfrcrange[1:]):
        np.testing.assert_allclose(limit, np.column_stack((-robot.torque, robot.torque)))
    assert model.jnt_limited[1:].all()


@pytest.mark.parametrize("name", NAMES)
def test_limits_are_those_of_the_table(name: str):
    robot, limits = robot_named(name), robot_limits(name)
    assert set(limits.joints) == set(robot.body.names)
    same = limits.of(robot.body.names)
    for mine, told in ((robot.body.low, same.low), (robot.body.high, same.high), (robot.body.speed, same.speed)):
        np.testing.assert_allclose(mine, told, atol=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_it_stands_on_its_soles_and_nothing_overlaps(name: str):
    robot = robot_named(name)
    data = posed(robot.model, robot.model.qpos0)
    for foot in robot.feet.values():
        link = data.body(foot.link)
        corners = link.xpos + foot.corners @ link.xmat.reshape(3, 3).T
        np.testing.assert_allclose(corners[:, 2], 0, atol=1e-6)
        assert np.ptp(corners[:, 0]) > 0.12
        assert np.ptp(corners[:, 1]) > 0.05
    assert all(contact.dist > -1e-6 for contact in data.contact)
    left, right = (data.body(robot.feet[side].link).xpos for side in ("left", "right"))
    assert left[1] > 0.05
    assert right[1] < -0.05


@pytest.mark.parametrize("name", NAMES)
def test_only_soles_touch_the_floor(name: str):
    robot = robot_named(name)
    qpos = robot.model.qpos0.copy()
    qpos[2] -= 1e-3
    data = posed(robot.model, qpos)
    touching = {robot.model.geom(int(contact.geom[1])).name for contact in data.contact}
    assert {f"{side}_sole_{n}" for side in ("left", "right") for n in range(4)} <= touching
    assert all(name.startswith(("left_sole", "right_sole", "pad_")) for name in touching)


@pytest.mark.parametrize("name", NAMES)
def test_a_dance_finds_its_roles(name: str):
    robot = robot_named(name)
    body = Body.of(robot.body.skeleton)
    assert {role: robot.body.skeleton.names[joint] for role, joint in body.joints.items()} == dict(robot.roles)
    assert {"left_toe", "right_hand", "head"} <= set(robot.roles)


@pytest.mark.parametrize("name", NAMES)
def test_its_skeleton_is_where_the_model_is(name: str):
    robot = robot_named(name)
    for seed in range(5):
        qpos = configuration(robot, seed)
        data = posed(robot.model, qpos)
        skeleton = robot.body.skeleton
        rotations = np.tile(rot.IDENTITY, (len(skeleton), 1))
        rotations[0], rotations[robot.body.joints] = qpos[3:7], rot.about(robot.body.axes, qpos[7:])
        positions = forward_kinematics(skeleton, rotations, qpos[:3])[1]
        np.testing.assert_allclose(positions[robot.body.joints], data.xanchor[1:], atol=2e-6)


def test_the_g1_is_the_body_that_files_hold():
    robot = robot_named("g1")
    assert robot.body is G1
    own = robot_of("g1", described("g1")).body
    assert own.skeleton == G1.skeleton
    for what in ("axes", "low", "high", "speed", "links"):
        np.testing.assert_allclose(getattr(own, what), getattr(G1, what), atol=1e-6)


def test_names_are_forgiving_and_kept():
    assert robot_named("HRP-4C") is robot_named("hrp4c")
    assert robot_named("hrp4c").model is robot_named("hrp4c").model
    with pytest.raises(BodyError, match="g1, hrp4c, talos"):
        robot_named("g2")


def test_friction_is_that_of_the_soles():
    slippery = robot_named("g1", friction=0.6)
    soles = [n for n in range(slippery.model.ngeom) if "sole" in slippery.model.geom(n).name]
    assert len(soles) == 8
    np.testing.assert_allclose(slippery.model.geom_friction[soles, 0], 0.6)
    for wrong in (0.0, float("nan"), float("inf")):
        with pytest.raises(BodyError, match="friction"):
            robot_named("g1", friction=wrong)


def test_it_falls_on_the_floor_and_lies_there():
    model = robot_named("g1").model
    data = posed(model, model.qpos0)
    for _ in range(1000):  # two seconds without a motor
        engine().mj_step(model, data)
    assert data.qpos[2] < 0.4
    assert data.xpos[1:, 2].min() > 0


def same_places(robot: Robot, public: Any, atol: float) -> None:
    """Every body of the public model is where the body of the same name is here, and its mass and centre too."""
    names = [public.joint(j).name for j in range(1, public.njnt)]
    assert set(robot.body.names) <= set(names)
    for seed in range(20):
        mine = configuration(robot, seed)
        other = public.qpos0.copy()
        other[:7] = mine[:7]
        for name, angle in zip(robot.body.names, mine[7:], strict=True):
            other[public.joint(name).qposadr[0]] = angle
        here, there = posed(robot.model, mine), posed(public, other)
        for body in range(1, public.nbody):
            name = public.body(body).name
            if name in {robot.model.body(b).name for b in range(robot.model.nbody)}:
                np.testing.assert_allclose(here.body(name).xpos, there.xpos[body], atol=atol)
        np.testing.assert_allclose(here.subtree_com[1], there.subtree_com[1], atol=atol)


def same_dynamics(robot: Robot, public: Any, rtol: float) -> None:
    """The torques of random movements in the air are those of the public model, whose rotors weigh nothing."""
    own = copy.copy(robot.model)
    own.dof_armature[:] = 0
    own.opt.disableflags = public.opt.disableflags = engine().mjtDisableBit.mjDSBL_CONSTRAINT
    public.dof_armature[:] = public.dof_damping[:] = 0
    order = [public.joint(name).dofadr[0] for name in robot.body.names]
    for seed in range(10):
        rng = np.random.default_rng(seed)
        qpos, qvel, qacc = configuration(robot, seed), rng.normal(size=own.nv), 10 * rng.normal(size=own.nv)
        torques = list[np.ndarray]()
        for model, joints in ((own, np.arange(6, own.nv)), (public, np.array(order))):
            data = engine().MjData(model)
            data.qpos[:7], data.qvel[:6], data.qacc[:6] = qpos[:7], qvel[:6], qacc[:6]
            data.qpos[joints + 1], data.qvel[joints], data.qacc[joints] = qpos[7:], qvel[6:], qacc[6:]
            engine().mj_inverse(model, data)
            torques.append(data.qfrc_inverse[[*range(6), *joints]])
        np.testing.assert_allclose(*torques, atol=rtol * np.abs(torques[1]).max())


def without_meshes(path: Path, still: tuple[str, ...] = ()) -> Any:
    """A URDF as MuJoCo reads it, its root free, its shapes taken out, and inertias that it refuses set right."""
    root = ET.parse(path).getroot()
    for link in root.findall("link"):
        for shape in (*link.findall("visual"), *link.findall("collision")):
            link.remove(shape)
        for inertia in link.findall("inertial/inertia"):
            if "hrp4c" in str(path):
                inertia.attrib.update(ixx="0.1", iyy="0.1", izz="0.1", ixy="0", ixz="0", iyz="0")
    joints = root.findall("joint")
    for joint in joints:
        if joint.get("name") in still:
            joint.set("type", "fixed")
    below = {joint.find("child").get("link") for joint in joints}
    [top] = [link.get("name") for link in root.findall("link") if link.get("name") not in below]
    for old in root.findall("mujoco"):
        root.remove(old)
    ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", fusestatic="true")
    ET.SubElement(root, "link", name="everything")
    free = ET.SubElement(root, "joint", name="floating", type="floating")
    ET.SubElement(free, "parent", link="everything")
    ET.SubElement(free, "child", link=top)
    return engine().MjModel.from_xml_string(ET.tostring(root, encoding="unicode"))


def test_the_g1_agrees_with_its_public_descriptions(data: Path):
    folder, robot = data / "robots" / "unitree_g1", robot_named("g1")
    for public in (
        without_meshes(folder / "g1_29dof_rev_1_0.urdf"),
        engine().MjModel.from_xml_path(str(folder / "g1_29dof_rev_1_0.xml")),
    ):
        assert abs(robot.mass - public.body_mass.sum()) < 1e-6
        np.testing.assert_allclose(robot.model.jnt_range[1:], public.jnt_range[1:], atol=1e-5)
        same_places(robot, public, 1e-6)
        same_dynamics(robot, public, 1e-4)
    # Ankles and the waist's roll and pitch have 35 N·m in the URDF, which is taken, and 50 in the MJCF.
    told = public.jnt_actfrcrange[1:, 1]
    np.testing.assert_allclose(robot.torque, np.where(told == 50, 35, told))


def test_talos_agrees_with_its_public_description(data: Path):
    path, robot = data / "robots" / "pal_talos" / "talos_full_v2.urdf", robot_named("talos")
    named = [line.split('"')[1] for line in path.read_text().splitlines() if "<joint name=" in line]
    fingers = [name for name in named if "gripper" in name]
    still = tuple(name for name in fingers if name not in robot.body.names)
    public = without_meshes(path, still)
    assert abs(robot.mass - public.body_mass.sum()) < 1e-6
    order = [public.joint(name).id for name in robot.body.names]
    np.testing.assert_allclose(robot.model.jnt_range[1:], public.jnt_range[order], atol=1e-9)
    same_places(robot, public, 1e-6)
    same_dynamics(robot, public, 1e-6)


def test_hrp4c_agrees_with_its_public_description(data: Path):
    robot = robot_named("hrp4c")
    links = yaml.safe_load((data / "hrp4c_dance" / "HRP4C.body").read_text())["links"]
    assert [link["name"] for link in links[1:]] == list(robot.body.names)
    assert abs(robot.mass - sum(link["mass"] for link in links)) < 1e-6
    told = np.radians([link["joint_range"] for link in links[1:]])
    np.testing.assert_allclose(np.column_stack((robot.body.low, robot.body.high)), told, atol=1e-8)
    model = robot.model
    for link in links:
        body = model.body(link["name"])
        axes = rot.to_matrix(body.iquat[None])[0]
        np.testing.assert_allclose(body.ipos, link["center_of_mass"], atol=1e-8)
        full = np.array(link["inertia"], float).reshape(3, 3)
        np.testing.assert_allclose(axes @ np.diag(body.inertia) @ axes.T, full, atol=1e-8)
    # Its URDF has the same places, but a neck that is 2 cm longer, and hands and a face.
    public = without_meshes(data / "robots" / "hrp4c" / "HRP4Cmain.urdf")
    for seed in range(5):
        qpos = configuration(robot, seed)
        other = public.qpos0.copy()
        other[:7] = qpos[:7]
        for name, angle in zip(robot.body.names, qpos[7:], strict=True):
            if "TOE" not in name:
                other[public.joint(name).qposadr[0]] = angle
        here, there = posed(model, qpos), posed(public, other)
        for name in robot.body.names:
            if "TOE" not in name and "NECK" not in name:
                np.testing.assert_allclose(here.body(name).xpos, there.body(f"{name}_LINK").xpos, atol=2e-6)


def test_a_public_file_makes_the_robot_that_is_packaged(data: Path):
    folder, packaged = data / "robots" / "unitree_g1", robot_named("g1")
    for file in ("g1_29dof_rev_1_0.urdf", "g1_29dof_rev_1_0.xml"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            robot = robot_from(folder / file)
        assert isinstance(robot.body, HingeBody)
        assert robot.body.names == packaged.body.names
        assert abs(robot.mass - packaged.mass) < 1e-6
        np.testing.assert_allclose(np.where(robot.torque == 50, 35, robot.torque), packaged.torque)
        same_places(packaged, robot.model, 1e-6)
        same_dynamics(packaged, copy.copy(robot.model), 1e-4)
        for side, foot in robot.feet.items():
            assert foot.link == packaged.feet[side].link
            np.testing.assert_allclose(foot.corners, packaged.feet[side].corners, atol=0.006)
        assert set(packaged.roles) - set(robot.roles) <= {"head", "neck", "spine"}


@pytest.mark.filterwarnings("ignore:.*its structure tells which joint is what")
@pytest.mark.parametrize(
    ("file", "hinges"),
    [
        ("unitree_h1/h1.urdf", 19),
        ("unitree_h1/h1_2_handless.urdf", 27),
        ("nao_pepper/nao_V50.urdf", 25),
        ("pal_talos/talos_full_v2.urdf", 32),
    ],
)
def test_other_public_humanoids_stand(data: Path, file: str, hinges: int):
    with pytest.warns(UserWarning, match="capsules"):
        robot = robot_from(data / "robots" / file)
    assert len(robot.body.names) == hinges
    model = robot.model
    names = [model.joint(j).name for j in range(1, model.njnt)]
    assert tuple(names) == robot.body.names
    here = posed(model, model.qpos0)
    for foot in robot.feet.values():
        link = here.body(foot.link)
        np.testing.assert_allclose((link.xpos + foot.corners @ link.xmat.reshape(3, 3).T)[:, 2], 0, atol=1e-4)


def test_a_robot_on_wheels_has_no_feet(data: Path):
    with pytest.raises(BodyError, match="no left foot found"), pytest.warns(UserWarning, match="meshes"):
        robot_from(data / "robots" / "nao_pepper" / "pepper.urdf")
