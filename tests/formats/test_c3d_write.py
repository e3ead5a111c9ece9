import struct
import warnings

import numpy as np
import pytest

from c3d_files import floats, words
from onbeat.errors import FormatError
from onbeat.formats.c3d.read import read_c3d
from onbeat.formats.c3d.write import c3d_bytes, write_c3d
from onbeat.formats.conventions import Convention
from onbeat.motion import Markers
from onbeat.motion.joint_markers import joint_markers
from persons import person, swinging


def some_markers(count: int = 3, frames: int = 5) -> Markers:
    positions = np.random.default_rng(2).normal(size=(frames, count, 3))
    positions[1, 0] = np.nan
    positions[2, 1] = 0
    return Markers([f"M{n}" for n in range(count)], positions, 59.94, "t")


def test_the_bytes_that_are_written():
    data = c3d_bytes(some_markers(), Convention("z", "mm"))
    assert data[:2] == b"\2\x50"
    assert words([3, 0, 1, 5, 0], 84) == data[2:12]
    assert floats([59.94], 84) == data[20:24]
    start = (struct.unpack("<H", data[16:18])[0] - 1) * 512
    assert data[515] == 84
    np.testing.assert_allclose(np.frombuffer(data, "<f4", 4, start + 48), [0, 0, 0, -1])
    # One analog sample for each frame of points, as readers reckon that divide the two rates.
    assert words([1], 84) == data[18:20]
    assert data == c3d_bytes(some_markers(), Convention("z", "mm"))
    assert len(data) % 512 == 0


@pytest.mark.parametrize("unit", ["mm", "cm", "m"])
@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_what_is_written_says_its_axis_and_unit(tmp_path, up, unit):
    write_c3d(some_markers(), tmp_path / "t.c3d", Convention(up, unit))
    found = read_c3d(tmp_path / "t.c3d")
    assert (found.names, found.fps) == (("M0", "M1", "M2"), 59.94)
    np.testing.assert_allclose(found.positions, some_markers().positions, atol=1e-6)


def test_many_markers_with_long_labels(tmp_path):
    names = [f"{n:03}" + "x" * 124 for n in range(600)]
    markers = Markers(names, np.ones((2, 600, 3)), 30)
    write_c3d(markers, tmp_path / "t.c3d")
    assert read_c3d(tmp_path / "t.c3d").names == tuple(names)
    with pytest.raises(FormatError, match="longer than the 127 bytes of C3D"):
        write_c3d(Markers(["y" * 128], np.ones((1, 1, 3)), 30), tmp_path / "u.c3d")
    more = Markers([f"{n:04}" + "x" * 123 for n in range(1200)], np.ones((1, 1200, 3)), 30)
    with pytest.raises(FormatError, match="C3D has 255; shorten them"):
        write_c3d(more, tmp_path / "u.c3d")
    assert not (tmp_path / "u.c3d").exists()


def test_long_takes_are_counted_in_two_words(tmp_path):
    positions = np.ones((70000, 1, 3)) * np.arange(1, 70001)[:, None, None]
    write_c3d(Markers(["M"], positions, 100), tmp_path / "t.c3d")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(read_c3d(tmp_path / "t.c3d")) == 70000


def test_units_that_others_do_not_know_and_far_markers_are_not_written(tmp_path):
    with pytest.raises(FormatError, match="mm, cm or m is expected"):
        write_c3d(some_markers(), tmp_path / "t.c3d", Convention("z", "cmu"))
    with pytest.raises(FormatError, match="too far away"):
        write_c3d(Markers(["M"], np.full((1, 1, 3), 1e36), 30), tmp_path / "t.c3d")


def test_a_body_as_markers(tmp_path):
    motion = swinging(person(), 20, 60, seed=1)
    write_c3d(joint_markers(motion), tmp_path / "t.c3d", Convention("y", "m"))
    found = read_c3d(tmp_path / "t.c3d")
    assert found.names == motion.skeleton.names
    np.testing.assert_allclose(found.positions, motion.positions, atol=1e-6)


def test_another_reader_reads_what_is_written(tmp_path):
    write_c3d(some_markers(300), tmp_path / "t.c3d")
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d(str(tmp_path / "t.c3d"))
    labels, positions = file["parameters"]["POINT"]["LABELS"]["value"], file["data"]["points"][:3].T / 1000
    assert labels[:255] == [f"M{n}" for n in range(255)]
    np.testing.assert_allclose(positions, some_markers(300).positions, atol=1e-6)
