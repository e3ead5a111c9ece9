import json
import pickle

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats import Convention, read_motion, write_motion
from onbeat.formats.keyed import is_pkl
from onbeat.formats.npz import is_npz, read_npz
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
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


def test_the_same_motion_is_the_same_bytes(tmp_path):
    for name in ("a.npz", "b.npz"):
        write_motion(swinging(person()), tmp_path / name)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_roles_that_are_told_are_kept(tmp_path):
    bare = Skeleton(("a", "b"), [-1, 0], [[0, 0, 0], [0, 0, 1]], roles={"hips": "a", "head": "b"})
    motion = Motion(bare, np.tile(rot.IDENTITY, (2, 2, 1)), np.zeros((2, 3)), 30)
    write_motion(motion, tmp_path / "a.npz")
    assert dict(read_motion(tmp_path / "a.npz").skeleton.roles) == {"hips": "a", "head": "b"}
    with np.load(tmp_path / "a.npz") as file:
        assert json.loads(str(file["roles"])) == {"hips": "a", "head": "b"}
    write_motion(swinging(person()), tmp_path / "b.npz")
    with np.load(tmp_path / "b.npz") as file:
        assert "roles" not in file.files


def own(**changed: object) -> dict[str, object]:
    """The arrays of a small motion of our own, some changed; None leaves one out."""
    arrays: dict[str, object] = {
        "onbeat_motion": 1,
        "names": np.array(["a", "b"]),
        "parents": np.array([-1, 0]),
        "offsets": np.array([[0, 0, 0], [0, 0, 1.0]]),
        "end_sites": np.array([False, True]),
        "rotations": np.tile([1.0, 0, 0, 0], (3, 2, 1)),
        "root_positions": np.zeros((3, 3)),
        "fps": 30.0,
        "name": np.array("x"),
    }
    return {key: value for key, value in (arrays | changed).items() if value is not None}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"onbeat_motion": 2}, "version 1 of an onbeat motion is expected, 2 found"),
        ({"onbeat_motion": "1"}, "version 1 of an onbeat motion is expected"),
        ({"rotations": None}, "'rotations' is missing"),
        ({"rotations": np.full((3, 2, 4), 0.5001)}, None),
        ({"rotations": np.full((3, 2, 4), 0.51)}, "joint 0 at frame 0 is .*; unit quaternions wxyz are expected"),
        ({"rotations": np.zeros((3, 2, 4))}, "unit quaternions"),
        ({"rotations": np.full((3, 2, 4), 1e300)}, "unit quaternions"),
        ({"rotations": np.full((3, 2, 4), np.nan)}, "'rotations' has a value that is not a number at .0, 0, 0"),
        ({"rotations": np.ones((3, 2, 3))}, "rotations of shape"),
        ({"rotations": np.ones((0, 2, 4))}, "no frames"),
        ({"root_positions": np.zeros((2, 3))}, "root positions of shape"),
        ({"names": np.array([1, 2])}, "'names' of type int64 .*; text is expected"),
        ({"names": np.array(["a", "a"])}, "joint names occur twice"),
        ({"parents": np.array([-1, np.nan])}, "'parents' of type float64; whole numbers"),
        ({"parents": np.array([0, -1])}, "not one tree"),
        ({"end_sites": np.array([1, 2])}, "'end_sites' of type int64; booleans"),
        ({"fps": np.inf}, "not a number"),
        ({"fps": -1.0}, "positive rate"),
        ({"fps": np.ones(3)}, "not a whole motion"),
        ({"roles": np.array("[1]")}, "'roles' are '.1.'; a JSON object"),
        ({"roles": np.array("[" * 90_000)}, "a JSON object"),
        ({"roles": np.array('{"hips": "nobody"}')}, "nobody"),
    ],
)
def test_what_is_no_whole_motion_is_refused(tmp_path, changed, words):
    np.savez(tmp_path / "a.npz", **own(**changed))
    if words is None:
        lengths = np.linalg.norm(read_npz(tmp_path / "a.npz").rotations, axis=-1)
        assert np.abs(lengths - 1).max() < 1e-12
        return
    with pytest.raises(FormatError, match=words):
        read_npz(tmp_path / "a.npz")


def test_quaternions_that_are_no_rotations_are_not_written(tmp_path):
    body = person()
    with pytest.raises(FormatError, match="unit quaternions"):
        write_motion(Motion(body, np.full((2, len(body), 4), 0.6), np.zeros((2, 3)), 30), tmp_path / "a.npz")


def test_unknown_kinds_are_told_what_is_known(tmp_path):
    np.savez(tmp_path / "a.npz", left=np.ones(2), right=np.ones(2))
    with pytest.raises(FormatError, match="arrays called 'left', 'right' found; known are onbeat's own; SMPL, AMASS"):
        read_motion(tmp_path / "a.npz")
    np.savez(tmp_path / "a.npz", **{f"array {n}": 1 for n in range(30)})
    with pytest.raises(FormatError, match="'array 11', … found"):
        read_motion(tmp_path / "a.npz")


def test_robots_have_their_axes(tmp_path):
    np.savez(tmp_path / "a.npz", root_pos=np.zeros((2, 3)), root_rot=np.zeros((2, 4)), dof_pos=np.zeros((2, 29)))
    with pytest.raises(FormatError, match="in metres with Z up; leave the axis"):
        read_npz(tmp_path / "a.npz", up="y")


def test_what_is_not_such_a_file_is_refused(tmp_path):
    path = tmp_path / "a.npz"
    for content in (b"", b"text", b"PK\x03\x04 not a zip", np.lib.format.magic(1, 0)):
        path.write_bytes(content)
        with pytest.raises(FormatError, match="cannot read"):
            read_motion(path)


def test_nothing_is_unpickled(tmp_path):
    np.savez(tmp_path / "a.npz", **own(names=np.array([print], dtype=object)))
    with pytest.raises(FormatError, match="'names' holds Python objects, which are not read, and nothing was executed"):
        read_motion(tmp_path / "a.npz")


def test_motion_is_told_from_other_files_of_a_folder(tmp_path):
    path = tmp_path / "a.npz"
    np.savez(path, betas=np.zeros(16))
    assert not is_npz(path)
    np.savez(path, poses=np.zeros((2, 72)), trans=np.zeros((2, 3)), objects=np.array([None]))
    assert is_npz(path)
    np.savez(path, **own())
    assert is_npz(path)
    path.write_bytes(b"damaged")
    assert is_npz(path)
    smpl = {"poses": np.zeros((2, 72)), "trans": np.zeros((2, 3))}
    for given, motion in ((smpl, True), ({"a": 1}, False), (print, False)):
        path.write_bytes(pickle.dumps(given))
        assert is_pkl(path) is motion
