"""The Unitree G1 against Unitree's own models, with kinematics of the test's own."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.unitree_g1 import G1, G1_23, LINKS, g1_angles, g1_motion, unit_quaternions


def vector(element, key: str) -> np.ndarray:
    words = "" if element is None else element.get(key, "")
    return np.array([float(word) for word in words.split()] or [0.0, 0.0, 0.0])


def placed(r: np.ndarray, p: np.ndarray) -> np.ndarray:
    return np.vstack((np.column_stack((r, p)), [0, 0, 0, 1]))


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    k = np.cross(np.eye(3), axis / np.linalg.norm(axis))  # k v = axis × v
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def of_quaternion(q: np.ndarray) -> np.ndarray:
    q = q / np.linalg.norm(q)
    length = np.linalg.norm(q[1:])
    return np.eye(3) if length < 1e-12 else turn(q[1:], 2 * np.arctan2(length, q[0]))


def urdf_links(path, angles: dict[str, float]) -> dict[str, np.ndarray]:
    """Where each link is, 4 x 4, with the pelvis at the origin."""
    links = {"pelvis": np.eye(4)}
    for joint in ElementTree.parse(path).getroot().findall("joint"):
        parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
        roll, pitch, yaw = vector(joint.find("origin"), "rpy")
        tilt = turn(np.eye(3)[2], yaw) @ turn(np.eye(3)[1], pitch) @ turn(np.eye(3)[0], roll)
        angle = angles.get(joint.get("name"))
        moved = np.eye(3) if angle is None else turn(vector(joint.find("axis"), "xyz"), angle)
        links[child] = links[parent] @ placed(tilt @ moved, vector(joint.find("origin"), "xyz"))
    return links


def mjcf_links(path, angles: dict[str, float]) -> dict[str, np.ndarray]:
    links: dict[str, np.ndarray] = {}

    def visit(body, above: np.ndarray) -> None:
        tilt = of_quaternion(np.array([float(w) for w in body.get("quat", "1 0 0 0").split()]))
        here = above @ placed(tilt, vector(body, "pos") * (body.get("name") != "pelvis"))
        for joint in body.findall("joint"):
            if joint.get("name") in angles:
                here = here @ placed(turn(vector(joint, "axis"), angles[joint.get("name")]), np.zeros(3))
        links[body.get("name")] = here
        for child in body.findall("body"):
            visit(child, here)

    visit(ElementTree.parse(path).getroot().find("worldbody").find("body"), np.eye(4))
    return links


def pose(angles: np.ndarray):
    return g1_motion(np.zeros((len(angles), 3)), np.tile(rot.IDENTITY, (len(angles), 1)), angles, 30)


@pytest.mark.parametrize(
    ("name", "links_of"),
    [("g1_29dof_rev_1_0.urdf", urdf_links), ("g1_29dof_rev_1_0.xml", mjcf_links), ("g1_mjlab.xml", mjcf_links)],
)
def test_every_link_is_where_the_makers_model_has_it(data, name, links_of):
    angles = np.random.default_rng(5).uniform(G1.low, G1.high, (20, 29))
    motion = pose(angles)
    tilts = np.concatenate((rot.IDENTITY[None], G1.links))
    frames = rot.to_matrix(rot.multiply(motion.world_rotations[:, :30], tilts))
    for frame, values in enumerate(angles):
        links = links_of(data / "robots" / "unitree_g1" / name, dict(zip(G1.names, values, strict=True)))
        assert motion.positions[frame, :30] == pytest.approx(np.array([links[k][:3, 3] for k in LINKS]), abs=1e-5)
        assert frames[frame] == pytest.approx(np.array([links[k][:3, :3] for k in LINKS]), abs=2e-5)


def test_order_and_limits_are_the_makers(data):
    folder = data / "robots" / "unitree_g1"
    for name, mine in (("g1_29dof_rev_1_0.urdf", G1.names), ("g1_23dof_rev_1_0.urdf", G1_23)):
        joints = ElementTree.parse(folder / name).getroot().findall("joint[@type='revolute']")
        assert tuple(joint.get("name") for joint in joints) == mine
        for joint in joints:
            limit, k = joint.find("limit"), G1.names.index(joint.get("name"))
            stored = [float(limit.get(key)) for key in ("lower", "upper", "velocity")]
            assert [G1.low[k], G1.high[k], G1.speed[k]] == pytest.approx(stored, abs=1e-6)


def test_the_right_side_mirrors_the_left():
    rng, angles = np.random.default_rng(3), np.zeros((1, 29))
    for left, name in enumerate(G1.names):
        if name.startswith("left"):
            right = G1.names.index("right" + name[4:])
            angles[0, left] = rng.uniform(G1.low[left], G1.high[left])
            angles[0, right] = angles[0, left] * (1 if "pitch" in name or "knee" in name or "elbow" in name else -1)
    p, names = pose(angles).positions[0], G1.skeleton.names
    for left in (n for n in names if n.startswith("left")):
        mirrored = p[names.index(left)] * [1, -1, 1]
        assert p[names.index("right" + left[4:])] == pytest.approx(mirrored, abs=1e-4), left


def test_it_stands_facing_x_with_its_left_at_y_and_its_knees_bend_backwards_under_it():
    s = G1.skeleton
    rest = dict(zip(s.names, s.rest_positions, strict=True))
    assert rest["left_toe"][0] > rest["left_heel"][0] + 0.15
    assert rest["left_hand"][1] > 0.1 > -0.1 > rest["right_hand"][1]
    assert rest["left_toe"][2] == pytest.approx(-0.793, abs=0.005)
    assert 0.4 < rest["head"][2] < 0.55
    bent = pose(np.eye(29)[[3]]).positions[0]
    assert bent[s.names.index("left_toe")][0] < rest["left_toe"][0] - 0.2


def test_the_robot_with_23_joints_holds_the_six_others_at_zero():
    motion = pose(np.full((2, 23), 0.1))
    angles = dict(zip(G1.names, g1_angles(motion, "it")[1], strict=True))
    assert {name for name, angle in angles.items() if abs(angle) < 1e-12} == set(G1.names) - set(G1_23)
    assert len(G1_23) == 23
    assert angles["right_wrist_roll_joint"] == pytest.approx(0.1)


@pytest.mark.parametrize("joints", [0, 22, 28, 30])
def test_other_numbers_of_joints_are_refused(joints):
    with pytest.raises(FormatError, match="29 joints"):
        pose(np.zeros((2, joints)))


@pytest.mark.parametrize("value", [np.nan, np.inf, -1e300])
def test_what_no_robot_can_do_is_refused_with_its_frame(value):
    angles, path = np.zeros((4, 29)), np.zeros((4, 3))
    angles[2, 5] = path[1, 1] = value
    with pytest.raises(FormatError, match="frame 2 has a joint angle that no robot can have"):
        pose(angles)
    with pytest.raises(FormatError, match=r"a\.csv: frame 1 has a root position"):
        g1_motion(path, np.tile(rot.IDENTITY, (4, 1)), np.zeros((4, 29)), 30, label="a.csv")


def test_quaternions_become_of_unit_length_but_rounded_ones_stay_as_they_are():
    rounded = np.array([[0.736459, -0.029246, 0.041564, -0.674571]])
    assert unit_quaternions(rounded, "a").tolist() == rounded.tolist()
    assert np.linalg.norm(unit_quaternions(rounded.round(3), "a")) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("bad", [[0, 0, 0, 0], [1, 1, 0, 0], [0.9, 0, 0, 0], [np.nan, 0, 0, 1], [1e200, 0, 0, 0]])
def test_what_is_no_rotation_is_refused_with_its_frame(bad):
    with pytest.raises(FormatError, match="frame 1 has a root quaternion of length"):
        unit_quaternions(np.array([[1, 0, 0, 0], bad]), "a")


def test_a_human_motion_has_to_be_retargeted_first(swinger):
    with pytest.raises(FormatError, match=r"Unitree G1 .* no joint .*Retarget it to that robot"):
        g1_angles(swinger, "a file")
