import json
from pathlib import Path

import pytest

from onbeat.limits.named import robot_limits, robot_names

pytestmark = pytest.mark.filterwarnings("ignore:Cyclopts application invoked")


def test_all_robots_in_a_table(onbeat):
    status, out, err = onbeat("robots")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].split() == ["name", "robot", "joints", "slowest", "rad/s", "fastest", "rad/s", "model", "source"]
    starts = [line.split()[0] for line in lines if not line.startswith(" ")]
    assert starts[1:] == list(robot_names())
    talos = next(line for line in lines if line.startswith("talos"))
    assert "32  1 head_1_joint" in talos
    assert "7 leg_left_4_joint" in talos
    assert "93.3 kg, to 300 N·m" in talos
    assert "–" in next(line for line in lines if line.startswith("h1"))


def test_all_robots_as_json(onbeat):
    status, out, _ = onbeat("robots", "--json")
    document = json.loads(out)
    assert status == 0
    assert document["version"] == 1
    g1 = document["robots"][0]
    assert (g1["name"], g1["robot"], g1["joints"]) == ("g1", "Unitree G1", 29)
    assert g1["fastest"] == {"joint": "left_shoulder_pitch_joint", "speed": 37.0}
    assert "urdf" in g1["source"]
    assert {row["name"]: row["model"] and row["model"]["mass"] for row in document["robots"]} == {
        "g1": 33.34114202,
        "h1": None,
        "hrp4c": 43.149948443,
        "nao": None,
        "talos": 93.335724,
    }


def test_the_joints_of_one(onbeat):
    status, out, _ = onbeat("robots", "h1")
    lines = out.splitlines()
    assert status == 0
    assert lines[0] == "Unitree H1: 19 joints"
    assert lines[1] == robot_limits("h1").source
    assert lines[2].split() == ["joint", "low", "rad", "high", "rad", "speed", "rad/s"]
    assert ["left_knee_joint", "-0.26", "2.05", "14"] in [line.split() for line in lines]


def test_the_joints_of_one_as_json(onbeat):
    status, out, _ = onbeat("robots", "nao", "--json")
    document = json.loads(out)
    assert status == 0
    assert len(document["joints"]) == 25
    assert document["joints"][0] == {
        "joint": "HeadYaw",
        "low": -2.08567,
        "high": 2.08567,
        "speed": 8.26797,
        "acceleration": None,
        "jerk": None,
    }


def test_a_file_and_what_it_does_not_tell(onbeat, tmp_path: Path):
    (tmp_path / "bot.xml").write_text(
        '<mujoco><worldbody><body><joint name="a" range="-90 90"/></body></worldbody></mujoco>'
    )
    status, out, err = onbeat("robots", tmp_path / "bot.xml")
    assert status == 0
    assert ["a", "-1.571", "1.571", "–"] in [line.split() for line in out.splitlines()]
    assert err.startswith("onbeat: ")
    assert "does not tell how fast a may be" in err


def test_accelerations_are_shown_where_there_are_some(onbeat, tmp_path: Path):
    (tmp_path / "a.toml").write_text("joints.a = { speed = 2, acceleration = 30 }\njoints.b.speed = 1")
    _, out, _ = onbeat("robots", tmp_path / "a.toml")
    assert "acceleration rad/s²" in out
    assert "jerk" not in out
    assert ["b", "–", "–", "1", "–"] in [line.split() for line in out.splitlines()]


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("talo", "no robot 'talo' is known (is it talos?)"),
        ("none.urdf", "cannot read none.urdf: No such file or directory"),
        ("folder/none", "cannot read folder/none"),
    ],
)
def test_what_is_not_there_is_told_in_a_line(onbeat, word: str, told: str):
    status, out, err = onbeat("robots", word)
    assert (status, out) == (1, "")
    assert told in err
    assert err.count("\n") == 1
