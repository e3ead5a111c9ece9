"""``robot.html`` in a real browser: the robot and the dancer side by side on the music's clock, and a fall."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from browser.pictures import Pictures
from onbeat.examples import embedded_song
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.robots.model import robot_named
from onbeat.viewer.pages.page import write_filled
from onbeat.viewer.pages.robot import robot_page_data
from onbeat.viewer.robot_shape import robot_shape

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def made(swinger: Motion, tmp_path_factory: pytest.TempPathFactory, open_page: Any) -> tuple[Motion, Any]:
    pytest.importorskip("mujoco")
    g1, times = robot_named("g1"), np.arange(75) / 30
    angles = np.zeros((75, len(g1.body.names)))
    angles[:, g1.body.names.index("left_shoulder_roll_joint")] = 0.4 * times
    root = np.column_stack((0.05 * times, 0 * times, np.full(75, 0.79)))
    robot = hinge_motion(g1.body, root, np.tile(rot.IDENTITY, (75, 1)), angles, 30.0, "lifts")
    song, samples, rate = embedded_song(seconds=5.0)
    path = tmp_path_factory.mktemp("robot") / "robot.html"
    keyposes = song.beats[1:8:2]
    told = robot_page_data(
        swinger, robot, song, (samples, rate), song.beats, keyposes, "Lifts", {"limits": "kept"},
        model=g1, fell_at=2.48,
    )  # fmt: skip
    write_filled(path, told)
    return robot_shape(robot, g1)[0], open_page(path)


def test_it_looks_as_it_did(made: tuple[Motion, Any], pictures: Pictures):
    made[1].posed(1.5)
    pictures.look(made[1].page, "robot", (900, 640), dark=True)


def test_it_opens_without_a_word(made: tuple[Motion, Any]):
    made[1].posed(1.0)
    assert made[1].complaints == []
    assert [url for url in made[1].requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_both_stand_where_the_music_has_them(made: tuple[Motion, Any], swinger: Motion):
    robot, opened = made
    for time in (0.2, 1.5, 2.4):
        state = opened.posed(time)
        pose = robot.at(np.array([time])).positions[0]
        joints = [robot.skeleton.index(name) for name in state["names"]]
        assert np.reshape(state["joints"], (-1, 3)) == pytest.approx(pose[joints], abs=2e-3)
        other = np.reshape(state["other"], (-1, 3))
        assert len(other) != len(joints)
        dancer = swinger.at(np.array([time])).positions[0]
        assert np.ptp(other, axis=0)[2] == pytest.approx(np.ptp(dancer, axis=0)[2], abs=0.2)
        assert state["heat"] == []


def test_a_robot_that_fell_stays_as_it_was(made: tuple[Motion, Any]):
    robot, opened = made
    state = opened.posed(3.8)
    joints = [robot.skeleton.index(name) for name in state["names"]]
    assert np.reshape(state["joints"], (-1, 3)) == pytest.approx(robot.positions[-1, joints], abs=2e-3)
    assert opened.page.text_content("#now") == "fell at 2.5 s"
    opened.posed(1.0)
    assert opened.page.text_content("#now") == "dances"


def test_the_dancer_goes_round_its_places_and_there_are_no_colours_of_distance(made: tuple[Motion, Any]):
    opened = made[1]
    opened.posed(1.0)
    words, sizes = [], []
    for _ in range(4):
        words.append(opened.page.text_content("#master"))
        sizes.append(opened.state()["size"])
        opened.page.keyboard.press("m")
        opened.posed(1.1 + 0.1 * len(words))
    assert words == ["Dancer: beside", "Dancer: over", "Dancer: hidden", "Dancer: beside"]
    # A ghost of another body is as large as the robot.
    assert sizes[0] == sizes[3] == 1.0
    assert 0.65 < sizes[1] < 0.85
    assert not opened.page.is_visible("#heat")
    legend = opened.page.text_content("#legend")
    assert "keypose of the dancer" in legend
    assert "intensity of the dance" in legend
    assert "distance" not in legend
    assert opened.page.text_content("#metrics") == "the robotfalls at 2.5 slimitskept"
    assert opened.complaints == []


def test_it_plays_to_the_music(made: tuple[Motion, Any]):
    opened = made[1]
    opened.posed(0.0)
    opened.page.evaluate("window.onbeat.play()")
    opened.until("window.onbeat.state().time > 0.3")
    assert opened.state()["sound"]
    opened.page.evaluate("window.onbeat.pause()")
    assert opened.complaints == []
