"""Tasks of the legs."""

from __future__ import annotations

import pytest

from onbeat.robots.legs.tasks import tasks
from robot_dances import SQUAT, STEPS, WAY, made_dance


@pytest.mark.parametrize("fps", [30.0, 60.0, 120.0])
def test_steps_and_squats_of_a_made_dance_are_found(fps: float):
    robot, dance = made_dance(fps)
    found = tasks(dance, robot)
    steps = [task for task in found if task.kind == "step"]
    assert [task.foot for task in steps] == [("left", "right")[side] for side, _ in STEPS]
    for task, (_, start) in zip(steps, STEPS, strict=True):
        assert start - 0.05 <= task.start < task.end <= start + 0.45
        assert task.height == pytest.approx(0.08, abs=0.02)
    assert steps[0].place[1] - steps[3].place[1] == pytest.approx(WAY, abs=0.005)
    (squat,) = (task for task in found if task.kind == "squat")
    assert squat.start < SQUAT < squat.end
    assert squat.height == pytest.approx(0.11, abs=0.02)


def test_the_rest_is_standing():
    robot, dance = made_dance()
    found = tasks(dance, robot)
    assert found[0].kind == "stand"
    assert found[0].start == 0
    assert max(task.end for task in found) == pytest.approx(dance.duration, abs=0.05)
