import sys

import numpy as np
import pytest

from onbeat.cli import main
from onbeat.formats import read_motion, write_motion
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
    assert "t.amc: AMC files store no frame rate: 120" in capsys.readouterr().err
    assert run(monkeypatch, tmp_path / "t.amc", tmp_path / "t.npz", "--source-fps", 60) == 0
    assert "are assumed" not in capsys.readouterr().err
    assert read_motion(tmp_path / "t.npz").fps == 60


def test_another_body_and_the_mirror(tmp_path, monkeypatch):
    write_motion(swinging(person()), tmp_path / "a.npz")
    write_motion(swinging(person(1.2)), tmp_path / "large.npz")
    assert run(monkeypatch, tmp_path / "a.npz", tmp_path / "b.npz", "--like", tmp_path / "large.npz", "--mirror") == 0
    assert read_motion(tmp_path / "b.npz").skeleton == person(1.2)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("none.bvh", "b.glb"), "no file"),
        (("a.npz", "b.fbx"), "cannot write"),
        (("a.npz", "b.glb", "--up", "z"), "always in metres with Y up"),
        (("a.npz", "b.bvh", "--fps", "0"), "give a rate"),
    ],
)
def test_a_users_error_is_one_line(words, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_motion(swinging(person()), "a.npz")
    assert run(monkeypatch, *words) == 1
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.npz"]
