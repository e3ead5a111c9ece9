"""GMR's dictionaries: the quaternion with w last, the joints in the order of the robot's model."""

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats.gmr import gmr_arrays, gmr_motion, is_gmr
from onbeat.formats.rates import RateWarning
from onbeat.motion.unitree_g1 import G1, G1_23, g1_angles


def moves(joints: int = 29) -> dict:
    return {
        "fps": 30,
        "root_pos": np.tile([1.0, 2.0, 0.8], (4, 1)),
        "root_rot": np.tile([0.36, 0.48, 0.0, 0.8], (4, 1)),
        "dof_pos": np.arange(4)[:, None] * 0.1 + np.linspace(0, 0.05, joints),
        "local_body_pos": None,
        "link_body_list": None,
    }


def test_w_is_last_and_joints_are_in_the_models_order():
    motion = gmr_motion(moves(), "walk.pkl")
    assert motion.rotations[0, 0].tolist() == [0.8, 0.36, 0.48, 0.0]
    assert g1_angles(motion, "") == pytest.approx(moves()["dof_pos"])
    assert (motion.name, motion.fps) == ("walk", 30)
    assert gmr_motion(moves(), "walk.pkl", 60).fps == 60


def test_what_is_read_comes_back():
    again = gmr_arrays(gmr_motion(moves(), "walk.pkl"))
    assert is_gmr(again)
    for key, value in again.items():
        np.testing.assert_allclose(value, moves()[key], atol=1e-12)


def test_23_joints_are_read_and_lists_are_arrays():
    plain = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in moves(23).items()}
    angles = g1_angles(gmr_motion(plain, "a"), "")
    assert angles[:, [G1.names.index(name) for name in G1_23]] == pytest.approx(moves(23)["dof_pos"])


def test_only_a_dictionary_of_its_three_arrays_is_one():
    assert is_gmr(moves().keys())
    assert not is_gmr(["root_pos", "dof_pos", "fps"])


def test_thirty_frames_a_second_are_assumed_with_a_warning():
    with pytest.warns(RateWarning, match="30 frames a second"):
        assert gmr_motion(moves() | {"fps": None}, "a").fps == 30


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("root_pos", None, "root_pos holds no numbers"),
        ("root_pos", [[1, 2, 3], [1, 2]], "root_pos holds no numbers"),
        ("root_rot", np.zeros((4, 3)), r"root_rot has the shape \(4, 3\); \(4, 4\) is expected"),
        ("root_rot", np.zeros((4, 4)), "root quaternion of length 0"),
        ("dof_pos", np.zeros((4, 27)), "the Unitree G1 has 29 joints"),
        ("dof_pos", np.zeros((3, 29)), "dof_pos has the shape"),
        ("fps", -1, "fps is -1"),
    ],
)
def test_what_is_wrong_is_told(key, value, message):
    with pytest.raises(FormatError, match=f"walk.pkl: .*{message}"):
        gmr_motion(moves() | {key: value}, "walk.pkl")


def test_a_human_motion_is_refused(swinger):
    with pytest.raises(FormatError, match="Retarget it"):
        gmr_arrays(swinger)
