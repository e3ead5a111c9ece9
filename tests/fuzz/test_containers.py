"""Damaged containers of arrays: a clear refusal or a valid motion, never another exception, and nothing is executed."""

import contextlib
import functools
import io
import pickle
import warnings
import zipfile
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fuzzing import patient
from onbeat.errors import FormatError
from onbeat.formats.keyed import read_pkl
from onbeat.formats.npz import read_npz, write_npz
from onbeat.formats.rates import RateWarning
from persons import person, swinging

WORDS = [
    b"",
    b"\x00",
    b"\xff" * 8,
    b"cos\nsystem\n",
    b"R",
    b"b",
    b".",
    b"h\x00",
    b"PK\x01\x02",
    b"\x93NUMPY",
    b"<f4",
    b"|O",
]
WORDS += [
    b"(3, 2)",
    b"(99999999999,)",
    b"\x94",
    b"numpy",
    b"\x8c\x05eval0",
    b"e",
    b"t",
    b"nan",
    b"inf",
    b"-1",
    b"}",
    b"]",
]


def _zipped(arrays: dict[str, object], packed: bool) -> bytes:
    buffer = io.BytesIO()
    (np.savez_compressed if packed else np.savez)(buffer, **arrays)
    return buffer.getvalue()


@functools.cache
def containers() -> tuple[list[bytes], list[bytes]]:
    """A few small files of each kind."""
    rng = np.random.default_rng(0)
    smpl = {"smpl_poses": rng.normal(0, 0.3, (4, 72)), "smpl_trans": rng.normal(0, 1, (4, 3)), "smpl_scaling": [90.0]}
    amass = {"poses": rng.normal(0, 0.3, (3, 156)).astype("f4"), "trans": np.ones((3, 3)), "mocap_framerate": 120.0}
    turn = np.tile([0, 0, 0, 1.0], (3, 1))
    gmr = {"fps": 30, "root_pos": np.ones((3, 3)), "root_rot": turn, "dof_pos": np.zeros((3, 29)), "names": ["a", "b"]}
    pickles = [pickle.dumps(arrays, protocol) for arrays in (smpl, gmr, amass) for protocol in (0, 2, 4, 5)]
    zips = [_zipped(arrays, packed) for arrays in (smpl, gmr, amass) for packed in (False, True)]
    return zips, pickles


@st.composite
def damaged(draw, kind: int) -> bytes:
    """A file with a few places cut, doubled, overwritten, or of which a bit is turned."""
    content = draw(st.sampled_from(containers()[kind]))
    for _ in range(draw(st.integers(1, 4))):
        a = draw(st.integers(0, len(content)))
        b = min(a + draw(st.integers(0, 12)), len(content))
        other = bytes(
            255 - byte if draw(st.booleans()) else byte ^ 1 << draw(st.integers(0, 7)) for byte in content[a:b]
        )
        content = content[:a] + draw(st.sampled_from([other, content[a:b] * 2, *WORDS])) + content[b:]
    return content


def read(reader, path: Path, content: bytes) -> None:
    path.write_bytes(content)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", RateWarning)
        with contextlib.suppress(FormatError):
            assert np.isfinite(reader(path).positions).all()


@patient
@given(damaged(0))
def test_damaged_npz(tmp_path, content):
    read(read_npz, tmp_path / "a.npz", content)


@patient
@given(damaged(1))
def test_damaged_pickles(tmp_path, content):
    read(read_pkl, tmp_path / "a.pkl", content)


@patient
@given(key=st.integers(0, 8), spot=st.integers(0, 10**6), word=st.binary(min_size=1, max_size=8))
def test_damaged_arrays_in_a_good_zip(tmp_path, key, spot, word):
    """The checksum of a zip hides most damage; here it is right."""
    write_npz(swinging(person(), 2), tmp_path / "good.npz")
    with zipfile.ZipFile(tmp_path / "good.npz") as file, zipfile.ZipFile(tmp_path / "b.npz", "w") as other:
        for number, name in enumerate(file.namelist()):
            content = file.read(name)
            at = spot % len(content)
            other.writestr(name, content[:at] + word + content[at + len(word) :] if number == key else content)
    read(read_npz, tmp_path / "a.npz", (tmp_path / "b.npz").read_bytes())
