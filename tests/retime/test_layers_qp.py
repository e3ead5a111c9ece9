import numpy as np
import pytest

from demands import FREE, curves, demand, swing
from onbeat.retime.bspline import Spline
from onbeat.retime.layers2007 import Layered, lower
from onbeat.retime.layers_qp import Products, weigh
from onbeat.retime.measures import TOLERANCE, measure

FINE = 0.5 * swing(8, hertz=0.5) + 0.1 * swing(8, hertz=4)
KEYPOSES = np.arange(0.5, 8, 1.0)


def products(fps: float = 60.0, beats: float = 2.0, seconds: float = 4.0) -> Products:
    layered = Layered.of(demand(curves(0, int(seconds * fps) + 1, 2, fps, min(3, fps / 6)), fps=fps, beats=beats))
    return Products(layered.beats, layered.values)


def test_blends_are_a_partition_of_unity_with_one_on_every_beat():
    made = products()
    assert made.count == 9
    np.testing.assert_allclose(made.blends.sum(axis=1), 1, atol=1e-12)
    on_beats = made.blends[::30]
    np.testing.assert_allclose(on_beats, np.eye(9), atol=1e-9)


@pytest.mark.parametrize("seconds", [0.5, 1.0, 4.0])
@pytest.mark.parametrize(
    ("fps", "beats"), [(60.0, 2.0), (120.0, 2.0), (60.0, 3.3), (30.0, 3.0), (10.0, 3.0), (10.0, 9.0)]
)
def test_the_matrix_of_control_points_is_the_spline_through_the_weighted_layers(
    fps: float, beats: float, seconds: float
):
    """Exactly, at a low rate, too, where a beat is few frames and splines reach over it."""
    made = products(fps, beats, seconds)
    weights = np.random.default_rng(0).uniform(0, 1, (made.count, 7))
    frames = len(made.beats)
    steps = np.concatenate(([0.0], made.beats, made.beats[-1:]))
    for channel in (0, 1):
        samples = np.einsum("fm,mi,fi->f", made.blends, weights, made.values[:, :, channel])
        wanted = Spline.through(samples[:, None], 1.0).controls[:, 0]
        found = made.matrix(made.controls[..., channel], steps) @ weights.ravel()
        assert found.shape == (frames + 2,)
        assert np.abs(found - wanted).max() < 1e-7


def test_where_nothing_is_past_nothing_is_changed_to_the_last_bit():
    asked = demand(FINE, -2, 2, 50.0, keyposes=KEYPOSES)
    answer = weigh(asked)
    np.testing.assert_array_equal(answer.trajectory.controls, asked.wish.controls)
    assert answer.weights is not None
    np.testing.assert_allclose(answer.weights, 1, atol=1e-12)


def test_weights_are_shares_and_make_the_trajectory():
    asked = demand(FINE, speed=2.5, keyposes=KEYPOSES)
    answer = weigh(asked)
    assert answer.weights is not None
    assert answer.weights.min() >= -1e-12
    assert answer.weights.max() <= 1 + 1e-12
    layered = Layered.of(asked)
    rest = asked.wish.samples - layered.mean - layered.values.sum(axis=1)
    values = np.concatenate((layered.values, rest[:, None]), axis=1)
    total = layered.mean + (answer.weights * values).sum(axis=1)
    np.testing.assert_allclose(answer.trajectory.samples, total, atol=1e-9)


def test_detail_goes_and_the_coarse_stays():
    answer = weigh(demand(FINE, speed=2.5, keyposes=KEYPOSES))
    assert answer.weights is not None
    mean = answer.weights[:, :, 0].mean(axis=0)
    assert mean[:3].min() > 0.9
    assert mean[4:6].min() < 0.7


@pytest.mark.parametrize("seed", range(6))
def test_limits_hold_and_the_error_is_less_than_that_of_lowering(seed: int):
    wish = curves(seed, 400, 2)
    fast = np.abs(np.diff(wish, axis=0)).max(axis=0) * 60
    reach = np.abs(wish - wish.mean(axis=0)).max(axis=0)
    asked = demand(wish, wish.mean(axis=0) - 0.9 * reach, wish.mean(axis=0) + 0.9 * reach, 0.6 * fast)
    found, other = measure(asked, weigh(asked).trajectory), measure(asked, lower(asked).trajectory)
    assert found.violations == other.violations == (0, 0)
    assert (found.rms < other.rms).all()


@pytest.mark.parametrize("speed", [5.0, 20.0, 60.0])
def test_a_high_speed_is_kept_as_exactly_as_a_low_one(speed: float):
    """The tolerance of a limit is in rad/s, that of the solver a share of it."""
    asked = demand(speed / 4 * swing(8), speed=speed, keyposes=KEYPOSES)
    found = measure(asked, weigh(asked).trajectory)
    assert 0 <= found.velocity_excess[0] <= TOLERANCE
    assert found.plateaus[0] > 0, "else the limit is not met"


def test_keyposes_that_can_be_kept_are_kept():
    wish = swing(6) + 0.3 * swing(6, hertz=3)
    keyposes = np.arange(0.25, 6, 0.5)
    asked = demand(wish, speed=8.0, keyposes=keyposes)
    found = measure(asked, weigh(asked).trajectory)
    assert found.feasible.all()
    assert found.violations == (0, 0)
    assert np.degrees(found.worst_keypose) < 1.5
    assert found.rms[0] > 2 * found.worst_keypose


@pytest.mark.parametrize(
    "bounds",
    [
        {"low": 0.3, "high": 0.3},
        {"low": 5.0, "high": 6.0},
        {"low": 0.5, "speed": 3.0},
        {"high": 0.5},
        {"high": -3.0},
        {"speed": 1e-9},
        {"speed": 1e-3},
        {"low": -1e-10, "high": 1e-10},
        {"low": -1e-5, "high": 1e-5, "speed": 1e-4},
    ],
    ids=str,
)
def test_whatever_the_bounds_the_mean_is_always_an_answer(bounds: dict):
    asked = demand(swing(), keyposes=[0.25, 1.0], **bounds)
    assert measure(asked, weigh(asked).trajectory).violations == (0, 0)


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 10])
@pytest.mark.parametrize("beats", [0.05, 2.0, 30.0])
def test_a_few_frames_and_any_pulse_are_enough(frames: int, beats: float):
    samples = np.linspace(0, 3, frames) if frames > 1 else np.array([3.0])
    asked = demand(samples, -1.0, 1.0, 2.0, keyposes=[0.0], beats=beats)
    assert measure(asked, weigh(asked).trajectory).violations == (0, 0)


@pytest.mark.parametrize(("fps", "beats"), [(10.0, 3.0), (15.0, 2.0), (24.0, 5.0), (60.0, 30.0)])
def test_at_a_low_rate_and_a_fast_pulse_limits_hold_as_well(fps: float, beats: float):
    wish = np.sin(np.arange(0, 6, 1 / fps) * 6)
    asked = demand(wish, -0.9, 0.9, 4.0, fps=fps, beats=beats)
    assert measure(asked, weigh(asked).trajectory).violations == (0, 0)


def test_a_constant_out_of_range_is_brought_inside():
    asked = demand(np.full(200, 4.0), -1.0, 1.0, 2.0)
    found = weigh(asked).trajectory
    assert measure(asked, found).violations == (0, 0)
    assert found.samples.min() > 0.99


def test_free_joints_stay_as_they_are():
    wish = np.stack((FINE, FINE), axis=1)
    asked = demand(wish, speed=(2.5, FREE))
    np.testing.assert_array_equal(weigh(asked).trajectory.controls[:, 1], asked.wish.controls[:, 1])


def test_progress_is_told():
    told = list[float]()
    weigh(demand(np.stack((FINE, FINE), axis=1), speed=2.5), told.append)
    assert told == [0.0, 0.5, 1.0]
