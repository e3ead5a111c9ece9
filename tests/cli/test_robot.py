"""``onbeat robot`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from onbeat.cli.robot import read_robot
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.formats import read_motion, write_motion
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.model import robot_named

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dancer of five seconds with the beats beside."""
    place = tmp_path_factory.mktemp("robot")
    clip = perform_dance(DANCERS[1], "harvest dance", 1.0, 1, np.random.default_rng(0), fps=30)
    write_motion(clip.motion[:150], place / "dance.bvh")
    beats = clip.beats[clip.beats < 5]
    (place / "dance.beats").write_text("".join(f"{beat:.4f}\n" for beat in beats))
    (place / "song.beats").write_text("".join(f"{beat:.4f}\n" for beat in 0.2 + np.arange(16) * 0.55))
    return place


def test_a_dance_to_a_song_is_simulated_and_exported(onbeat: Run, folder: Path) -> None:
    status, out, err = onbeat("robot", folder / "dance.bvh", "--music", folder / "song.beats", "--beats",
                              folder / "dance.beats", "--simulate", "-o", folder / "out")  # fmt: skip
    assert status == 0, err
    assert "0 joints in position, 0 in velocity" in out
    assert "upright to the end" in out
    assert "planned: zero-moment point inside the soles 100% of the time" in out
    assert "measured: centre of pressure inside the soles" in out
    assert {path.name for path in (folder / "out").iterdir()} >= {
        "dance.csv", "dance.tracking.npz", "dance.gmr.npz", "dance.joints.csv", "dance.pos", "dance.waist", "dance.zmp",
        "dance.mcap", "dance.glb", "robot.json", "robot.png", "robot.html",
    }  # fmt: skip
    told = json.loads((folder / "out/robot.json").read_bytes())
    assert told["trial"]["fell_at"] is None
    assert 0.95 < told["trial"]["inside"] <= 1
    assert told["trial"]["worst_mm"] < told["zmp"]["worst_mm"]
    song = np.loadtxt(folder / "song.beats")
    count = min(len(song), len(told["beats"]))
    assert np.abs(np.array(told["beats"])[:count] - song[:count]).max() < 1 / 30
    read = read_motion(folder / "out/dance.csv", fps=told["fps"])
    assert len(read) == len(told["zmp"]["margin_mm"])
    assert (
        read_motion(folder / "out/dance.gmr.npz").skeleton.names[: len(G1.names)]
        == read.skeleton.names[: len(G1.names)]
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["dance.bvh", "--robot", "r2d2"], "no robot 'r2d2' is known"),
        (["dance.bvh", "--speed", "1.2", "--music", "song.beats"], "one of them"),
        (["dance.bvh", "--speed", "99"], "--speed 99: give 0.1 to 10"),
        (["dance.bvh", "--robot", "none.urdf"], "none.urdf"),
        (["none.bvh"], "none.bvh"),
        (["dance.bvh", "--simulate", "--seed", "-3"], "--seed -3: give 0 or more"),
        (["dance.bvh", "--danced-to", "a.wav", "--beats", "dance.beats"], "one of them"),
    ],
)
def test_what_cannot_be_is_told_in_a_line(onbeat: Run, folder: Path, words: list[str], said: str, monkeypatch) -> None:
    monkeypatch.chdir(folder)
    status, out, err = onbeat("robot", *words, "-o", "nothing")
    assert (status, out) == (1, "")
    assert said in err
    assert "Traceback" not in err
    assert not (folder / "nothing").exists()


def test_a_robot_comes_from_a_file_of_ours_as_well(tmp_path: Path) -> None:
    text = (files("onbeat.robots") / "descriptions" / "talos.toml").read_text(encoding="utf-8")
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    assert read_robot(str(tmp_path / "mine.toml")).body.names == robot_named("talos").body.names
