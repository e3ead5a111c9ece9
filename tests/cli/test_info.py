import json
import sys

import pytest

from onbeat.cli import main
from onbeat.formats import write_markers, write_motion
from onbeat.motion import Markers
from onbeat.motion.joint_markers import joint_markers
from persons import AMC, ASF, person, swinging

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


def run(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["onbeat", "info", *map(str, words)])
    try:
        main()
    except SystemExit as leaving:
        return int(leaving.code or 0)
    return 0


def test_a_body_with_its_roles_and_what_was_guessed(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=60, fps=30, angle=0.2), tmp_path / "a.bvh")
    assert run(monkeypatch, tmp_path / "a.bvh") == 0
    shown = capsys.readouterr().out
    assert "a.bvh (Biovision Hierarchy)" in shown
    assert "60 frames at 30 a second, 2.00 s" in shown
    assert ["left_elbow", "LeftElbow", "name"] in [line.split() for line in shown.splitlines()]
    assert "cm (the longest way along the bones is" in shown


def test_everything_as_json(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=60, fps=30, angle=0.2), tmp_path / "a.bvh")
    assert run(monkeypatch, tmp_path / "a.bvh", "--json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["version"] == 1
    assert report["frames"] == 60
    assert len(report["joints"]) == 21
    assert {"about": "up", "taken": "y", "why": "the head is over the feet along it"} in report["guesses"]
    roles = {role["role"]: role["joint"] for role in report["roles"]}
    assert roles["left_wrist"] == "LeftWrist"
    assert [contact["side"] for contact in report["contacts"]] == ["left", "right"]


def test_a_rate_that_was_assumed_is_told(tmp_path, monkeypatch, capsys):
    (tmp_path / "t.asf").write_text(ASF)
    (tmp_path / "t.amc").write_text(AMC)
    assert run(monkeypatch, tmp_path / "t.amc") == 0
    captured = capsys.readouterr()
    assert "AMC files store no frame rate" in captured.err
    assert "missing" in captured.out
    assert "no joint found for" in captured.out


def test_markers_with_the_body_fitted_to_them(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=20, fps=30, angle=0.2), tmp_path / "a.c3d")
    assert run(monkeypatch, tmp_path / "a.c3d", "--json") == 0
    report = json.loads(capsys.readouterr().out)
    assert report["markers"][0]["labels"] == list(joint_markers(swinging(person(), frames=1)).names)
    assert report["markers"][0]["gaps"] == 0
    assert report["markers"][0]["residual_mm"] < 15


def test_a_roles_file_to_edit(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=3), tmp_path / "a.npz")
    assert run(monkeypatch, tmp_path / "a.npz", "--roles-template") == 0
    text = capsys.readouterr().out
    assert 'left_wrist = "LeftWrist"' in text
    (tmp_path / "a.roles.toml").write_text(text.replace('"LeftWrist"', '"LeftElbow"').replace('left_elbow = "', "#"))
    assert run(monkeypatch, tmp_path / "a.npz") == 0
    shown = capsys.readouterr().out
    assert ["left_wrist", "LeftElbow", "told"] in [line.split() for line in shown.splitlines()]


def test_a_roles_file_for_markers_to_edit(tmp_path, monkeypatch, capsys):
    markers = joint_markers(swinging(person(), frames=20, fps=30, angle=0.2))
    names = ["M 17" if name == "LeftWrist" else name.replace("LeftWrist_end", "M 18") for name in markers.names]
    write_markers(Markers(names, markers.positions, 30), tmp_path / "a.c3d")
    assert run(monkeypatch, tmp_path / "a.c3d", "--roles-template") == 0
    text = capsys.readouterr().out
    assert '# left_wrist = [""]' in text
    assert '"M 17"' in text
    (tmp_path / "a.roles.toml").write_text(text.replace('# left_wrist = [""]', 'left_wrist = ["M 17"]'))
    assert run(monkeypatch, tmp_path / "a.c3d", "--json") == 0
    assert 0 <= json.loads(capsys.readouterr().out)["markers"][0]["residual_mm"] < 15
    (tmp_path / "a.roles.toml").write_text('[joints]\nleft_wrist = "Hand"\n')
    assert run(monkeypatch, tmp_path / "a.c3d") == 1
    assert "[joints] is of bodies" in capsys.readouterr().err


def test_a_body_in_a_wrong_unit_is_doubted(tmp_path, monkeypatch, capsys):
    write_motion(swinging(person(), frames=30, angle=0.1), tmp_path / "a.bvh", unit="in")
    assert run(monkeypatch, tmp_path / "a.bvh") == 0
    said = capsys.readouterr()
    assert "is the unit right? (`--source-unit`; in are inches)" in said.out
    assert "in makes it 1.75 m" in said.err
    assert run(monkeypatch, tmp_path / "a.bvh", "--unit", "in", "--up", "-y") == 0
    said = capsys.readouterr()
    assert "the head is under the feet nearly throughout" in said.out
    assert not said.err


@pytest.mark.parametrize(("name", "message"), [("none.bvh", "no file"), ("a.txt", "cannot read")])
def test_a_users_error_is_one_line(name, message, tmp_path, monkeypatch, capsys):
    (tmp_path / "a.txt").write_text("")
    assert run(monkeypatch, tmp_path / name) == 1
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1
