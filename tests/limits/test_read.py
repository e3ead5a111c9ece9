import warnings
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import LimitError
from onbeat.limits.read import LimitWarning, read_limits
from onbeat.motion.unitree_g1 import G1

URDF = """<robot name="bot"><joint name="a" type="revolute">
<limit lower="-1" upper="2" velocity="3"/><safety_controller soft_lower_limit="-0.5"/></joint></robot>"""
MJCF = """<mujoco model="mbot"><compiler angle="radian"/><include file="parts/classes.xml"/>
<worldbody><body><joint name="a" class="x"/><joint name="b" range="0 1"/></body></worldbody></mujoco>"""
CLASSES = '<mujocoinclude><default><default class="x"><joint range="-1 2"/></default></default></mujocoinclude>'


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def mjcf(tmp_path: Path) -> Path:
    write(tmp_path / "parts" / "classes.xml", CLASSES)
    return write(tmp_path / "bot.xml", MJCF)


def test_a_urdf(tmp_path: Path):
    limits = read_limits(write(tmp_path / "bot.urdf", URDF))
    assert (limits.name, limits.joints, limits.source) == ("bot", ("a",), "bot.urdf")
    assert limits.speed.tolist() == [3]
    assert read_limits(tmp_path / "bot.urdf", soft=True).low.tolist() == [-0.5]


def test_an_mjcf_warns_that_speeds_are_not_told(mjcf: Path):
    with pytest.warns(LimitWarning, match='does not tell how fast a, b may be.*lines: model = "bot.xml", .default'):
        limits = read_limits(mjcf)
    assert (limits.name, limits.joints) == ("mbot", ("a", "b"))
    assert limits.low.tolist() == [-1, 0]
    assert np.isinf(limits.speed).all()


def test_a_table_tells_what_an_mjcf_does_not(mjcf: Path, tmp_path: Path):
    table = write(tmp_path / "bot.toml", 'model = "bot.xml"\r\n[default]\r\nspeed = 5\r\n[joints]\r\nb = { speed = 7 }')
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        limits = read_limits(table)
    assert limits.speed.tolist() == [5, 7]
    assert limits.high.tolist() == [2, 1]


def test_a_table_that_leaves_a_speed_open_is_refused(mjcf: Path, tmp_path: Path):
    with pytest.raises(LimitError, match="no speed is told for a, b"):
        read_limits(write(tmp_path / "bot.toml", 'model = "bot.xml"'))


def test_soft_limits_by_a_table(tmp_path: Path):
    write(tmp_path / "bot.urdf", URDF)
    assert read_limits(write(tmp_path / "a.toml", 'model = "bot.urdf"')).low.tolist() == [-1]
    assert read_limits(tmp_path / "a.toml", soft=True).low.tolist() == [-0.5]
    assert read_limits(write(tmp_path / "b.toml", 'model = "bot.urdf"\nsoft = true')).low.tolist() == [-0.5]


def test_a_mark_at_the_beginning_is_no_harm(tmp_path: Path):
    (tmp_path / "a.toml").write_bytes(b"\xef\xbb\xbfjoints.a.speed = 3\r\n")
    assert read_limits(tmp_path / "a.toml").name == "a"


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.urdf", "", "is no XML"),
        ("a.urdf", "<sdf/>", r"<sdf> found; a URDF \(<robot>\) or an MJCF \(<mujoco>\) is expected"),
        ("a.urdf", '<robot name="a"/>', "no joint that turns or slides found"),
        ("a.xml", "<mujoco/>", "no joint that turns or slides found"),
        ("a.xml", '<mujoco><include file="none.xml"/></mujoco>', "cannot read .*none.xml"),
        ("a.urdf", URDF.replace('"2"', '"-2"'), r"a\.urdf: bot: a has a range of its angle of -1 … -2"),
        ("a.urdf", URDF.replace('"3"', '"-3"'), "a has a limit of its speed of -3"),
        ("a.toml", 'model = "none.urdf"', "cannot read .*none.urdf"),
        ("a.toml", 'model = "a.toml"', "is no XML"),
        ("a.toml", 'model = "a\\u0000b"', "cannot read"),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, name: str, text: str, told: str):
    with pytest.raises(LimitError, match=told):
        read_limits(write(tmp_path / name, text))


def test_files_that_are_none(tmp_path: Path):
    for name in ("none.urdf", "none.toml"):
        with pytest.raises(LimitError, match=r"cannot read .*none\.\w+: No such file"):
            read_limits(tmp_path / name)
    (tmp_path / "a.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(LimitError, match="is not UTF-8 text"):
        read_limits(tmp_path / "a.toml")


@pytest.mark.parametrize("name", ["g1_29dof_rev_1_0.xml", "g1_mjlab.xml"])
def test_models_of_the_g1_agree_with_its_urdf(name: str, data: Path):
    with pytest.warns(LimitWarning):
        limits = read_limits(data / "robots" / "unitree_g1" / name)
    assert limits.joints == G1.names
    np.testing.assert_allclose(limits.low, G1.low, atol=5e-6)
    np.testing.assert_allclose(limits.high, G1.high, atol=5e-6)


def test_every_description_at_hand_is_read(data: Path):
    files = sorted((data / "robots").glob("*/*.urdf"))
    assert files
    assert all(len(read_limits(file)) > 10 for file in files)
