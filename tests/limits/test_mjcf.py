"""What MuJoCo 4.0 makes of the same models was compared once; the figures here are its own."""

import math
from xml.etree.ElementTree import Element

import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model, limits_of
from onbeat.limits.mjcf import mjcf_model
from onbeat.limits.plain_xml import parse_xml

DEFAULTS = """<default><joint damping="1" range="-5 5"/>
  <default class="arm"><joint range="-90 45"/>
    <default class="small"><joint damping="2"/></default>
    <default class="slider"><joint type="slide" range="-0.1 0.2"/></default>
  </default></default>"""


def parse(text: str) -> Element:
    return parse_xml(text.encode(), "bot.xml", "an MJCF")


def read(inside: str, compiler: str = "", **files: str) -> Model:
    root = parse(f'<mujoco model="bot"><compiler {compiler}/>{inside}</mujoco>')
    return mjcf_model(root, "bot.xml", lambda name: parse(f"<mujocoinclude>{files[name]}</mujocoinclude>"))


def world(joints: str, body: str = "") -> str:
    return f"<worldbody><body {body}>{joints}</body></worldbody>"


def ranges(model: Model) -> dict[str, tuple[float, float]]:
    limits = limits_of("bot", model.joints, "")
    return dict(zip(limits.joints, zip(limits.low.tolist(), limits.high.tolist(), strict=True), strict=True))


DEGREE = math.pi / 180


def test_degrees_unless_told():
    joints = world('<joint name="a" range="-90 45"/><joint name="b" type="slide" range="-1 2"/>')
    assert ranges(read(joints))["a"] == pytest.approx((-90 * DEGREE, 45 * DEGREE))
    assert ranges(read(joints))["b"] == (-1, 2)
    assert ranges(read(joints, 'angle="radian"'))["a"] == (-90, 45)


def test_speeds_are_not_told():
    assert "speed" not in read(world('<joint name="a" range="-1 1"/>')).joints["a"]


def test_classes_give_what_a_joint_does_not_say():
    inside = """<worldbody><body childclass="arm">
      <joint name="plain"/><joint name="own" range="-10 20"/>
      <body><joint name="inner" class="small"/><joint name="off" limited="false"/>
        <frame childclass="slider"><body><joint name="slides"/>
          <body childclass="main"><joint name="outermost"/></body></body></frame>
        <body><joint name="round" type="ball" range="0 40"/></body>
      </body></body></worldbody>"""
    found = ranges(read(DEFAULTS + inside))
    assert list(found) == ["plain", "own", "inner", "off", "slides", "outermost"]
    assert found["plain"] == found["inner"] == pytest.approx((-90 * DEGREE, 45 * DEGREE))
    assert found["own"] == pytest.approx((-10 * DEGREE, 20 * DEGREE))
    assert found["off"] == (-math.inf, math.inf)
    assert found["slides"] == (-0.1, 0.2)
    assert found["outermost"] == pytest.approx((-5 * DEGREE, 5 * DEGREE))


def test_the_outermost_class_may_have_a_name():
    named = '<default class="all"><joint range="-5 5"/></default>'
    found = ranges(read(named + world('<joint name="a" class="all"/><joint name="b"/>')))
    assert found["a"] == found["b"] == pytest.approx((-5 * DEGREE, 5 * DEGREE))


def test_whether_a_range_counts():
    joints = world('<joint name="a" range="-1 1" limited="true"/><joint name="b" range="-1 1" limited="false"/>')
    assert np.isfinite(ranges(read(joints, 'autolimits="false"'))["a"]).all()
    assert np.isinf(ranges(read(joints))["b"]).all()
    with pytest.raises(LimitError, match=r'joint c: a range found, but not whether it counts: .*limited="true"'):
        read(world('<joint name="c" range="-1 1"/>'), 'autolimits="false"')


def test_includes_are_read_where_they_stand():
    inside = '<include file="classes"/>' + world('<joint name="a"/><include file="hand"/>', 'childclass="arm"')
    model = read(inside, classes=DEFAULTS, hand='<body><joint name="b"/><include file="tip"/></body>', tip="<joint/>")
    assert list(ranges(model)) == ["a", "b"]
    assert ranges(model)["b"] == pytest.approx((-90 * DEGREE, 45 * DEGREE))
    assert model.left_out == "without 1 joints that have no name"


def test_a_file_is_included_once():
    with pytest.raises(LimitError, match=r"bot\.xml includes 'a' twice"):
        read('<include file="a"/>', a='<include file="a"/>')


def test_free_joints_and_those_of_other_sections_are_none():
    model = read(
        world('<freejoint/><joint name="root" type="free"/><joint name="a" range="-1 1"/>')
        + '<equality><joint joint1="a" joint2="b"/></equality><actuator><motor joint="a"/></actuator>'
    )
    assert list(model.joints) == ["a"]


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        (world('<joint name="a" class="arms"/>'), "joint a: no default class 'arms' is there"),
        (world('<joint name="a"/>', 'childclass="legs"'), "joint a: no default class 'legs'"),
        (world('<joint name="a" type="wobbly"/>'), "joint a: type 'wobbly' found; one of hinge, slide, ball, free"),
        (world('<joint name="a" range="1"/>'), "joint a: a range of two numbers is expected, '1' found"),
        (world('<joint name="a" range="1 b"/>'), "joint a: range: a number is expected, 'b' found"),
        (world('<joint name="a" limited="true"/>'), "joint a: a range of two numbers is expected, '' found"),
        (world('<joint name="a" limited="maybe" range="1 2"/>'), "joint a: limited 'maybe' found"),
        (world('<joint name="a"/><joint name="a"/>'), "joint a is there more than once"),
        ("<default><default/></default>", "a <default> within another needs a class"),
    ],
)
def test_what_is_wrong_is_told(inside: str, told: str):
    with pytest.raises(LimitError, match=told):
        read(inside)
