import numpy as np
import pytest
from scipy.optimize import minimize

from demands import FREE, curves, demand, swing
from onbeat.errors import PlanError
from onbeat.retime.bspline import Spline
from onbeat.retime.controlpoints import MARGIN, fit
from onbeat.retime.demand import Demand
from onbeat.retime.measures import Measures, measure


def fitted(asked: Demand) -> tuple[Spline, Measures]:
    trajectory = fit(asked).trajectory
    return trajectory, measure(asked, trajectory)


def test_where_nothing_is_past_nothing_is_changed_to_the_last_bit():
    asked = demand(swing(), -1.1, 1.1, 7.0, 50.0, 400.0, [0.25, 0.75])
    np.testing.assert_array_equal(fit(asked).trajectory.controls, asked.wish.controls)


def test_far_from_a_violation_nothing_is_changed_to_the_last_bit():
    samples = 0.2 * np.sin(np.arange(1200) / 30)
    samples[600:620] += 0.6 * np.sin(np.linspace(0, np.pi, 20)) ** 2
    asked = demand(samples, speed=1.5, acceleration=60.0)
    trajectory, found = fitted(asked)
    changed = np.flatnonzero((trajectory.controls != asked.wish.controls)[:, 0]) / 60
    assert found.violations == (0, 0)
    assert len(changed)
    assert changed.min() > 10 - 4 * MARGIN
    assert changed.max() < 10.33 + 4 * MARGIN


@pytest.mark.parametrize("seed", range(6))
def test_all_bounds_hold_between_frames(seed: int):
    wish = curves(seed, 400, 2)
    fast = np.abs(np.diff(wish, axis=0)).max(axis=0) * 60
    asked = demand(wish, wish.min(axis=0) * 0.8 - 0.1, wish.max(axis=0) * 0.8 + 0.1, 0.6 * fast, 8 * fast, 300 * fast)
    trajectory, found = fitted(asked)
    assert found.violations == (0, 0)
    assert (np.abs(trajectory.differences(2)) <= asked.acceleration + 1e-4).all()
    assert (np.abs(trajectory.differences(3)) <= asked.jerk + 1e-2).all()
    assert (measure(asked, asked.wish).velocity_excess > 0).all(), "else there was nothing to do"


def test_it_is_the_best_there_is():
    """Against a general solver on the same programme, which is small here."""
    wish = np.array([0, 0, 0.1, 0.5, 1.0, 0.4, 0.1, 0, 0, 0.0])
    asked = demand(wish, -1.0, 0.8, 0.25 * 60, 0.3 * 3600, fps=60.0)
    c, step = asked.wish.controls[:, 0], 1 / 60

    def rows(d: np.ndarray) -> np.ndarray:
        now = c + d
        inner = np.concatenate(((2 * now[:-1] + now[1:]) / 3, (now[:-1] + 2 * now[1:]) / 3))
        pair, bend = np.diff(now), np.diff(now, 2)
        return np.concatenate((0.8 - inner, inner + 1.0, 0.25 - pair, 0.25 + pair, 0.3 - bend, 0.3 + bend))

    def cost(d: np.ndarray) -> float:
        return float(np.square((d[:-2] + 4 * d[1:-1] + d[2:]) / 6).sum())

    other = minimize(cost, np.zeros(12), constraints={"type": "ineq", "fun": rows}, tol=1e-14, options={"maxiter": 999})
    mine = fit(asked).trajectory.controls[:, 0] - c
    assert (rows(mine) >= -1e-9).all()
    assert step * cost(mine) <= step * cost(other.x) + 1e-6
    np.testing.assert_allclose((mine[:-2] + 4 * mine[1:-1] + mine[2:]) / 6, _at_knots(other.x), atol=3e-3)


def _at_knots(d: np.ndarray) -> np.ndarray:
    return (d[:-2] + 4 * d[1:-1] + d[2:]) / 6


def test_keyposes_that_can_be_kept_are_kept():
    wish = swing(6) + 0.3 * swing(6, hertz=3)
    keyposes = np.arange(0.25, 6, 0.5)
    asked = demand(wish, speed=6.0, acceleration=120.0, keyposes=keyposes)
    _, kept = fitted(asked)
    _, free = fitted(demand(wish, speed=6.0, acceleration=120.0))
    assert kept.violations == free.violations == (0, 0)
    assert kept.feasible.all()
    assert np.degrees(kept.worst_keypose) < 0.5
    trajectory = fit(demand(wish, speed=6.0, acceleration=120.0)).trajectory
    assert np.abs(trajectory(keyposes) - asked.wish(keyposes)).max() > 5 * kept.worst_keypose


def test_a_keypose_out_of_range_is_met_at_the_bound():
    asked = demand(swing(), -0.5, 0.5, 6.0, 100.0, keyposes=[0.25, 0.75])
    trajectory, found = fitted(asked)
    assert not found.feasible.any()
    np.testing.assert_allclose(trajectory(np.array([0.25, 0.75]))[:, 0], [0.5, -0.5], atol=0.01)


def test_a_tighter_speed_costs_more():
    wish = curves(3, 300)
    fast = float(np.abs(np.diff(wish, axis=0)).max() * 60)
    errors = [float(fitted(demand(wish, speed=share * fast))[1].rms[0]) for share in (1.0, 0.8, 0.6, 0.4, 0.2)]
    assert (np.diff(errors) > 0).all()
    assert errors[0] < 1e-4


def test_a_window_without_room_is_widened_till_it_has_some():
    """Half a second of full speed over a way that takes eight: no window about the violation is enough at first."""
    wish = np.concatenate((np.zeros(600), np.linspace(0, 4, 30), np.full(600, 4.0)))
    asked = demand(wish, speed=0.5, acceleration=20.0)
    trajectory, found = fitted(asked)
    assert found.violations == (0, 0)
    moved = np.flatnonzero(np.abs(trajectory.samples - asked.wish.samples)[:, 0] > 1e-3) / 60
    assert moved.min() > 4
    assert moved.max() < 17
    assert trajectory.samples[-1, 0] == pytest.approx(4.0)


@pytest.mark.parametrize(
    "bounds",
    [
        {"low": 0.3, "high": 0.3},
        {"low": 5.0, "high": 6.0},
        {"high": -3.0},
        {"speed": 1e-9},
        {"speed": 1e-3, "acceleration": 1e-3, "jerk": 1e-3},
        {"low": -0.1, "high": 0.1, "speed": 0.01, "acceleration": 0.1, "jerk": 10.0},
        {"jerk": 1e-2},
        {"low": 90.0, "high": 100.0, "speed": 3.0},
    ],
    ids=str,
)
def test_whatever_the_bounds_standing_still_is_always_an_answer(bounds: dict):
    assert fitted(demand(swing(), keyposes=[0.25, 1.0], **bounds))[1].violations == (0, 0)


@pytest.mark.parametrize("frames", [1, 2, 3, 4, 10])
def test_a_few_frames_are_enough(frames: int):
    asked = demand(np.linspace(0, 3, frames) if frames > 1 else np.array([3.0]), -1, 1, 2.0, 50.0, 5000.0, [0.0])
    trajectory, found = fitted(asked)
    assert found.violations == (0, 0)
    assert len(trajectory.samples) == max(frames, 2)


def test_progress_is_told_and_ends():
    told = list[float]()
    fit(demand(curves(0, 200, 3), speed=1.0), told.append)
    assert told == sorted(told)
    assert (told[0], told[-1]) == (0.0, 1.0)


def test_what_is_beyond_all_numbers_is_said_in_words():
    with pytest.raises(PlanError, match="channel 0"):
        fit(demand(1e9 * swing(), -1.0, 1.0, 1.0))


def test_the_same_demand_has_the_same_answer_to_the_last_bit():
    asked = demand(curves(8, 300, 2), speed=1.0, acceleration=20.0, keyposes=[1.0, 2.0])
    np.testing.assert_array_equal(fit(asked).trajectory.controls, fit(asked).trajectory.controls)


def test_more_channels_and_free_ones_do_not_disturb():
    wish = curves(9, 200, 3)
    trajectory = fit(demand(wish, speed=(1.0, FREE, 1.0))).trajectory
    np.testing.assert_allclose(trajectory.samples[:, 1], wish[:, 1], atol=1e-12)
