import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats import Convention, read_motion, write_motion
from onbeat.motion import Motion
from persons import person, swinging


@pytest.mark.parametrize("moving", [False, True])
def test_every_bit_comes_back(tmp_path, moving):
    body = swinging(person(), frames=9, fps=29.97)
    if moving:
        offsets = np.tile(body.skeleton.offsets, (9, 1, 1)) * np.linspace(1, 1.1, 9)[:, None, None]
        body = Motion(body.skeleton, body.rotations, body.root_positions, body.fps, "näme", offsets)
    write_motion(body, tmp_path / "a.npz")
    again = read_motion(tmp_path / "a.npz")
    assert (again.skeleton, again.fps, again.name) == (body.skeleton, body.fps, body.name)
    np.testing.assert_array_equal(again.positions, body.positions)
    assert read_motion(tmp_path / "a.npz", fps=50).fps == 50


def test_it_has_one_convention(tmp_path):
    with pytest.raises(FormatError, match="always in metres with Z up"):
        write_motion(swinging(person()), tmp_path / "a.npz", Convention("y", "cm"))
    assert not list(tmp_path.iterdir())


def test_what_is_not_such_a_file_is_refused(tmp_path):
    path = tmp_path / "a.npz"
    for content in (b"", b"text", b"PK\x03\x04 not a zip", np.lib.format.magic(1, 0)):
        path.write_bytes(content)
        with pytest.raises(FormatError, match="cannot read"):
            read_motion(path)
    np.savez(path, names=np.array(["a"]))
    with pytest.raises(FormatError, match="version 1 of an onbeat motion is expected, None found"):
        read_motion(path)
    np.savez(path, onbeat_motion=2)
    with pytest.raises(FormatError, match="2 found"):
        read_motion(path)
    np.savez(path, onbeat_motion=1, names=np.array(["a"]))
    with pytest.raises(FormatError, match="not a whole motion"):
        read_motion(path)


def test_nothing_is_unpickled(tmp_path):
    np.savez(tmp_path / "a.npz", onbeat_motion=1, names=np.array([print], dtype=object))
    with pytest.raises(FormatError, match="cannot read"):
        read_motion(tmp_path / "a.npz")
