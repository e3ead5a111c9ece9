"""``robot.html``: the robot and its dancer are on one clock, each in its own shape, and a fall is told."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.examples import embedded_song
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.robots.ik.collision import capsules_of
from onbeat.robots.model import Robot, robot_named
from onbeat.viewer.contract import PageData, PathData, unpack_path
from onbeat.viewer.pages.page import write_filled
from onbeat.viewer.pages.robot import apart, kept_beside, robot_page_data, together
from onbeat.viewer.robot_shape import ROBOT

BEATS = np.arange(0.25, 4.0, 0.5)
KEYPOSES = np.array([0.75, 1.75, 2.75])


@pytest.fixture(scope="module")
def g1() -> Robot:
    pytest.importorskip("mujoco")
    return robot_named("g1")


def moving(robot: Robot, seconds: float = 4.0, fps: float = 30.0) -> Motion:
    """A robot that lifts its left arm and is pushed to the side and turned a little."""
    times = np.arange(round(seconds * fps)) / fps
    angles = np.zeros((len(times), len(robot.body.names)))
    angles[:, robot.body.names.index("left_shoulder_roll_joint")] = 0.3 * times
    root = np.column_stack((2.0 + 0.1 * times, np.full(len(times), -1.0), np.full(len(times), 0.79)))
    return hinge_motion(robot.body, root, rot.about(np.array([0, 0, 1.0]), 0.2 * times), angles, fps, "lifts")


@pytest.fixture(scope="module")
def page(g1: Robot, swinger: Motion) -> dict[str, Any]:
    notes = {"ZMP inside": "100 %", "margin": {"least": 0.0213}}
    return data_in(robot_page_data(swinger, moving(g1), None, None, BEATS, KEYPOSES, "Both", notes, model=g1))


def data_in(page: PageData) -> dict[str, Any]:
    return json.loads(msgspec.json.encode(page))


def paths(body: dict[str, Any]) -> np.ndarray:
    return unpack_path(PathData(**body["path"]), len(body["joints"]))


def told(page: dict[str, Any]) -> dict[str, str]:
    return {one["name"]: one["value"] for one in page["metrics"]}


def test_the_robot_is_drawn_by_the_capsules_of_its_model(page: dict[str, Any], g1: Robot):
    found, robot = capsules_of(g1), moving(g1)
    ends = paths(page)
    assert len(page["capsules"]) == len(found.joints)
    for frame in (0, 90, 232):
        pose = robot.at(np.array([frame / 60]))
        joints, turns = pose.positions[0, found.joints], pose.world_rotations[0, found.joints]
        for which, end in enumerate("ab"):
            wanted = joints + rot.rotate(turns, found.ends[:, which])
            drawn = [ends[frame, one[end]] for one in page["capsules"]]
            assert np.array(drawn) == pytest.approx(wanted, abs=1e-3)
    assert [one["radius_a"] for one in page["capsules"]] == pytest.approx(found.radii, abs=1e-4)


def test_the_dancer_stands_beside_on_the_same_floor_from_the_robots_place(page: dict[str, Any], swinger: Motion):
    body = page["compared"]["body"]
    wrist = paths(body)[:, body["joints"].index("LeftHand")]
    wanted = swinger.positions[:, swinger.skeleton.index("LeftHand")]
    height = (wrist - wanted)[:, 2]
    assert height == pytest.approx(np.full(len(height), height[0]), abs=1e-3)
    assert page["compared"]["heat"] is None
    assert page["compared"]["captions"] == ["g1", "dancer"]
    assert page["compared"]["who"] == "dancer"


def test_a_dancer_who_walks_away_stays_beside_and_still_sways(swinger: Motion):
    times = swinger.times
    way = np.column_stack((1.5 * times, 0.05 * np.sin(2 * np.pi * 2.0 * times), 0 * times))
    walker = swinger.replace(root_positions=swinger.root_positions[:1] + way)
    still = swinger.replace(root_positions=np.tile(swinger.root_positions[:1], (len(times), 1)))
    kept = kept_beside(walker, still, 0.0) - kept_beside(still, still, 0.0)
    middle = slice(len(times) // 3, -len(times) // 3)
    assert np.abs(kept[middle, 0]).max() < 0.05
    assert np.ptp(kept[middle, 1]) == pytest.approx(0.1, abs=0.01)


def test_both_are_on_one_clock_at_the_finer_rate(page: dict[str, Any]):
    assert (page["fps"], page["frames"], page["duration"]) == (60.0, 240, 4.0)
    assert len(paths(page)) == len(paths(page["compared"]["body"])) == 240


def test_the_finer_rate_may_be_either_ones(g1: Robot, swinger: Motion):
    for fps in (30.0, 50.0, 60.0):
        assert together(swinger.resampled(30.0), moving(g1, 4.0, fps))[0].fps == fps
        assert together(swinger.resampled(30.0), moving(g1, 4.0, fps))[1].fps == fps


def test_soles_are_on_the_floor_of_the_page(g1: Robot, swinger: Motion):
    higher = swinger.replace(root_positions=swinger.root_positions + np.array([0, 0, 0.4]))
    page = data_in(robot_page_data(higher, moving(g1), model=g1))
    assert page["floor"] == pytest.approx(lowest(page), abs=0.005)
    assert lowest(page["compared"]["body"]) == pytest.approx(page["floor"], abs=0.005)


def lowest(body: dict[str, Any]) -> float:
    """Metres of the lowest point of a body's capsules on the median frame."""
    path = paths(body)
    ends = [
        path[:, one["a"], 2] + one[part] * (path[:, one["b"], 2] - path[:, one["a"], 2]) - one[f"radius_{end}"]
        for one in body["capsules"]
        for part, end in (("start", "a"), ("end", "b"))
    ]
    return float(np.median(np.min(ends, axis=0)))


def test_who_is_shorter_stays_as_it_was(g1: Robot, swinger: Motion):
    person, robot = together(swinger, moving(g1, 2.5, 120.0))
    assert len(person) == len(robot) == 240
    assert person.fps == robot.fps == 60.0
    last = moving(g1, 2.5, 120.0).positions[-1]
    assert robot.positions[150:] == pytest.approx(np.tile(last, (90, 1, 1)), abs=1e-6)
    longer, _ = together(swinger, moving(g1, 5.0))
    assert longer.positions[240:] == pytest.approx(np.tile(swinger.positions[-1], (60, 1, 1)))


def test_beats_keyposes_and_notes_are_those_given(page: dict[str, Any]):
    assert page["beats"] == pytest.approx(BEATS)
    assert page["tempo"] == pytest.approx(120.0)
    assert [(one["time"], one["beat"], one["source"]) for one in page["keyposes"]] == [
        (0.75, 2, "kept"),
        (1.75, 4, "kept"),
        (2.75, 6, "kept"),
    ]
    assert told(page) == {"ZMP inside": "100 %", "margin · least": "0.0213"}
    assert page["moves"] == []
    assert (page["title"], page["method"]) == ("Both", "g1")


def test_a_fall_is_told_everywhere(g1: Robot, swinger: Motion):
    page = data_in(robot_page_data(swinger, moving(g1, 2.0), None, None, BEATS, KEYPOSES, model=g1, fell_at=1.96))
    assert page["compared"]["captions"] == ["g1, falls at 2.0 s", "dancer"]
    assert told(page)["the robot"] == "falls at 2.0 s"
    assert [(one["clip"], one["at_s"]) for one in page["moves"]] == [("dances", 0.0), ("fell at 2.0 s", 1.96)]
    assert [one["source"] for one in page["keyposes"]] == ["kept", "kept", "missed"]
    assert page["duration"] == 4.0


def test_a_robot_that_only_ends_did_not_fall(g1: Robot, swinger: Motion):
    page = data_in(robot_page_data(swinger, moving(g1, 2.0), model=g1))
    assert told(page) == {"the robot": "ends at 2.0 s"}
    assert [one["clip"] for one in page["moves"]] == ["dances", "ended at 2.0 s"]
    assert told(data_in(robot_page_data(swinger, moving(g1, 3.95), model=g1))) == {}


def test_a_dancer_who_comes_near_begins_further_off():
    still = np.zeros((3, 2))
    assert apart(still, np.array([[0, 0], [-1.0, 0.2], [0, 0]]), 0.0) == pytest.approx(2.05)
    assert apart(still, np.array([[0, 0], [-1.0, 1.2], [0, 0]]), 0.0) == pytest.approx(1.05)
    assert apart(still, np.array([[0, 0], [0.1, -1.0], [0, 0]]), np.pi / 2) == pytest.approx(2.05)
    assert apart(still, np.array([[0, 0], [-30.0, 0.0], [0, 0]]), 0.0) == pytest.approx(2.6)


def test_a_song_brings_its_downbeats_and_its_sound(g1: Robot, swinger: Motion):
    song, samples, rate = embedded_song(seconds=5.0)
    page = data_in(robot_page_data(swinger, moving(g1), song, (samples, rate), song.beats, model=g1))
    assert page["tempo"] == song.tempo
    assert page["downbeats"]
    assert set(page["downbeats"]) <= set(page["beats"])
    assert page["audio"]["seconds"] == pytest.approx(5.0, abs=0.1)


def test_without_a_model_the_robot_is_drawn_by_its_roles(g1: Robot, swinger: Motion):
    page = data_in(robot_page_data(swinger, moving(g1)))
    assert "left_elbow_joint" in page["joints"]
    assert {one["colour"] for one in page["capsules"]} == {"#" + bytes(colour).hex() for colour in ROBOT.values()}
    assert page["compared"]["captions"] == ["robot", "dancer"]
    assert (page["beats"], page["keyposes"], page["title"]) == ([], [], "swinger")


def test_one_frame_of_each_makes_a_page(g1: Robot, swinger: Motion):
    page = data_in(robot_page_data(swinger[:1], moving(g1)[:1], model=g1))
    assert page["frames"] >= 1


def test_the_same_dances_give_the_same_bytes(g1: Robot, swinger: Motion, tmp_path: Path):
    for name in "ab":
        write_filled(tmp_path / f"{name}.html", robot_page_data(swinger, moving(g1), beats=BEATS, model=g1))
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_what_cannot_be_shown_is_said(g1: Robot, swinger: Motion):
    with pytest.raises(OnbeatError, match="beat 2 of 2 is at nan s"):
        robot_page_data(swinger, moving(g1), beats=np.array([0.5, np.nan]))
    with pytest.raises(OnbeatError, match="keypose 1 of 1 is at inf s"):
        robot_page_data(swinger, moving(g1), keyposes=np.array([np.inf]))
    with pytest.raises(OnbeatError, match="fall 1 of 1 is at nan s"):
        robot_page_data(swinger, moving(g1), fell_at=float("nan"))
    with pytest.raises(OnbeatError, match=r"swinger is not of the robot g1, which has 37 joints and not Hips; give"):
        robot_page_data(swinger, swinger, model=g1)
    other = Motion(Skeleton(("pelvis",), [-1], [[0, 0, 0]]), np.tile(rot.IDENTITY, (2, 1, 1)), np.zeros((2, 3)), 30)
    with pytest.raises(OnbeatError, match="has 37 joints and not 1 joints"):
        robot_page_data(swinger, other, model=g1)
