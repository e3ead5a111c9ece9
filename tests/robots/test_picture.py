"""Pictures show the robot, and move with it."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import BodyError, MissingExtraError
from onbeat.motion import Motion
from onbeat.robots import picture
from onbeat.robots.model import robot_named
from onbeat.robots.state import motion_of


def waving() -> Motion:
    robot = robot_named("g1")
    qpos = np.tile(np.array([0, 0, robot.model.qpos0[2], 1, 0, 0, 0, *np.zeros(29)]), (30, 1))
    qpos[:, 7 + robot.body.names.index("left_shoulder_roll_joint")] = np.linspace(0, 2, 30)
    return motion_of(robot, qpos, 30)


def test_pictures_are_of_the_size_and_number_asked_for_and_differ():
    try:
        shown = list(picture.pictures(robot_named("g1"), waving(), fps=4, size=(96, 64)))
    except MissingExtraError as error:
        pytest.skip(str(error))
    assert len(shown) == 4
    assert all(each.shape == (64, 96, 3) and each.dtype == np.uint8 for each in shown)
    assert np.ptp(shown[0]) > 50
    assert (shown[0] != shown[3]).any(axis=2).sum() > 20


@pytest.mark.parametrize(("fps", "size"), [(0, (96, 64)), (np.nan, (96, 64)), (30, (0, 64)), (30, (96, 100000))])
def test_pictures_that_cannot_be_drawn_are_said(fps: float, size: tuple[int, int]):
    with pytest.raises(BodyError, match="cannot be drawn"):
        picture.pictures(robot_named("g1"), waving(), fps=fps, size=size)


def test_without_a_graphics_system_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("MUJOCO_GL", "none_such")
    with pytest.raises(MissingExtraError, match=r"cannot draw with none_such .* install EGL"):
        picture.drawing_system(96, 64)
