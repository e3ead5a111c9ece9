"""A dance that follows beats as they come."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.limits.limits import Limits
from onbeat.motion.joint_angles import JointAngles
from onbeat.retime.sources import Table
from onbeat.retime.stream import PACE, Follower


def swinging(limit: float = 9.0) -> Follower:
    seconds = np.arange(0, 40, 1 / 60)
    angles = np.stack((np.sin(2 * np.pi * seconds), 0.5 * np.cos(3 * seconds)), axis=1)
    limits = Limits("arm", ("shoulder", "elbow"), [-1.2, -1.2], [1.2, 1.2], [limit, limit], [90.0, 90.0])
    return Follower.of(Table(JointAngles(("shoulder", "elbow"), angles, 60)), limits, np.arange(0.25, 40, 0.5))


def test_the_dance_is_where_the_beats_say_once_it_got_there():
    follower = swinging()
    follower.push(np.array([0.0, 0.5]), np.array([0.0, 0.55]))
    follower.pull(np.arange(0, 4, 0.01))
    assert follower.own(np.array([4.0]))[0] == pytest.approx(4.4, abs=1e-3)


def test_limits_are_kept_and_nothing_jumps_while_the_tempo_steps():
    follower, rng = swinging(5.0), np.random.default_rng(0)
    own, poses = 0.0, []
    for block in range(100):
        now = block / 10
        if block % 7 == 0:
            rate = rng.uniform(0.8, 1.2)
            follower.push(np.array([now, now + 1]), np.array([own, own + rate]))
        poses.append(follower.pull(now + np.arange(100) / 1000))
        own += rate / 10
    steps = np.abs(np.diff(np.concatenate(poses), axis=0)) * 1000
    assert steps.max() <= 5.0 + 1e-6


def test_a_prediction_that_jumps_is_caught_up_with_at_a_bounded_pace():
    follower = swinging()
    follower.push(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    follower.pull(np.arange(0, 2, 0.01))
    follower.push(np.array([2.0, 3.0]), np.array([3.0, 4.0]))
    at = np.arange(2, 6, 0.01)
    own = []
    for time in at:
        follower.pull(np.array([time]))
        own.append(follower.own(np.array([time]))[0])
    rates = np.diff(own) / 0.01
    assert rates.max() <= 1 + PACE + 1e-6
    assert own[-1] == pytest.approx(at[-1] + 1, abs=1e-3)


def test_how_it_is_asked_does_not_change_what_is_danced():
    times = np.arange(0, 3, 0.005)
    at_once, by_one = swinging(), swinging()
    one = at_once.pull(times)
    other = np.concatenate([by_one.pull(times[k : k + 1]) for k in range(len(times))])
    assert np.abs(one - other).max() < 1e-12


@pytest.mark.parametrize(
    ("music", "dance"),
    [([0.0], [0.0]), ([0, 1], [0]), ([1, 0], [0, 1]), ([0, 1], [1, 1]), ([0, np.nan], [0, 1]), ([0, np.inf], [0, 1])],
)
def test_seconds_that_cannot_be_are_refused_and_the_last_ones_stay(music, dance):
    follower = swinging()
    before = follower.expected(np.array([3.0]))
    with pytest.raises(PlanError, match="second"):
        follower.push(np.array(music, dtype=float), np.array(dance, dtype=float))
    assert np.array_equal(follower.expected(np.array([3.0])), before)


def test_a_pose_that_is_over_is_refused():
    follower = swinging()
    follower.pull(np.array([1.0]))
    with pytest.raises(PlanError, match="over"):
        follower.pull(np.array([0.5]))
