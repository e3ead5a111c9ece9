import numpy as np
import pytest

from demands import FREE, demand, swing
from onbeat.retime.demand import Demand
from onbeat.retime.reach import keyposes_of

LINE = np.linspace(0, 4, 241)
"""1 rad/s for four seconds."""


def feasible(asked: Demand) -> list[bool]:
    return keyposes_of(asked).feasible[:, 0].tolist()


def test_what_is_wanted_is_the_wish_and_what_is_aimed_at_is_inside():
    asked = keyposes_of(demand(swing(), -0.5, 0.5, keyposes=[0.25, 0.5, 0.75]))
    np.testing.assert_allclose(asked.wanted[:, 0], [1, 0, -1], atol=1e-5)
    np.testing.assert_allclose(asked.aims[:, 0], [0.5, 0, -0.5], atol=1e-5)
    assert asked.feasible[:, 0].tolist() == [False, True, False]


def test_keyposes_past_the_dances_ends_are_none():
    assert keyposes_of(demand(swing(), keyposes=[-1.0, 0.0, 2.0, 4.0, 4.1])).times.tolist() == [0.0, 2.0, 4.0]


@pytest.mark.parametrize(("speed", "good"), [(0.9, False), (1.001, True), (FREE, True)])
def test_keyposes_on_a_slope_need_its_speed(speed: float, good: bool):
    assert feasible(demand(LINE, speed=speed, keyposes=[1.0, 2.0, 3.0])) == [good] * 3


def test_a_keypose_may_be_out_of_reach_from_one_side_alone():
    samples = np.concatenate((np.zeros(60), np.linspace(0, 2, 30), np.full(91, 2.0)))
    assert feasible(demand(samples, speed=1.0, keyposes=[0.5, 1.0, 1.5, 2.5])) == [True, False, False, True]


def test_from_an_aim_that_is_nearer_it_can_be_reached():
    """The one before is out of range, so that the way from where it is brought to is shorter."""
    samples = np.interp(np.arange(121) / 60, [0, 0.5, 1.5, 2], [3, 3, 0, 0])
    assert feasible(demand(samples, high=0.5, speed=1.0, keyposes=[0.5, 1.5])) == [False, True]


def test_the_speed_of_the_time_between_is_what_counts():
    speed = np.where(np.arange(242) < 121, 0.5, 2.0)[:, None]
    assert feasible(demand(LINE, speed=speed, keyposes=[0.5, 1.5, 2.5, 3.5])) == [False, False, True, True]


@pytest.mark.parametrize(("frame", "good"), [(59, False), (60, True), (61, False)])
def test_a_frames_speed_is_that_of_the_pair_about_it(frame: int, good: bool):
    speed = np.full((242, 1), 0.01)
    speed[frame + 1] = 60.0
    jump = np.where(np.arange(241) <= 60, 0.0, 0.5)
    assert feasible(demand(jump, speed=speed, keyposes=[1.0, 61 / 60])) == [good, good]


def test_keyposes_between_frames_are_not_taken_to_a_frame():
    assert feasible(demand(LINE, speed=1.0001, keyposes=[1.0, 1.005])) == [True, True]
    assert feasible(demand(LINE, speed=0.9999, keyposes=[1.0, 1.005])) == [False, False]


def test_one_keypose_alone_is_reached():
    assert feasible(demand(LINE, speed=1e-3, keyposes=[2.0])) == [True]


def test_without_keyposes_there_are_none():
    asked = keyposes_of(demand(np.stack((LINE, LINE), axis=1), speed=1.0))
    assert [part.shape for part in asked] == [(0,), (0, 2), (0, 2), (0, 2)]


def test_channels_are_judged_each_for_itself():
    both = np.stack((LINE, 2 * LINE), axis=1)
    assert keyposes_of(demand(both, speed=1.5, keyposes=[1.0, 2.0])).feasible.tolist() == [[True, False]] * 2


def test_joints_without_a_bound_can_do_anything_at_any_rate():
    jump = np.where(np.arange(600) < 300, -100.0, 100.0)
    assert feasible(demand(jump, fps=240.0, keyposes=[1.24, 1.26])) == [True, True]


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_a_few_frames_are_enough(frames: int):
    assert feasible(demand(np.zeros(frames), speed=1.0, keyposes=[0.0, 1 / 60])) == [True, True]
