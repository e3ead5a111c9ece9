"""The least-squares problem of a whole dance."""

import numpy as np
import pytest

from onbeat.robots.ik.collision import capsules_of
from onbeat.robots.ik.directions import aims_of
from onbeat.robots.ik.trajectory import Normal, Problem, Rules, _state, solve  # pyright: ignore[reportPrivateUsage]
from onbeat.robots.ik.tree import ROOT, tree_of
from onbeat.robots.model import robot_named

pytest.importorskip("mujoco")


@pytest.fixture(scope="module")
def problem(swinger) -> Problem:
    robot = robot_named("g1")
    body, capsules, dancer = robot.body, capsules_of(robot), swinger[:12]
    wide, every = np.full(ROOT, np.inf), np.ones(ROOT + 29)
    low, high = np.concatenate((-wide, body.low)), np.concatenate((wide, body.high))
    speed = np.concatenate((wide, body.speed))
    rules = Rules(low, high, 0 * every, 0.03 * every, 0.02 * every, 0.005 * every, speed, 10.0)
    return Problem(tree_of(body), aims_of(dancer, robot), capsules, rules, np.ones((12, len(capsules.pairs))), 1 / 60)


def start(problem: Problem) -> np.ndarray:
    rng = np.random.default_rng(4)
    x = rng.normal(size=(12, ROOT + 29)) * 0.05 + 0.2
    return np.clip(x, problem.rules.low, problem.rules.high)


def test_the_slope_is_half_the_derivative_of_the_cost(problem):
    x = start(problem)
    slope = _state(problem, x).normal.slope.reshape(x.shape)
    rng = np.random.default_rng(5)
    for _ in range(5):
        way = rng.normal(size=x.shape)
        ahead, behind = (_state(problem, x + sign * 1e-6 * way).cost for sign in (1, -1))
        # Turning errors enter by their Gauss–Newton slope, exact but for the second order of their angle.
        assert np.sum(slope * way) == pytest.approx((ahead - behind) / 4e-6, rel=0.1, abs=0.02)


def test_a_solution_costs_less_and_keeps_bounds(problem):
    x = start(problem)
    found = solve(problem, x)
    assert found.cost < 0.1 * _state(problem, x).cost
    assert (found.x >= problem.rules.low).all()
    assert (found.x <= problem.rules.high).all()


def test_pinned_frames_stay(problem):
    x = start(problem)
    found = solve(problem, x, pinned=(2, 1))
    np.testing.assert_allclose(found.x[[0, 1, -1]], x[[0, 1, -1]], atol=1e-8)
    assert np.abs(found.x[5] - x[5]).max() > 0.01


def test_the_band_is_the_symmetric_matrix_it_stands_for(problem):
    normal: Normal = _state(problem, start(problem)).normal
    assert (normal.band[:, 0] > 0).all()
    assert np.isfinite(normal.band).all()
