"""Damaged descriptions of robots, limits and tables of angles: a clear refusal or what is in them, nothing else."""

import contextlib
import warnings
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fuzzing import patient
from onbeat.errors import FormatError, LimitError
from onbeat.formats.joint_table import AngleWarning, is_joint_table, read_joint_table
from onbeat.limits.read import LimitWarning, read_limits

URDF = """<?xml version="1.0"?>
<robot name="bot"><link name="base"/>
<joint name="a" type="revolute"><limit lower="-1" upper="2" velocity="3"/>
<safety_controller soft_lower_limit="0"/></joint>
<joint name="b" type="continuous"><mimic joint="a"/></joint><joint name="c" type="prismatic"><limit upper="1"/></joint>
</robot>"""
MJCF = """<mujoco model="bot"><compiler angle="radian" autolimits="true"/><include file="part.xml"/>
<default><joint range="-5 5"/><default class="x"><joint type="slide" range="0 1"/></default></default>
<worldbody><body childclass="x"><joint name="a"/><frame><joint name="b" class="main" limited="true"/></frame>
<include file="a.xml"/></body></worldbody></mujoco>"""
TOML = """version = 1
name = "bot"
angles = "degrees"
model = "a.urdf"
[default]
speed = 5
[joints]
a = { position = [-90, 120], speed = inf, acceleration = 1e3, jerk = 5 }
"""
TABLE = "time,knee,hip\n" + "".join(f"{n / 50:.2f},{n / 10},-{n}e-1\n" for n in range(8))
WORDS = [
    "<",
    "/>",
    '"',
    "&a;",
    "<!DOCTYPE r>",
    "${v}",
    "nan",
    "-inf",
    "1e999",
    "\x00",
    "٣",
    "é",
    "0x1p3",
    "1_0",
    "<joint",
]
WORDS += ["[", "]", "{", "}", "=", "\n", ",", ";", "\t", "[joints]", "a.b", "inf", "'", " " * 50, "time", "x,y,z", "\r"]
WORDS += ['<include file="b"/>', '<default class="x">', "</default>", 'class="main"', "ball", "true", "false", "e5"]


@st.composite
def damaged(draw, whole: str) -> bytes:
    """A text with a few places cut, doubled, overwritten or swapped."""
    text = whole
    for _ in range(draw(st.integers(1, 5))):
        a = draw(st.integers(0, len(text)))
        b = min(len(text), a + draw(st.integers(0, 40)))
        middle = draw(st.sampled_from(["", text[a:b] * 2, *WORDS, str(draw(st.integers(-(10**20), 10**20)))]))
        text = text[:a] + middle + text[b:]
    return text.encode(draw(st.sampled_from(["utf-8", "utf-8", "utf-16"])))


def check_limits(path: Path) -> None:
    with warnings.catch_warnings(), contextlib.suppress(LimitError):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", LimitWarning)
        for soft in (False, True):
            limits = read_limits(path, soft)
            assert len(limits) > 0
            assert (limits.low < limits.high).all()
            assert (limits.speed > 0).all()


@patient
@given(content=damaged(URDF))
def test_damaged_urdf(tmp_path: Path, content: bytes):
    (tmp_path / "a.urdf").write_bytes(content)
    check_limits(tmp_path / "a.urdf")


@patient
@given(content=damaged(MJCF), part=damaged(MJCF.replace("mujoco", "mujocoinclude")))
def test_damaged_mjcf(tmp_path: Path, content: bytes, part: bytes):
    (tmp_path / "a.xml").write_bytes(content)
    (tmp_path / "part.xml").write_bytes(part)
    check_limits(tmp_path / "a.xml")


@patient
@given(content=damaged(TOML))
def test_damaged_toml(tmp_path: Path, content: bytes):
    (tmp_path / "a.urdf").write_text(URDF)
    (tmp_path / "a.toml").write_bytes(content)
    check_limits(tmp_path / "a.toml")


@patient
@given(content=damaged(TABLE))
def test_damaged_tables(tmp_path: Path, content: bytes):
    path = tmp_path / "a.csv"
    path.write_bytes(content)
    assert is_joint_table(path) in (True, False)
    with warnings.catch_warnings(), contextlib.suppress(FormatError):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", AngleWarning)
        table = read_joint_table(path)
        assert np.isfinite(table.angles).all()
        assert table.fps > 0


@patient
@given(content=st.binary(max_size=400), suffix=st.sampled_from(["urdf", "xml", "toml", "csv"]))
def test_bytes_that_are_nothing(tmp_path: Path, content: bytes, suffix: str):
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(content)
    if suffix == "csv":
        with contextlib.suppress(FormatError):
            read_joint_table(path, 30)
    else:
        check_limits(path)
