"""Damaged robot motions: a clear refusal or a valid motion, never another exception or a warning but ours."""

import contextlib
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from fuzzing import patient
from onbeat.errors import FormatError
from onbeat.formats.gmr import gmr_motion
from onbeat.formats.rates import RateWarning
from onbeat.formats.robot_csv import is_robot_csv, read_robot_csv
from onbeat.formats.tracking import tracking_motion
from onbeat.motion.unitree_g1 import G1, G1_23

FRAME = ",".join(["0.1", "0.2", "0.8", "0", "0", "0.6", "0.8", *["0.05"] * 29])
HEADER = ",".join(["x", "y", "z", "qx", "qy", "qz", "qw", *G1.names])
TEXTS = [f"{FRAME}\n" * 3, f"{HEADER}\r\n{FRAME}\r\n{FRAME}", FRAME.rsplit(",", 6)[0] + "\n"]
WORDS = [",", "\n", "\r", ";", "\t", "nan", "-inf", "1e999", "1e-999", "\x00", '"', "٣", "é", "\u2028", "0x1p3", "1_0"]
WORDS += ["qw", "qx", "left_knee_joint", "#", "1j", "-", ".", "+", "e5", ",,,,", FRAME, HEADER, " " * 50]


@st.composite
def damaged(draw) -> str:
    """A text with a few places cut, doubled, overwritten or swapped."""
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(1, 5))):
        a = draw(st.integers(0, len(text)))
        b = min(len(text), a + draw(st.integers(0, 40)))
        middle = draw(st.sampled_from(["", text[a:b] * 2, *WORDS, str(draw(st.integers(-(10**20), 10**20)))]))
        text = text[:a] + middle + text[b:]
    return text


def check(read) -> None:
    """Nothing but a motion or a refusal; no warning of NumPy's."""
    with warnings.catch_warnings(), contextlib.suppress(FormatError):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", RateWarning)
        motion = read()
        assert np.isfinite(motion.positions).all()


@patient
@given(text=damaged())
def test_damaged_csv(tmp_path: Path, text):
    path = tmp_path / "a.csv"
    path.write_bytes(text.encode())
    check(lambda: read_robot_csv(path, 30))
    assert is_robot_csv(path) in (True, False)


@patient
@given(content=st.binary(max_size=600))
def test_bytes_that_are_no_motion(tmp_path: Path, content):
    path = tmp_path / "a.csv"
    path.write_bytes(content)
    assert not is_robot_csv(path)
    with pytest.raises(FormatError):
        read_robot_csv(path, 30)


NUMBERS = st.one_of(st.floats(width=32), st.sampled_from([0.0, 1.0, np.nan, np.inf, 1e38, -1e5]))
TYPES = st.sampled_from(
    [np.float16, np.float32, np.float64, np.longdouble, np.int8, np.uint64, np.bool_, np.complex128]
)
SHAPES = hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=6)
ODD = st.one_of(
    TYPES.flatmap(lambda kind: SHAPES.map(lambda shape: np.ones(shape, kind))),
    hnp.arrays(np.float64, SHAPES, elements=NUMBERS),
    st.sampled_from([None, "text", b"\xff", 10**400, -1, [], [[1], [1, 2]], {}, np.array(["a", "b"]), np.array(None)]),
    st.lists(NUMBERS, max_size=3),
)


@st.composite
def arrays(draw, good: dict) -> dict:
    """Arrays of a good file, of which some are missing, replaced or hold odd numbers."""
    kept = dict(good)
    for key in draw(st.lists(st.sampled_from([*good, "joint_names", "body_names"]), max_size=3)):
        change = draw(st.sampled_from(["miss", "replace", "number", "cut", "scale", "type"]))
        value = kept.get(key)
        if change == "miss":
            kept.pop(key, None)
        elif change == "replace" or not isinstance(value, np.ndarray) or not value.size:
            kept[key] = draw(ODD)
        elif change == "number" and value.dtype.kind == "f":
            kept[key] = np.array(value, np.float64)
            kept[key].flat[value.size // 2] = draw(NUMBERS)
        elif change == "cut" and value.ndim:
            kept[key] = value[: draw(st.integers(0, 3))]
        elif change == "scale" and value.dtype.kind == "f":
            with np.errstate(all="ignore"):
                kept[key] = value * draw(NUMBERS)
        elif change == "type" and value.dtype.kind == "f":
            with np.errstate(all="ignore"):
                kept[key] = value.astype(draw(TYPES))
    return kept


TURNS = np.tile([1.0, 0, 0, 0], (3, 5, 1))
TRACKING = {
    "fps": np.array([50.0]),
    "joint_pos": np.zeros((3, 29)),
    "body_pos_w": np.zeros((3, 5, 3)),
    "body_quat_w": TURNS,
}
GMR = {"fps": 30, "root_pos": np.zeros((3, 3)), "root_rot": TURNS[:, 0, ::-1], "dof_pos": np.zeros((3, len(G1_23)))}


@patient
@given(kept=arrays(TRACKING), fps=st.sampled_from([None, 30.0]))
def test_damaged_tracking_arrays(kept, fps):
    check(lambda: tracking_motion(kept, "a.npz", fps))


@patient
@given(kept=arrays(GMR), fps=st.sampled_from([None, 30.0]))
def test_damaged_gmr_arrays(kept, fps):
    check(lambda: gmr_motion(kept, "a.pkl", fps))
