"""``onbeat retime`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.formats import read_motion, write_motion
from onbeat.formats.joint_table import read_joint_table, write_joint_table
from onbeat.motion.joint_angles import JointAngles

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dancer with the beats beside, a robot's angles, and a song's beats."""
    place = tmp_path_factory.mktemp("retime")
    clip = perform_dance(DANCERS[0], "harvest dance", 1.0, 1, np.random.default_rng(0), fps=30)
    write_motion(clip.motion, place / "dance.bvh")
    (place / "dance.beats").write_text("".join(f"{beat:.4f}\n" for beat in clip.beats))
    seconds = np.arange(0, 8, 1 / 60)
    swing = np.stack((1.5 * np.sin(2 * np.pi * seconds), 0.2 * np.cos(seconds)), axis=1)
    write_joint_table(JointAngles(("arm_left_4_joint", "torso_1_joint"), swing - [1.6, 0.0], 60), place / "angles.csv")
    joints = "torso_1_joint = {}\narm_left_4_joint = {position = [-3.2, 0]}\n"
    (place / "talos.toml").write_text("[default]\nspeed = 4.58\n[joints]\n" + joints)
    (place / "song.beats").write_text("".join(f"{beat:.4f}\n" for beat in np.cumsum(np.linspace(0.45, 0.6, 40))))
    return place


def test_a_character_dances_faster_and_its_legs_go_with_the_time(onbeat: Run, folder: Path) -> None:
    status, out, _ = onbeat("retime", folder / "dance.bvh", "--speed", "1.25", "--beats", folder / "dance.beats",
                            "-o", folder / "faster")  # fmt: skip
    assert status == 0
    assert "1.25 ×" in out
    assert "0 joints in position, 0 in velocity" in out
    made, was = read_motion(folder / "faster/dance.bvh"), read_motion(folder / "dance.bvh")
    assert len(made) == pytest.approx(len(was) / 1.25, abs=1)
    at = was.at(made.times * 1.25)
    foot = next(k for k, name in enumerate(was.skeleton.names) if name.endswith("LeftFoot"))
    assert np.abs(made.positions[:, foot] - at.positions[:, foot]).max() < 1e-3
    assert {path.name for path in (folder / "faster").iterdir()} == {
        "dance.bvh", "retime.json", "retime.png", "limits.png", "retime.html",
    }  # fmt: skip


def test_beats_meet_the_musics_through_a_change_of_tempo(onbeat: Run, folder: Path) -> None:
    status, out, _ = onbeat("retime", folder / "dance.bvh", "--music", folder / "song.beats", "--beats",
                            folder / "dance.beats", "-o", folder / "met", "--json")  # fmt: skip
    told = json.loads(out)
    song = np.loadtxt(folder / "song.beats")
    count = min(len(song), len(told["beats"]))
    assert status == 0
    assert np.abs(np.array(told["beats"])[:count] - song[:count]).max() < 1 / 30


def test_what_a_robot_cannot_do_is_said_with_the_speed_that_would_do(onbeat: Run, folder: Path) -> None:
    keys = [{"time": t, "frame": 0, "beat": 0, "source": "global"} for t in np.arange(0.25, 7.8, 0.5)]
    document = {"version": 1, "fps": 60, "thresholds": {"t1": 1, "t2": 1}, "keyposes": keys}
    (folder / "keyposes.json").write_text(json.dumps(document))
    status, out, _ = onbeat("retime", folder / "angles.csv", "--speed", "1.2", "--limits", folder / "talos.toml",
                            "--keyposes", folder / "keyposes.json", "-o", folder / "robot")  # fmt: skip
    assert status == 0
    assert "keyposes are not kept" in out
    assert "arm_left_4_joint: " in out
    assert "at speed" in out
    made = read_joint_table(folder / "robot/angles.csv")
    assert np.abs(np.diff(made.angles, axis=0)).max() * 60 <= 4.58 + 1e-6
    assert made.angles[:, 0].max() <= 1e-6


def test_every_method_can_be_chosen_and_one_file_be_asked_for(onbeat: Run, folder: Path) -> None:
    for method in ("layers-qp", "layers2007", "pollard2002", "clamp", "uniform"):
        status, out, err = onbeat("retime", folder / "angles.csv", "--speed", "1.1", "--limits", folder / "talos.toml",
                                  "--method", method, "-o", folder / method / "made.csv", "--json")  # fmt: skip
        assert (status, json.loads(out)["method"]) == (0, method), err
        assert (folder / method / "made.csv").is_file()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["dance.bvh"], "give --speed, how much faster, or --music"),
        (["dance.bvh", "--speed", "1", "--music", "song.beats"], "one of them"),
        (["dance.bvh", "--speed", "0"], "--speed 0: give 0.1 to 10"),
        (["dance.bvh", "--speed", "nan"], "--speed nan: give 0.1 to 10"),
        (
            ["dance.bvh", "--speed", "1.2", "--robot", "g1"],
            "of Unitree G1: `onbeat robot` puts it on",
        ),
        (["dance.bvh", "--speed", "1.2", "--robot", "r2d2"], "r2d2"),
        (["angles.csv", "--speed", "1.2"], "give --robot NAME or --limits FILE.toml"),
        (["angles.csv", "--speed", "1.2", "--robot", "talos", "--limits", "talos.toml"], "give one of them"),
        (["dance.bvh", "--speed", "1.2", "--joints", "Tail"], "Tail"),
        (["dance.bvh", "--speed", "1.2", "--keyposes", "none.json"], "cannot read"),
        (["dance.bvh", "--music", "none.beats"], "none.beats"),
        (["none.bvh", "--speed", "1.2"], "none.bvh"),
        (["angles.csv", "--music", "song.beats", "--limits", "talos.toml"], "give --beats or --danced-to"),
        (["dance.bvh", "--speed", "1.2", "--figure", "Tail"], "no joint 'Tail'"),
        (["dance.bvh", "--speed", "1.2", "--margin", "0"], "share of the limits"),
        (["dance.bvh", "--speed", "1.2", "--fps", "0"], "--fps 0"),
    ],
)
def test_what_cannot_be_is_told_in_a_line(onbeat: Run, folder: Path, words: list[str], said: str, monkeypatch) -> None:
    monkeypatch.chdir(folder)
    status, out, err = onbeat("retime", *words, "-o", "nothing")
    assert (status, out) == (1, "")
    assert said in err
    assert "Traceback" not in err
    assert not (folder / "nothing").exists()
