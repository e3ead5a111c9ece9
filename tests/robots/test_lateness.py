"""Whether a robot dances on the beat."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.motion.motion import Motion
from onbeat.robots.lateness import lateness
from onbeat.robots.model import robot_named

G1 = robot_named("g1")


def swinging(seconds: float = 4.0, fps: float = 60.0) -> Motion:
    times = np.arange(int(seconds * fps)) / fps
    angles = 0.2 * np.sin(2 * np.pi * times[:, None] * np.linspace(0.5, 1.5, 29))
    return hinge_motion(G1.body, np.zeros((len(times), 3)), np.tile(rot.IDENTITY, (len(times), 1)), angles, fps)


@pytest.mark.parametrize("late", [-0.1, 0.0, 0.05, 0.2])
def test_a_motion_that_is_late_is_said_to_be(late: float):
    plan = swinging()
    found = lateness(G1, plan, plan.at(plan.times - late), np.array([1.0, 2.0, 3.0]))
    assert np.abs(found - late).max() < 0.5 / plan.fps + 1e-9


def test_beats_after_a_fall_are_not_met():
    plan = swinging()
    assert np.isinf(lateness(G1, plan, plan[:90], np.array([1.0, 3.0]))).tolist() == [False, True]
