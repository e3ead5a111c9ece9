import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import limits_of
from onbeat.limits.plain_xml import parse_xml
from onbeat.limits.urdf import urdf_model

LIMIT = '<limit lower="-1" upper="2" velocity="3" effort="9"/>'


def read(joints: str, soft: bool = False):
    root = parse_xml(f'<robot name="bot"><link name="base"/>{joints}</robot>'.encode(), "bot.urdf", "a URDF")
    return urdf_model(root, "bot.urdf", soft)


def joint(name: str = "a", kind: str = "revolute", inside: str = LIMIT) -> str:
    return f'<joint name="{name}" type="{kind}">{inside}</joint>'


def test_joints_that_move_are_taken_in_their_order():
    model = read(
        joint("b")
        + joint("turns", "continuous", '<limit velocity="5" effort="1"/>')
        + joint("slides", "prismatic", '<limit lower="0" upper="0.1" velocity="0.2"/>')
        + joint("weld", "fixed", "")
        + joint("base", "floating", "")
        + joint("free", "continuous", "")
    )
    limits = limits_of(model.name, model.joints, "")
    assert limits.name == "bot"
    assert limits.joints == ("b", "turns", "slides", "free")
    assert limits.low.tolist() == [-1, -np.inf, 0, -np.inf]
    assert limits.high.tolist() == [2, np.inf, 0.1, np.inf]
    assert limits.speed.tolist() == [3, 5, 0.2, np.inf]
    assert not model.left_out


def test_joints_that_follow_or_are_held_are_left_out_and_told():
    follows = joint("b", inside=LIMIT + '<mimic joint="a"/>')
    held = joint("c", inside='<limit lower="0.5" upper="0.5" velocity="1"/>')
    model = read(joint() + follows + follows.replace('"b"', '"d"') + held)
    assert tuple(model.joints) == ("a",)
    assert model.left_out == "without 2 joints that follow others and 1 joints that are held"


def test_a_velocity_of_zero_is_not_told():
    model = read(joint(inside='<limit lower="-1" upper="2" velocity="0"/>') + joint("b", inside=LIMIT))
    assert "speed" not in model.joints["a"]
    assert model.joints["b"]["speed"] == 3


def test_limits_that_are_not_written_are_zero():
    assert read(joint(inside='<limit upper="2" velocity="1"/>')).joints["a"] == {"low": 0, "high": 2, "speed": 1}


def test_soft_limits_where_asked_for_and_narrower():
    inside = LIMIT + '<safety_controller soft_lower_limit="-0.5" soft_upper_limit="7" k_velocity="1"/>'
    assert read(joint(inside=inside)).joints["a"]["low"] == -1
    soft = read(joint(inside=inside), soft=True).joints["a"]
    assert (soft["low"], soft["high"]) == (-0.5, 2)
    bare = read(joint(inside=LIMIT + "<safety_controller/>"), soft=True).joints["a"]
    assert (bare["low"], bare["high"]) == (-1, 2)


def test_joints_of_transmissions_are_no_joints():
    assert tuple(read(joint() + '<transmission><joint name="a"/></transmission>').joints) == ("a",)


@pytest.mark.parametrize(
    ("joints", "told"),
    [
        (joint(inside=""), "joint a: a revolute joint needs a <limit lower= upper= velocity=>, none found"),
        (joint(kind="wobbly"), "joint a: type 'wobbly' found; one of revolute, continuous, prismatic"),
        ('<joint name="a"/>', "joint a: type '' found"),
        ('<joint type="revolute"/>', "a joint without a name found"),
        (joint() + joint(), "joint a is there more than once"),
        (
            joint(inside='<limit lower="low" upper="2" velocity="1"/>'),
            "joint a: lower: a number is expected, 'low' found",
        ),
        (joint(inside='<limit velocity="${v}"/>'), r"velocity: a number is expected, '\${v}' found; run xacro"),
        (joint() + '<xacro:macro name="arm"/>', "bot.urdf is a xacro"),
    ],
)
def test_what_is_wrong_is_told(joints: str, told: str):
    with pytest.raises(LimitError, match=told):
        read(joints)
