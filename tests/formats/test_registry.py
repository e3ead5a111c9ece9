import pytest

from onbeat.errors import FormatError, OnbeatError
from onbeat.formats import Convention, motion_files, read_motion, write_motion
from persons import AMC, ASF, BVH, person, swinging


def test_readable_files_are_found_sorted_and_deep(tmp_path):
    names = ["b.bvh", "a/z.BVH", "a/c.npz", "d.amc", "d.asf", "e.txt", "f.glb", ".hidden/g.bvh"]
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    found = [str(path.relative_to(tmp_path)) for path in motion_files(tmp_path)]
    assert found == ["a/c.npz", "a/z.BVH", "b.bvh", "d.amc"]
    with pytest.raises(FormatError, match="no folder"):
        motion_files(tmp_path / "none")


def test_the_suffix_tells_the_format(tmp_path):
    (tmp_path / "a.BVH").write_text(BVH)
    (tmp_path / "b.asf").write_text(ASF)
    (tmp_path / "b_1.amc").write_text(AMC)
    assert read_motion(tmp_path / "a.BVH").name == "a"
    assert read_motion(str(tmp_path / "b_1.amc"), fps=60).fps == 60


def test_what_cannot_be_read_or_written_is_said(tmp_path):
    (tmp_path / "a.fbx").write_text("")
    for path, message in (("a.fbx", r"'\.fbx' is not one of \.bvh"), ("none.bvh", "no file"), ("x", "is not one of")):
        with pytest.raises(FormatError, match=message):
            read_motion(tmp_path / path)
    (tmp_path / "f.bvh").mkdir()
    with pytest.raises(FormatError, match="is a folder"):
        read_motion(tmp_path / "f.bvh")
    with pytest.raises(FormatError, match=r"cannot write .* '\.amc' is not one of \.bvh, \.c3d, \.trc"):
        write_motion(swinging(person()), tmp_path / "a.amc")
    with pytest.raises(OnbeatError, match="cannot write"):
        write_motion(swinging(person()), tmp_path / "nowhere" / "a.bvh")


def test_unknown_conventions_are_refused():
    with pytest.raises(FormatError, match="the up axis 'w' is not known"):
        Convention("w")  # pyright: ignore[reportArgumentType]
    with pytest.raises(FormatError, match="m, cm, mm, in, cmu, dm, ft are expected"):
        Convention("y", "yards")
