"""Damaged marker files: a clear refusal or valid markers, never another exception, a hang or much memory.

``ONBEAT_FUZZ`` sets how many inputs a reader gets.
"""

import contextlib
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from c3d_files import c3d_file, parameter, record, wandering
from fuzzing import patient
from onbeat.errors import FormatError
from onbeat.formats.c3d.read import read_c3d
from onbeat.formats.c3d.write import c3d_bytes
from onbeat.formats.conventions import Convention
from onbeat.formats.lost_frames import LostFramesWarning
from onbeat.formats.trc.read import read_trc
from onbeat.formats.trc.write import trc_text
from onbeat.motion import Markers

ANALOG = [record("ANALOG", -2, b"\0"), parameter("USED", 2, 3), parameter("RATE", 2, 200.0)]
WHOLE = [c3d_file(wandering(), processor, floating) for processor in (84, 85, 86) for floating in (True, False)]
WHOLE += [c3d_file(wandering(), analog=6, others=ANALOG, changed={"ANGLES": ["M2"]})]
MARKERS = Markers(("LFHD", "LTOE", "a:b"), np.where(np.arange(45).reshape(5, 3, 3) % 7 < 6, 1.5, np.nan), 60)
WHOLE += [c3d_bytes(MARKERS, Convention("y", "m"))]
TABLES = [trc_text(MARKERS, Convention("y", "mm")), trc_text(MARKERS, Convention("z", "m")).replace("\t", " ")]
WORDS = ["\t", "\n", "\r", " ", "nan", "inf", "1e999", "1,5", "-", "\x00", "NumFrames", "Units", "X1", "é", "\u2028"]


@st.composite
def damaged_bytes(draw) -> bytes:
    """A small C3D file with a few bytes flipped, cut, doubled or put in; most hits where the structure is."""
    data = bytearray(draw(st.sampled_from(WHOLE)))
    for _ in range(draw(st.integers(1, 6))):
        last = draw(st.sampled_from([24, 530, 1100, len(data)]))
        at = draw(st.integers(0, max(0, min(last, len(data)) - 1)))
        end = min(at + draw(st.integers(0, 12)), len(data))
        match draw(st.sampled_from(["set", "set", "set", "word", "cut", "put", "end"])):
            case "set" if at < len(data):
                data[at] = draw(st.one_of(st.integers(0, 255), st.sampled_from([0, 1, 127, 128, 254, 255])))
            case "word":
                data[at:end] = draw(
                    st.sampled_from([b"\xff\xff", b"\0\0", b"\xff\x7f", b"\0\x80", b"\0\0\xc0\x7f", b"\1\0\x80\x7f"])
                )
            case "cut":
                del data[at:end]
            case "put":
                data[at:at] = draw(st.binary(max_size=8))
            case _:
                del data[at:]
    return bytes(data)


@st.composite
def damaged_text(draw) -> str:
    """A small table with a few places cut, doubled or overwritten."""
    text = draw(st.sampled_from(TABLES))
    for _ in range(draw(st.integers(1, 5))):
        a = draw(st.integers(0, len(text)))
        b = min(len(text), a + draw(st.sampled_from([0, 0, 1, 3, 40, 400])))
        put = st.sampled_from(["", text[a:b] * 2, *WORDS, str(draw(st.integers(-(10**20), 10**20)))])
        text = text[:a] + draw(put) + text[b:]
    return text


def read_or_refuse(read, path) -> None:
    with contextlib.suppress(FormatError), warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        warnings.filterwarnings("ignore", category=LostFramesWarning)
        warnings.filterwarnings("ignore", message=".*DataRate says")
        found = read(path)
        assert len(found) > 0
        assert found.positions.nbytes < 1_000_000


@patient
@given(damaged_bytes())
def test_damaged_c3d(tmp_path, data):
    (tmp_path / "t.c3d").write_bytes(data)
    read_or_refuse(read_c3d, tmp_path / "t.c3d")


@patient
@given(damaged_text())
def test_damaged_trc(tmp_path, text):
    (tmp_path / "t.trc").write_bytes(text.encode("utf-8", errors="replace"))
    read_or_refuse(read_trc, tmp_path / "t.trc")


@patient
@given(st.binary(max_size=600))
def test_bytes_that_are_no_markers(tmp_path, content):
    path = tmp_path / "t.x"
    path.write_bytes(content)
    for read in (read_c3d, read_trc):
        with pytest.raises(FormatError):
            read(path)
