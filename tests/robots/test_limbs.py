"""Roles of robots by their structure, whatever their joints are called."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import msgspec
import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.examples.body import Build
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.motion.role_names import NEEDED
from onbeat.robots.description.description import AssumedWarning, Description, Link, Point, vector
from onbeat.robots.description.limbs import limbs_of
from onbeat.robots.description.toml import described
from onbeat.robots.ik.directions import aims_of
from onbeat.robots.model import Robot, body_of, robot_from, robot_of
from onbeat.robots.retarget import retarget

pytestmark = pytest.mark.filterwarnings("ignore::onbeat.robots.description.description.AssumedWarning")
ROBOTS = ("g1", "hrp4c", "talos")


def renamed(name: str, joints: Mapping[str, str] | None = None) -> tuple[Description, dict[str, str]]:
    """A packaged robot without roles, its links, joints and ends numbered; the old name of each new one."""
    old = described(name)
    links = {link: f"b{n}" for n, link in enumerate([old.root.link, *old.links])}
    turned = {link.joint: (joints or {}).get(link.joint, f"j{n}") for n, link in enumerate(old.links.values())}
    ends = {end: f"e{n}" for n, end in enumerate(old.ends)}
    made = msgspec.structs.replace(
        old,
        root=msgspec.structs.replace(old.root, link="b0"),
        links={
            links[link]: msgspec.structs.replace(it, parent=links[it.parent], joint=turned[it.joint])
            for link, it in old.links.items()
        },
        feet={side: msgspec.structs.replace(sole, link=links[sole.link]) for side, sole in old.feet.items()},
        ends={ends[end]: msgspec.structs.replace(point, link=links[point.link]) for end, point in old.ends.items()},
        pads={},
        apart=(),
        roles={},
    )
    return made, {"b0": old.root.link} | {new: was for was, new in (turned | ends).items()}


def joints_of(robot: Robot, old: Mapping[str, str]) -> dict[str, str]:
    return {role: old[joint] for role, joint in robot.roles.items()}


@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_without_names_has_its_knees_elbows_and_chest_where_they_are(name: str):
    description, old = renamed(name)
    found, known = joints_of(robot_of(name, description), old), robot_of(name, described(name))
    skeleton = known.body.skeleton
    places = dict(zip(skeleton.names, skeleton.rest_positions, strict=True))
    assert set(NEEDED) <= set(found)
    for role in NEEDED:
        part = role.split("_")[-1]
        # Hips, shoulders and wrists turn about three axes, centimetres apart: any of them is the place.
        if part in ("hip", "shoulder", "wrist"):
            assert np.linalg.norm(places[found[role]] - places[known.roles[role]]) < 0.12
        else:
            assert found[role] == known.roles[role], role


def test_names_of_which_some_mislead_do_not_mislead():
    """As some have it: the wrist's are called ``wr``, no other joint of the arm by a name that is known."""
    atlas = {}
    for side in ("left", "right"):
        for joint, word in (
            ("hip_pitch", "leg_hpy"), ("hip_roll", "leg_hpx"), ("hip_yaw", "leg_hpz"), ("knee", "leg_kny"),
            ("ankle_pitch", "leg_aky"), ("ankle_roll", "leg_akx"), ("shoulder_pitch", "arm_shy"),
            ("shoulder_roll", "arm_shx"), ("shoulder_yaw", "arm_shz"), ("elbow", "arm_ely"), ("wrist_roll", "arm_wrx"),
            ("wrist_pitch", "arm_wry"), ("wrist_yaw", "arm_wrz"),
        ):  # fmt: skip
            atlas[f"{side}_{joint}_joint"] = f"{side[0]}_{word}"
    description, old = renamed("g1", atlas)
    with pytest.warns(
        AssumedWarning, match=r"left_knee l_leg_kny.*atlas\.roles\.toml beside its file can say otherwise"
    ):
        robot = robot_of("atlas", description)
    found, known = joints_of(robot, old), robot_of("g1", described("g1")).roles
    assert {role: found[role] for role in NEEDED} == {role: known[role] for role in NEEDED}


def test_what_a_roles_file_tells_holds():
    description, _ = renamed("g1")
    joints = robot_of("g1", description).body.names
    told = msgspec.structs.replace(description, roles={"left_hip": joints[0], "right_hip": joints[6]})
    roles = robot_of("g1", told).roles
    assert (roles["left_hip"], roles["right_hip"], roles["left_knee"]) == (joints[0], joints[6], joints[3])


def without_waist() -> Description:
    """The G1 with its arms on the pelvis: its trunk is a part of that."""
    old, waist = described("g1"), ("waist_yaw_link", "waist_roll_link", "torso_link")
    links, at = dict[str, Link](), np.zeros(3)
    for name in waist:
        at = at + old.links[name].origin
    for name, link in old.links.items():
        if name not in waist:
            moved = vector(np.array(link.origin) + at) if link.parent in waist else link.origin
            parent = old.root.link if link.parent in waist else link.parent
            links[name] = msgspec.structs.replace(link, parent=parent, origin=moved)
    ends = {k: Point(old.root.link, (0, 0, 0.6)) if p.link in waist else p for k, p in old.ends.items()}
    return msgspec.structs.replace(old, links=links, ends=ends, apart=())


def test_a_robot_without_a_waist_dances_with_its_trunk_as_one():
    robot = robot_of("stiff", without_waist())
    skeleton = robot.body.skeleton
    chest = skeleton.names.index(robot.roles["chest"])
    assert skeleton.end_sites[chest]
    assert skeleton.parents[chest] == 0
    shoulders = [skeleton.rest_positions[skeleton.names.index(robot.roles[f"{s}_shoulder"])] for s in ("left", "right")]
    np.testing.assert_allclose(skeleton.rest_positions[chest], np.mean(shoulders, axis=0), atol=1e-9)
    # A dancer who leans by a quarter of a radian, trunk and pelvis, is followed by the pelvis.
    body = Build(1.7).skeleton
    turns = np.tile(rot.IDENTITY, (10, len(body), 1))
    turns[:, 0] = rot.about(np.array([1.0, 0, 0]), np.full(10, -0.25))
    danced = retarget(Motion(body, turns, np.tile([0, 0, 0.9], (10, 1)), fps=30), robot)
    up = rot.rotate(danced.world_rotations[5, 0], np.array([0, 0, 1.0]))
    assert np.arccos(up[2]) == pytest.approx(0.25, abs=0.08)


def test_what_neither_structure_nor_names_tell_is_said_with_what_to_do():
    description, _ = renamed("g1")
    arm = robot_of("g1", described("g1")).body.names.index("right_shoulder_pitch_joint")
    links = dict(list(description.links.items())[:arm])
    ends = {name: end for name, end in description.ends.items() if end.link in links or end.link == "b0"}
    robot = robot_of("one_arm", msgspec.structs.replace(description, links=links, ends=ends))
    with pytest.raises(BodyError) as error:
        body_of(robot)
    told = str(error.value)
    assert "no two limbs of three hinges or more, besides its legs, mirror each other" in told
    assert "nor names tell its chest, left_shoulder, left_elbow, left_wrist, right_shoulder" in told
    assert 'one_arm.roles.toml beside its file can tell them: [joints] and lines like chest = "joint"' in told
    assert "j0, j1" in told
    body = Build(1.7).skeleton
    standing = Motion(body, np.tile(rot.IDENTITY, (2, len(body), 1)), np.zeros((2, 3)), fps=30)
    with pytest.raises(BodyError, match="one_arm"):
        aims_of(standing, robot)


def test_a_robot_that_does_not_stand_as_it_is_told_to_is_told():
    """Its legs told as arms and its arms as legs: upside down."""
    known = robot_of("g1", described("g1")).roles
    pairs = (("hip", "shoulder"), ("knee", "elbow"), ("ankle", "wrist"))
    swapped = dict[str, str](pairs) | {above: below for below, above in pairs}
    limbs = [role.split("_") for role in NEEDED if "_" in role]
    roles = {f"{side}_{part}": known[f"{side}_{swapped[part]}"] for side, part in limbs}
    wrong = msgspec.structs.replace(described("g1"), roles=roles)
    with pytest.raises(
        BodyError, match=r"g1 does not stand where all its angles are zero.*g1\.roles\.toml beside its file"
    ):
        body_of(robot_of("g1", wrong))


REAL = (
    "unitree_g1/g1_29dof_rev_1_0.urdf",
    "unitree_g1/g1_23dof_rev_1_0.urdf",
    "unitree_h1/h1.urdf",
    "unitree_h1/h1_2_handless.urdf",
    "pal_talos/talos_full_v2.urdf",
    "hrp4c/HRP4Cmain.urdf",
    "nao_pepper/nao_V40.urdf",
    "nao_pepper/nao_V50.urdf",
)


def without_names(path: Path, to: Path) -> dict[str, str]:
    """Write a URDF with its links and joints numbered; the old name of each new one."""
    tree = ElementTree.parse(path)
    root = tree.getroot()
    new = {
        kind: {e.get("name", ""): f"{kind[0]}{n}" for n, e in enumerate(root.findall(kind))}
        for kind in ("link", "joint")
    }
    for kind, names in new.items():
        for element in root.findall(kind):
            element.set("name", names[element.get("name", "")])
    for element in root.iter():
        if element.tag in ("parent", "child"):
            element.set("link", new["link"].get(element.get("link", ""), ""))
        elif element.tag == "mimic":
            element.set("joint", new["joint"][element.get("joint", "")])
    tree.write(to)
    return {numbered: name for names in new.values() for name, numbered in names.items()}


@pytest.mark.parametrize("file", REAL)
def test_real_robots_have_the_same_roles_without_their_names(data: Path, tmp_path: Path, file: str):
    path, blank = data / "robots" / file, tmp_path / "blank.urdf"
    if (path.parent / "meshes").is_dir():
        (tmp_path / "meshes").symlink_to(path.parent / "meshes")
    old = without_names(path, blank)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        named, numbered = robot_from(path), robot_from(blank)
    ends = {name for robot in (named, numbered) for name in robot.body.skeleton.names if name not in robot.body.names}
    ends -= {named.body.skeleton.names[0], numbered.body.skeleton.names[0]}
    for role in NEEDED:
        one, other = named.roles[role], numbered.roles[role]
        assert old.get(other, other) == one or (one in ends and other in ends), role
    assert {side: old[foot.link] for side, foot in numbered.feet.items()} == {
        side: foot.link for side, foot in named.feet.items()
    }


def test_two_pairs_of_arms_are_not_chosen_from():
    old = described("g1")
    joints = dict(old.links)
    for name, link in old.links.items():
        if any(part in name for part in ("shoulder", "elbow", "wrist")):
            above = link.parent if link.parent == "torso_link" else f"{link.parent}_2"
            origin = (link.origin[0], link.origin[1], link.origin[2] - 0.1) if above == "torso_link" else link.origin
            joints[f"{name}_2"] = msgspec.structs.replace(link, parent=above, joint=f"{link.joint}_2", origin=origin)
    robot = robot_of("shiva", msgspec.structs.replace(old, links=joints, apart=()))
    feet = {side: robot.body.skeleton.names.index(f"{side}_ankle_roll_joint") for side in ("left", "right")}
    assert limbs_of(robot.body, feet).unclear == "more than one pair of limbs may be its arms"
