import sys

import numpy as np
import pytest

from onbeat.cli import main
from onbeat.formats import read_markers, read_motion, write_motion
from onbeat.motion.edit import stature
from onbeat.motion.retarget import floor_height
from persons import AMC, ASF, person, swinging

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


def run(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["onbeat", "convert", *map(str, words)])
    try:
        main()
    except SystemExit as leaving:
        return int(leaving.code or 0)
    return 0


def test_any_format_becomes_any_other(tmp_path, monkeypatch, capsys):
    body = swinging(person(), frames=31, fps=30)
    write_motion(body, tmp_path / "a.bvh")
    assert run(monkeypatch, tmp_path / "a.bvh", tmp_path / "b.npz", "--fps", 15) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "b.npz: 16 frames, 1.07 s at 15 frames a second, 26 joints" in captured.err
    np.testing.assert_allclose(read_motion(tmp_path / "b.npz").positions, body.positions[::2], atol=1e-6)
    assert run(monkeypatch, tmp_path / "b.npz", tmp_path / "c.glb") == 0
    assert run(monkeypatch, tmp_path / "b.npz", tmp_path / "d.bvh", "--up", "z", "--unit", "m") == 0
    assert "OFFSET 0.000000 0.000000 0.120000" in (tmp_path / "d.bvh").read_text()


def test_an_assumed_rate_is_told_unless_given(tmp_path, monkeypatch, capsys):
    (tmp_path / "t.asf").write_text(ASF)
    (tmp_path / "t.amc").write_text(AMC)
    assert run(monkeypatch, tmp_path / "t.amc", tmp_path / "t.npz") == 0
    assert "onbeat: AMC files store no frame rate: 120" in capsys.readouterr().err
    assert run(monkeypatch, tmp_path / "t.amc", tmp_path / "t.npz", "--source-fps", 60) == 0
    assert "are assumed" not in capsys.readouterr().err
    assert read_motion(tmp_path / "t.npz").fps == 60


def test_another_body_and_the_mirror(tmp_path, monkeypatch):
    write_motion(swinging(person()), tmp_path / "a.npz")
    write_motion(swinging(person(1.2)), tmp_path / "large.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.npz", "--like", tmp_path / "large.npz", "--mirror") == 0
    assert read_motion(tmp_path / "b.npz").skeleton == person(1.2)


def test_cut_joined_scaled_and_put_on_the_ground(tmp_path, monkeypatch):
    for name, seed in (("a.npz", 1), ("b.npz", 2)):
        write_motion(swinging(person(), frames=60, fps=30, seed=seed, angle=0.2), tmp_path / name)
    sources, target = (tmp_path / "a.npz", tmp_path / "b.npz"), tmp_path / "c.npz"
    words = ("--blend", 0.5, "--start", 0.5, "--end", 3, "--height", 1.5, "--ground")
    assert run(monkeypatch, *sources, target, *words) == 0
    joined = read_motion(target)
    assert len(joined) == 75
    assert stature(joined) == pytest.approx(1.5, abs=1e-9)
    assert -0.03 <= floor_height(joined) <= 0.08


def test_other_bodies_are_joined_on_one(tmp_path, monkeypatch):
    write_motion(swinging(person(), frames=30, fps=30, angle=0.2), tmp_path / "a.npz")
    write_motion(swinging(person(1.2), frames=30, fps=30, seed=2, angle=0.2), tmp_path / "b.npz")
    words = (tmp_path / "a.npz", tmp_path / "b.npz", tmp_path / "c.npz")
    assert run(monkeypatch, *words) == 1
    assert run(monkeypatch, *words, "--like", tmp_path / "a.npz") == 0
    joined = read_motion(tmp_path / "c.npz")
    assert len(joined) == 60
    assert joined.skeleton == person()


def test_what_a_reader_has_to_be_told_is_said(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=3), tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.bvh", "--unit", "in", "--up", "x") == 0
    assert "--source-up x --source-unit in" in capsys.readouterr().err


def test_an_open_end_is_the_end(tmp_path, monkeypatch):
    write_motion(swinging(person(), frames=30), tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.npz", "--end", "inf") == 0
    assert len(read_motion(tmp_path / "b.npz")) == 30


def test_what_a_file_leaves_open_can_be_told(tmp_path, monkeypatch):
    small = swinging(person(), frames=3)
    write_motion(small, tmp_path / "a.bvh", up="z", unit="in")
    assert run(monkeypatch, tmp_path / "a.bvh", tmp_path / "b.npz", "--source-up", "z", "--source-unit", "in") == 0
    np.testing.assert_allclose(read_motion(tmp_path / "b.npz").positions, small.positions, atol=1e-6)


def test_joints_become_markers_and_markers_stay_markers(tmp_path, monkeypatch, capsys):
    body = swinging(person(), frames=30, fps=30, angle=0.2)
    write_motion(body, tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.c3d") == 0
    assert run(monkeypatch, tmp_path / "b.c3d", tmp_path / "c.trc", "--fps", 60, "--end", 0.5) == 0
    assert "c.trc: 29 frames" in capsys.readouterr().err
    markers = read_markers(tmp_path / "c.trc")
    wrist = markers.positions[::2, markers.index("LeftWrist")]
    np.testing.assert_allclose(wrist, body.positions[:15, body.skeleton.index("LeftWrist")], atol=1e-3)


def test_a_table_of_angles(tmp_path, monkeypatch):
    write_motion(swinging(person(), frames=3), tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "a.angles.csv") == 0
    assert (tmp_path / "a.angles.csv").read_text().startswith("time,x,y,z,Hips Z,Hips X,Hips Y,")


def test_a_roles_file_is_used(tmp_path, monkeypatch, capsys):
    body = swinging(person(), frames=5)
    s = body.skeleton
    names = [name.replace("LeftHip", "Bein1").replace("RightHip", "Bein2") for name in s.names]
    strange = body.replace(skeleton=s.replace(names=names))
    write_motion(strange, tmp_path / "a.npz")
    (tmp_path / "who.toml").write_text('[joints]\nleft_hip = "Bein1"\nright_hip = "Bein2"\n')
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.npz", "--roles", tmp_path / "who.toml") == 0
    assert dict(read_motion(tmp_path / "b.npz").skeleton.roles) == {"left_hip": "Bein1", "right_hip": "Bein2"}
    (tmp_path / "who.toml").write_text('[joints]\nleft_hip = "Bein3"\n')
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.npz", "--roles", tmp_path / "who.toml") == 1
    assert "who.toml" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("none.bvh", "b.glb"), "no file"),
        (("a.npz",), "only a.npz is given; a file to read and one to write"),
        (("a.npz", "b.fbx"), "cannot write"),
        (("a.npz", "b.glb", "--up", "z"), "always in metres with Y up"),
        (("a.npz", "b.bvh", "--fps", "0"), "give a rate"),
        (("a.npz", "b.bvh", "--start", "9"), "no frame from 9 s"),
        (("a.npz", "b.bvh", "--height", "0"), "give a height"),
        (("a.npz", "b.bvh", "--height", "1", "--scale", "2"), "give one of them"),
        (("a.npz", "b.bvh", "--scale", "nan"), "a scale of nan"),
        (("a.npz", "b.bvh", "--scale", "1e12"), "a scale of 1e+12"),
        (("a.npz", "b.bvh", "--start", "nan"), "no frame from nan s"),
        (("a.npz", "b.bvh", "--start", "inf"), "no frame from inf s"),
        (("a.npz", "b.bvh", "--end", "nan"), "no frame from 0 s to nan s"),
        (("a.npz", "b.bvh", "--joint-order", "isaac"), "--joint-order is of .tracking.npz"),
        (("a.npz", "b.tracking.npz", "--joint-order", "isaac", "--up", "y"), "Z up"),
        (("a.npz", "nowhere/b.bvh"), "choose another folder"),
        (("a.npz", "a.npz", "b.bvh", "--blend", "5"), "too short for a blend"),
        (("a.npz", "b.csv"), "g1"),
    ],
)
def test_a_users_error_is_one_line(words, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_motion(swinging(person()), "a.npz")
    assert run(monkeypatch, *words) == 1
    err = capsys.readouterr().err
    assert message in err or message.upper() in err
    assert err.count("\n") == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.npz"]


def test_a_body_without_length_has_no_height_to_change(tmp_path, monkeypatch, capsys):
    flat = person().replace(offsets=np.zeros((len(person()), 3)))
    write_motion(swinging(flat), tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.bvh", "--height", "1.7") == 1
    assert "its bones have no length" in capsys.readouterr().err


def test_an_axis_that_points_down_is_written_and_read(tmp_path, monkeypatch):
    motion = swinging(person(), frames=5, angle=0.1)
    write_motion(motion, tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.bvh", "--up", "-y", "--unit", "dm") == 0
    assert run(monkeypatch, tmp_path / "b.bvh", tmp_path / "c.npz", "--source-up", "-y", "--source-unit", "dm") == 0
    np.testing.assert_allclose(read_motion(tmp_path / "c.npz").positions, motion.positions, atol=1e-5)
