"""Marks under feet lie where the feet are, while they are there."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.examples.body import Build
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from onbeat.viewer.pages.steps import steps_of


def walker() -> Motion:
    """Two seconds of a body that stands for one second, slides a metre ahead in a fifth of one, and stands again."""
    skeleton = Build(1.7).skeleton
    times = np.arange(120) / 60.0
    ahead = np.interp(times, [1.0, 1.2], [0.0, 1.0])
    root = np.column_stack((np.zeros(120), ahead, np.full(120, -skeleton.rest_positions[:, 2].min())))
    return Motion(skeleton, np.tile(rot.IDENTITY, (120, len(skeleton), 1)), root, 60.0, name="walker")


def test_each_foot_leaves_a_mark_where_it_stands() -> None:
    motion = walker()
    body = Body.of(motion.skeleton)
    steps = steps_of(motion, body)
    for side in ("left", "right"):
        first, last = (step for step in steps if step.foot == side)
        assert first.from_s == 0.0
        assert first.to_s == pytest.approx(1.0, abs=0.1)
        assert last.from_s == pytest.approx(1.2, abs=0.1)
        assert last.to_s == 2.0
        assert (last.x - first.x, last.y - first.y) == pytest.approx((0.0, 1.0), abs=0.02)
        ankle, toe = (motion.positions[0, body[f"{side}_{part}"]] for part in ("ankle", "toe"))
        assert np.allclose((first.x, first.y), (ankle + toe)[:2] / 2, atol=0.06)
        assert first.yaw == pytest.approx(np.arctan2(*(toe - ankle)[[0, 1]] * [-1, 1]), abs=0.01)
        assert 0.8 < first.length / float(np.linalg.norm(toe - ankle)) < 2


def test_a_foot_that_turns_while_it_stands_leaves_several() -> None:
    motion = walker()
    turn = rot.about(np.array([0, 0, 1.0]), np.linspace(0, np.pi / 2, 120))
    rotations = motion.rotations.copy()
    rotations[:, 0] = turn
    turned = motion.replace(rotations=rotations, root_positions=motion.root_positions * [0, 0, 1])
    yaws = [step.yaw for step in steps_of(turned, Body.of(turned.skeleton)) if step.foot == "left"]
    assert len(yaws) > 2
    assert np.ptp(yaws) > 0.8


def test_without_a_body_there_are_no_feet() -> None:
    assert steps_of(walker(), None) == []
