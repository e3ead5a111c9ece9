"""What is noted down of a trial."""

from __future__ import annotations

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_motion
from onbeat.robots.model import robot_named
from onbeat.robots.trial import Trial

G1 = robot_named("g1")


def trial(fell_at: float | None = None) -> Trial:
    """Three ticks, in which the first hinge is off by 0, 0.3 and -0.4 rad and the left foot alone carries at last."""
    still = hinge_motion(G1.body, np.zeros((2, 3)), np.tile(rot.IDENTITY, (2, 1)), np.zeros((2, 29)), 50.0)
    error = np.zeros((3, 29))
    error[:, 0] = [0.0, 0.3, -0.4]
    load = np.array([[160.0, 160.0], [300.0, 20.0], [320.0, 0.0]])
    return Trial(still, fell_at, None, np.arange(3) / 500, error, np.zeros(29), np.zeros((3, 2)), load)


def test_errors_are_each_hinges_own():
    one = trial()
    assert one.rms_error[0] == np.sqrt(0.25 / 3)
    assert one.worst_error[0] == 0.4
    assert not one.rms_error[1:].any()


def test_who_fell_was_not_upright():
    assert trial().upright
    assert not trial(0.004).upright


def test_a_foot_that_carries_nothing_does_not_touch():
    assert trial().contacts[2].tolist() == [True, False]
    assert trial().contacts[0].all()
