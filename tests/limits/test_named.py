"""The built-in robots: what their tables say is what the public descriptions say."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.named import robot_limits, robot_names
from onbeat.limits.read import read_limits
from onbeat.motion.unitree_g1 import G1

DESCRIPTIONS = {
    "g1": "unitree_g1/g1_29dof_rev_1_0.urdf",
    "h1": "unitree_h1/h1.urdf",
    "nao": "nao_pepper/nao_V50.urdf",
    "talos": "pal_talos/talos_full_v2.urdf",
}


def test_the_robots_there_are():
    assert robot_names() == ("g1", "h1", "hrp4c", "nao", "talos")
    assert [len(robot_limits(name)) for name in robot_names()] == [29, 19, 32, 25, 32]


@pytest.mark.parametrize("name", robot_names())
def test_every_robot_is_limited_and_has_its_source(name: str):
    limits = robot_limits(name)
    for values in (limits.low, limits.high, limits.speed):
        assert np.isfinite(values).all()
    assert (limits.high - limits.low).max() < 2 * np.pi
    assert (limits.speed < 40).all()
    assert re.search(r"(urdf|body) of .*\(.+\)$", limits.source)


@pytest.mark.parametrize("name", robot_names())
def test_left_and_right_are_mirror_images(name: str):
    limits, pairs = robot_limits(name), 0
    for n, joint in enumerate(limits.joints):
        other = re.sub(r"(?<![A-Za-z])left(?![A-Za-z])", "right", joint)
        other = re.sub(r"^L(?=_|[A-Z])", "R", other)
        if other == joint or other not in limits.joints:
            continue
        m = limits.joints.index(other)
        pairs += 1
        assert limits.speed[n] == limits.speed[m], joint
        mine, theirs = (limits.low[n], limits.high[n]), (limits.low[m], limits.high[m])
        near = 0.011  # rad: one ankle of NAO's
        assert mine == pytest.approx(theirs, abs=near) or mine == pytest.approx((-theirs[1], -theirs[0]), abs=near)
    assert pairs >= 8


def test_the_g1_is_that_of_the_motions():
    limits = robot_limits("g1")
    assert limits.joints == G1.names
    for key in ("low", "high", "speed"):
        np.testing.assert_array_equal(getattr(limits, key), getattr(G1, key))


@pytest.mark.parametrize("asked", ["G1", " g1 ", "HRP-4C", "hrp_4c"])
def test_names_may_be_written_otherwise(asked: str):
    assert robot_limits(asked) is not None


def test_an_unknown_robot_is_refused():
    with pytest.raises(
        LimitError, match=r"no robot 'talo' is known \(is it talos\?\); there are g1, h1, .* give a file"
    ):
        robot_limits("talo")
    for name in ("", "../limits", "g1.toml", "\x00", "x" * 10_000):
        with pytest.raises(LimitError, match=r"no robot .{0,70} is known"):
            robot_limits(name)


@pytest.mark.parametrize("name", DESCRIPTIONS)
def test_tables_are_as_the_descriptions_have_it(name: str, data: Path):
    table, described = robot_limits(name), read_limits(data / "robots" / DESCRIPTIONS[name])
    assert set(table.joints) == set(described.joints)
    described = described.of(table.joints)
    for key in ("low", "high", "speed"):
        np.testing.assert_allclose(getattr(table, key), getattr(described, key), rtol=0, atol=5e-7)


def test_naos_of_the_fourth_version_can_do_the_same(data: Path):
    old = read_limits(data / "robots/nao_pepper/nao_V40.urdf").of(robot_limits("nao").joints)
    for key in ("low", "high", "speed"):
        np.testing.assert_array_equal(getattr(robot_limits("nao"), key), getattr(old, key))


def body_file(path: Path) -> dict[str, tuple[list[float], list[float]]]:
    """Name, range and velocity range in degrees of each joint of a Choreonoid body."""
    links = re.split(r"^  -\n", path.read_text(encoding="utf-8").partition("\nlinks:")[2], flags=re.MULTILINE)
    found = {}
    for link in links:
        name = re.search(r"^    name: (\w+)", link, re.MULTILINE)
        ranges = [
            re.search(rf"^    {key}: \[ *(\S+), *(\S+) *\]", link, re.MULTILINE)
            for key in ("joint_range", "joint_velocity_range")
        ]
        if name and all(ranges):
            found[name[1]] = tuple([float(one[1]), float(one[2])] for one in ranges)
    return found


def test_hrp4c_is_as_its_body_has_it(data: Path):
    body, table = body_file(data / "hrp4c_dance/HRP4C.body"), robot_limits("hrp4c")
    assert set(body) == set(table.joints)
    for n, joint in enumerate(table.joints):
        (low, high), (slow, fast) = body[joint]
        speed = 120 if joint == "L_ELBOW_P" else min(-slow, fast)  # −20 to 120 there, −120 to 120 on the right
        assert (low, high, speed) == pytest.approx(
            tuple(math.degrees(v[n]) for v in (table.low, table.high, table.speed)), abs=1e-9
        )


def test_hrp4cs_body_is_near_its_urdf(data: Path):
    urdf, table = read_limits(data / "robots/hrp4c/HRP4Cmain.urdf"), robot_limits("hrp4c")
    both = [joint for joint in table.joints if joint in urdf.joints]
    assert set(table.joints) - set(both) == {"L_TOE_P", "R_TOE_P"}
    mine, theirs = table.of(both), urdf.of(both)
    assert np.degrees(np.abs(mine.low - theirs.low)).max() < 2
    assert np.degrees(np.abs(mine.high - theirs.high)).max() < 2
    assert np.abs(mine.speed / theirs.speed - 1).max() < 0.005
