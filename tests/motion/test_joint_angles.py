import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.motion.joint_angles import JointAngles

WAVE = JointAngles(("shoulder", "elbow"), np.arange(12.0).reshape(6, 2), fps=30, name="wave")


def test_time():
    assert len(WAVE) == 6
    assert WAVE.duration == pytest.approx(0.2)
    np.testing.assert_allclose(WAVE.times, np.arange(6) / 30)


def test_angles_are_kept_from_change():
    angles = np.zeros((2, 1))
    joints = JointAngles(["a"], angles, 10)
    angles[0] = 5
    assert joints.angles.tolist() == [[0], [0]]
    with pytest.raises(ValueError, match="read-only"):
        joints.angles[0] = 1


def test_joints_are_picked_in_order():
    picked = WAVE.of(["elbow", "shoulder"])
    assert picked.names == ("elbow", "shoulder")
    assert picked.angles[0].tolist() == [1, 0]
    with pytest.raises(FormatError, match="no joint knee is there; there are shoulder, elbow"):
        WAVE.of(["elbow", "knee"])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"angles": np.zeros((3, 3))}, r"the angles of 'x' have the shape \(3, 3\); \(frames, 2\) is needed"),
        ({"angles": np.zeros(3)}, r"the shape \(3,\)"),
        ({"angles": np.zeros((0, 2))}, "no frames"),
        ({"names": (), "angles": np.zeros((3, 0))}, r"the shape \(3, 0\)"),
        ({"names": ("a", "a")}, "have the joint a more than once"),
        ({"fps": 0}, "0.0 frames per second"),
        ({"fps": np.nan}, "nan frames per second"),
        ({"angles": np.array([[0, 0], [0, np.inf]])}, "not a number at frame 1, joint b"),
    ],
)
def test_what_cannot_be_is_told(change: dict, told: str):
    with pytest.raises(FormatError, match=told):
        JointAngles(**{"names": ("a", "b"), "angles": np.zeros((3, 2)), "fps": 30.0, "name": "x", **change})
