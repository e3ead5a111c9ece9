import numpy as np
import pytest

from demands import FREE, curves, demand, swing
from onbeat.errors import PlanError
from onbeat.retime.demand import Demand
from onbeat.retime.hierarchy import LAYERS
from onbeat.retime.layers2007 import STEP, Layered, _blending, literal, lower, quintic
from onbeat.retime.measures import measure

FINE = 0.5 * swing(8, hertz=0.5) + 0.1 * swing(8, hertz=4)
"""A slow swing with fast detail."""
KEYPOSES = np.arange(0.5, 8, 1.0)


def test_the_quintic_is_that_of_the_paper():
    t = np.linspace(0, 1, 101)
    np.testing.assert_allclose(quintic(t), 1 - (6 * t**5 - 15 * t**4 + 10 * t**3), atol=1e-12)
    assert (np.diff(quintic(t)) <= 0).all()
    np.testing.assert_allclose(quintic(t) + quintic(1 - t), 1, atol=1e-12)
    h = 1e-4
    ends = np.array([0, h, 2 * h, 1 - 2 * h, 1 - h, 1])
    assert np.abs(np.diff(quintic(ends), 2)[[0, 3]]).max() / h**2 < 0.02, "no velocity and no acceleration at its ends"
    assert quintic(np.array([-5.0, 7.0])).tolist() == [1.0, 0.0]


def test_where_nothing_is_past_all_weights_are_one():
    answer = lower(demand(FINE, -2, 2, 50.0))
    assert answer.weights is not None
    assert (answer.weights == 1).all()
    assert np.abs(answer.trajectory.samples[:, 0] - FINE).max() < 2e-3


def test_fast_music_loses_the_fine_layers_first_and_keeps_the_coarse():
    asked = demand(FINE, speed=2.5, keyposes=KEYPOSES)
    assert np.abs(asked.wish.differences(1)).max() > 3.5
    weights = lower(asked).weights
    assert weights is not None
    mean = weights[:, :, 0].mean(axis=0)
    assert (np.diff(mean) <= 1e-9).all(), "no layer is lowered before all that are finer"
    assert mean[0] > 0.99
    assert mean[-1] < 0.5
    # Within a segment, no layer has less than all while a coarser one has.
    middle = weights[np.round(((np.arange(15) + 0.5) / 2) * 60).astype(int), :, 0]
    assert ((middle[:, 1:] < 1e-9) | (middle[:, :-1] > 1 - 1e-9)).all()


def test_weights_are_lowered_by_tenths_and_blended_between():
    weights = lower(demand(FINE, speed=2.5, keyposes=KEYPOSES)).weights
    assert weights is not None
    assert ((weights >= 0) & (weights <= 1)).all()
    middle = weights[15:-15:30] / STEP  # the middle of a beat is no blend of two
    np.testing.assert_allclose(middle, np.round(middle), atol=1e-6)
    assert np.abs(np.diff(weights, axis=0)).max() < 0.3, "they do not jump at a beat"


def test_only_segments_that_need_it_are_lowered():
    samples = 0.5 * swing(8, hertz=0.5)
    samples[200:230] += 0.1 * np.sin(2 * np.pi * 6 * np.arange(30) / 60)
    weights = lower(demand(samples, speed=2.5)).weights
    assert weights is not None
    touched = np.flatnonzero((weights[:, :, 0] < 1).any(axis=1)) / 60
    assert touched.min() > 2
    assert touched.max() < 5


@pytest.mark.parametrize("seed", range(6))
def test_position_and_velocity_hold_between_frames(seed: int):
    wish = curves(seed, 400, 2)
    fast = np.abs(np.diff(wish, axis=0)).max(axis=0) * 60
    asked = demand(wish, 0.8 * wish.min(axis=0) - 0.1, 0.8 * wish.max(axis=0) + 0.1, 0.5 * fast, keyposes=[1.0, 2.0])
    assert measure(asked, lower(asked).trajectory).violations == (0, 0)


def test_the_guard_keeps_a_joint_far_from_zero_at_its_own_middle():
    """As printed, a coarsest layer that has to shrink draws the joint towards 0 rad."""
    wish = 2.0 + 0.8 * swing(8)
    asked = demand(wish, 1.0, 3.0, 1.5)
    guarded, printed = (measure(asked, method(_reaching_zero(asked, method)).trajectory) for method in (lower, literal))
    assert guarded.violations == (0, 0)
    assert guarded.rms[0] < 0.7
    assert printed.rms[0] > 2 * guarded.rms[0]


def _reaching_zero(asked: Demand, method: object) -> Demand:
    """The literal method ends at 0 rad, which has to be a position."""
    if method is lower:
        return asked
    return demand(asked.wish.samples, -0.1, 3.0, 1.5)


def test_the_literal_method_says_so_where_zero_is_no_position():
    with pytest.raises(PlanError, match="channel 0: its limits are past with all layers taken away"):
        literal(demand(2.0 + 0.8 * swing(8), 1.0, 3.0, 1.5))


def test_the_literal_layers_are_the_papers_five_about_zero():
    asked = demand(1.0 + FINE)
    five, seven = Layered.of(asked, guarded=False), Layered.of(asked)
    assert (five.values.shape[1], seven.values.shape[1]) == (LAYERS, LAYERS + 2)
    assert five.mean[0] == 0
    assert seven.mean[0] == pytest.approx((1.0 + FINE).mean())
    for layered in (five, seven):
        total = layered.mean + layered.values.sum(axis=1)
        assert np.abs(total[:, 0] - 1.0 - FINE).max() < 3e-3


@pytest.mark.parametrize(
    "bounds",
    [
        {"low": 0.3, "high": 0.3},
        {"low": 0.7 / 3, "high": 0.7 / 3, "speed": 1.0},
        {"low": 5.0, "high": 6.0},
        {"low": 0.5},
        {"high": -3.0},
        {"speed": 1e-9},
        {"low": -1e-10, "high": 1e-10},
    ],
    ids=str,
)
def test_whatever_the_bounds_the_mean_is_always_an_answer(bounds: dict):
    asked = demand(swing(), **bounds)
    assert measure(asked, lower(asked).trajectory).violations == (0, 0)


def test_a_channel_that_needs_its_neighbours_lowered_lowers_no_other_channels():
    hard = np.where(np.arange(241) < 120, 0.0, 3.0)
    easy = 0.5 * swing() + 0.2 * swing(hertz=5)
    both = lower(demand(np.stack((hard, easy), axis=1), speed=2.0)).weights
    alone = lower(demand(easy, speed=2.0)).weights
    assert both is not None
    assert alone is not None
    np.testing.assert_allclose(both[:, :, 1], alone[:, :, 0], atol=1e-12)


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 10])
@pytest.mark.parametrize("beats", [0.05, 2.0, 30.0])
def test_a_few_frames_and_any_pulse_are_enough(frames: int, beats: float):
    samples = np.linspace(0, 3, frames) if frames > 1 else np.array([3.0])
    asked = demand(samples, -1.0, 1.0, 2.0, beats=beats)
    answer = lower(asked)
    assert measure(asked, answer.trajectory).violations == (0, 0)
    assert answer.weights is not None
    assert len(answer.weights) == max(frames, 2)


def test_blending_goes_from_one_beat_to_the_next_about_the_border_between():
    beats = np.linspace(0, 3, 301)
    first, second, share = _blending(beats, 3)
    assert (first <= second).all()
    at = np.searchsorted(beats, [0.5, 0.9, 1.0 - 1e-9, 1.1, 1.5, 2.5])
    assert first[at].tolist() == [0, 0, 0, 0, 1, 2]
    assert second[at].tolist() == [0, 1, 1, 1, 1, 2]
    assert share[at[2]] == pytest.approx(0.5)
    assert share[at[1]] > 0.5 > share[at[3]]


def test_a_beat_that_is_a_rounding_error_late_is_no_segment_of_its_own():
    first = Layered.of(demand(FINE))
    late = Layered.of(demand(FINE, begin=-1e-15))
    assert first.segments == late.segments
    np.testing.assert_allclose(first.beats, late.beats, atol=1e-9)


def test_progress_is_told():
    told = list[float]()
    lower(demand(FINE, speed=2.5), told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_free_joints_stay_as_they_are():
    answer = lower(demand(np.stack((FINE, FINE), axis=1), speed=(2.5, FREE)))
    assert answer.weights is not None
    assert (answer.weights[:, :, 1] == 1).all()
