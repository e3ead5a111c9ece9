"""Damaged motion files: a clear refusal or a valid motion, never another exception."""

import contextlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fuzzing import patient
from onbeat.errors import FormatError
from onbeat.formats.acclaim.read import read_amc
from onbeat.formats.bvh.read import parse_bvh, read_bvh
from onbeat.formats.npz import read_npz
from persons import AMC, ASF, BVH

WORDS = [
    "{",
    "}",
    "ROOT",
    "JOINT",
    "End Site",
    "MOTION",
    "Frames: 9",
    "CHANNELS 3",
    "OFFSET",
    "nan",
    "1e999",
    "-",
    "\x00",
]
WORDS += [
    "root",
    "thigh",
    ":bonedata",
    ":hierarchy",
    "begin",
    "end",
    "dof rx",
    "axis 0 0 0 XZY",
    "3",
    "é",
    "\u2028",
    "٣",
]


@st.composite
def damaged(draw, text: str) -> str:
    """A text with a few places cut, doubled, overwritten or swapped."""
    for _ in range(draw(st.integers(1, 4))):
        a, b = sorted((draw(st.integers(0, len(text))), draw(st.integers(0, len(text)))))
        b = min(b, a + draw(st.integers(0, 40)))
        middle = draw(st.sampled_from(["", text[a:b] * 2, *WORDS, str(draw(st.integers(-(10**20), 10**20)))]))
        text = text[:a] + middle + text[b:]
    return text


@patient
@given(damaged(BVH))
def test_damaged_bvh(text):
    with contextlib.suppress(FormatError):
        assert len(parse_bvh(text, "a.bvh")) > 0


@patient
@given(asf=st.one_of(st.just(ASF), damaged(ASF)), amc=st.one_of(st.just(AMC), damaged(AMC)))
def test_damaged_asf_and_amc(tmp_path, asf, amc):
    (tmp_path / "a.asf").write_text(asf, encoding="utf-8", errors="replace")
    (tmp_path / "a.amc").write_text(amc, encoding="utf-8", errors="replace")
    with contextlib.suppress(FormatError):
        assert len(read_amc(tmp_path / "a.amc", 120)) > 0


@patient
@given(content=st.binary(max_size=300))
def test_bytes_that_are_no_motion(tmp_path: Path, content):
    path = tmp_path / "a.x"
    path.write_bytes(content)
    for read in (read_bvh, read_npz):
        with pytest.raises(FormatError):
            read(path)


def test_deep_hierarchies_do_not_overflow():
    depth = 3000
    joints = "".join(f"{'JOINT' if n else 'ROOT'} j{n}\n{{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n" for n in range(depth))
    text = "HIERARCHY\n" + joints + "}\n" * depth + "MOTION\nFrames: 1\nFrame Time: 0.1\n" + "0 " * depth
    assert len(parse_bvh(text, "deep.bvh").skeleton) == depth
