import math

import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.joint_limit import Model
from onbeat.limits.toml_table import limits_from_toml

ROBOT = Model("bot", {"knee": {"low": 0.0, "high": 2.0}, "hip": {"low": -1.0, "high": 1.0, "speed": 6.0}})


def read(text: str, model: Model | None = None):
    return limits_from_toml(text, "arm.toml", "arm", (lambda name, soft: model) if model else _none)


def _none(name: str, soft: bool) -> Model:
    raise AssertionError("no model is asked for")


def test_a_whole_table():
    limits = read(
        """
        version = 1
        name = "my arm"
        source = "data sheet"
        licence = "CC0"
        angles = "degrees"
        [default]
        acceleration = 1000
        [joints]
        shoulder = { position = [-90, 120], speed = 180 }
        "elbow.1" = { position = [-inf, inf], speed = inf, acceleration = 2000, jerk = 50000 }
        wrist = { speed = 300 }
        """
    )
    assert limits.name == "my arm"
    assert limits.joints == ("shoulder", "elbow.1", "wrist")
    assert limits.source == "data sheet (CC0)"
    np.testing.assert_allclose(limits.low, [-math.pi / 2, -np.inf, -np.inf])
    np.testing.assert_allclose(limits.high, [math.pi * 2 / 3, np.inf, np.inf])
    np.testing.assert_allclose(limits.speed, [math.pi, np.inf, math.pi * 5 / 3])
    np.testing.assert_allclose(limits.acceleration, np.radians([1000, 2000, 1000]))
    np.testing.assert_allclose(limits.jerk, [np.inf, np.radians(50000), np.inf])


def test_radians_unless_told_and_the_files_name():
    limits = read("joints.a = { position = [-1, 2.5], speed = 3 }")
    assert (limits.name, limits.source) == ("arm", "arm.toml")
    assert (limits.low[0], limits.high[0], limits.speed[0]) == (-1, 2.5, 3)


def test_own_lines_before_the_model_before_the_default():
    limits = read('model = "bot.xml"\n[default]\nspeed = 5\njerk = 9\n[joints]\nhip = { position = [-2, 0] }', ROBOT)
    assert limits.joints == ("knee", "hip")
    assert limits.speed.tolist() == [5, 6]
    assert limits.low.tolist() == [0, -2]
    assert limits.high.tolist() == [2, 0]
    assert limits.jerk.tolist() == [9, 9]
    assert limits.source == "arm.toml and bot.xml"


def test_a_joint_that_the_model_does_not_have_is_a_slip():
    with pytest.raises(LimitError, match=r"kneee: the model has no such joint \(is it knee\?\); it has knee, hip"):
        read('model = "bot.xml"\ndefault.speed = 1\njoints.kneee.speed = 2', ROBOT)


def test_what_the_model_left_out_is_told():
    model = ROBOT._replace(left_out="without 2 joints that follow others")
    assert "without 2 joints" in read('model = "bot.xml"\ndefault.speed = 1', model).source


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "has limits of no joint; a table \\[joints\\] is expected"),
        ("[joints]", "has limits of no joint"),
        ("joints", "is no TOML"),
        ("[joints]\na b = 1", "is no TOML: .*names with dots or spaces need quotes"),
        ("joints = 3", "joints: a table is expected, 3 found"),
        ("joints.a = 3", "a: a table is expected, 3 found"),
        ("joints.a.velocity = 3", r"a: velocity: no such key; there are position, .*a velocity is a speed here"),
        ("joints.a.b.speed = 3", "a: b: no such key"),
        ("joints.a = {}", r"no speed is told for a; give them one, or all of them by \[default\]"),
        ('joints.a.speed = "3"', "a: speed: a number is expected, .* '3' found"),
        ("joints.a.speed = true", "a: speed: a number is expected, .* True found"),
        ("joints.a.speed = nan", "a: speed: a number is expected, .* nan found"),
        ("joints.a.speed = -1", "arm: a has a limit of its speed of -1; a number above 0"),
        ("joints.a.speed = 0", "arm: a has a limit of its speed of 0"),
        ("joints.a = { speed = 1, position = 3 }", r"a: position: \[low, high\] is expected, 3 found"),
        ("joints.a = { speed = 1, position = [1] }", r"a: position: \[low, high\] is expected, \[1\] found"),
        ("joints.a = { speed = 1, position = [1, 2, 3] }", "a: position: "),
        ("joints.a = { speed = 1, position = [2, 1] }", "a has a range of its angle of 2 … 1"),
        ("joints.a = { speed = 1, position = [[], 1] }", r"a: position: a number is expected, .* \[\] found"),
        ("version = 2\njoints.a.speed = 1", "version 2 found; this onbeat reads version 1"),
        ("version = true\njoints.a.speed = 1", "version True found"),
        ('angles = "turns"\njoints.a.speed = 1', "angles: radians or degrees is expected, 'turns' found"),
        ("angles = 3\njoints.a.speed = 1", "angles: a text in quotes is expected, 3 found"),
        ("name = 3\njoints.a.speed = 1", "name: a text in quotes is expected"),
        ('soft = "yes"\njoints.a.speed = 1', "soft: true or false is expected"),
        ("speeds = 3", "speeds: no such key; there are version, name"),
        ("default.position = [0, 1]\njoints.a.speed = 1", r"\[default\]: position: no such key"),
        (f"joints.a.speed = {'9' * 400}", "a: speed: a number is expected"),
        (f"joints.a.speed = {'9' * 9000}", "is no TOML"),
        ("joints.a.speed = " + "[" * 3000, "is no TOML"),
        ("model = 3", "model: a text in quotes is expected"),
    ],
)
def test_what_is_wrong_is_told(text: str, told: str):
    with pytest.raises(LimitError, match=rf"^arm\.toml.*{told}") as caught:
        read(text)
    assert len(str(caught.value)) < 400


def test_a_text_of_no_file_has_no_model():
    with pytest.raises(LimitError, match="in no file"):
        limits_from_toml('model = "a.urdf"', "a table", "a")
