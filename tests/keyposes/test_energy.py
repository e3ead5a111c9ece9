"""Eqs. 1 and 2 on motions of which the energy is known."""

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.keyposes.energy import KINDS, Energy, energy_of, speed
from onbeat.keyposes.points import Points


def points(positions: np.ndarray, fps: float = 120.0, weights: np.ndarray | None = None) -> Points:
    count, number = positions.shape[:2]
    turns = np.tile([1.0, 0, 0, 0], (count, 1))
    shares = np.full(number, 1 / number) if weights is None else weights
    names = tuple(f"p{k}" for k in range(number))
    seen = np.ones((count, number), bool)
    none = np.zeros(0, np.int64)
    return Points(names, positions, seen, turns, np.zeros((count, 3)), shares, none, none, fps)


def straight(velocities: np.ndarray, seconds: float = 3.0, fps: float = 120.0) -> np.ndarray:
    times = np.arange(round(seconds * fps)) / fps
    return times[:, None, None] * velocities[None]


TWO = np.array([[3.0, 0, 0], [0, 4.0, 0]])


@pytest.mark.parametrize(("kind", "expected"), [("paper", 2.5), ("sum", 3.5), ("rms", np.sqrt(12.5))])
def test_each_kind_is_its_equation_on_straight_paths(kind: str, expected: float) -> None:
    found = speed(straight(TWO), np.full((360, 2), 0.5), kind, 120.0, 0.05)
    assert found[60:-60] == pytest.approx(expected, rel=1e-9)


def test_opposing_limbs_cancel_as_printed_and_only_there() -> None:
    apart = straight(np.array([[1.0, 0, 0], [-1.0, 0, 0]]))
    weights = np.full((360, 2), 0.5)
    middle = {kind: float(speed(apart, weights, kind, 120.0, 0.05)[180]) for kind in KINDS}
    assert middle["paper"] == pytest.approx(0.0, abs=1e-12)
    assert middle["rms"] == pytest.approx(1.0)
    assert middle["sum"] == pytest.approx(1.0)


def test_weights_are_shares() -> None:
    found = speed(straight(TWO), np.tile([0.8, 0.2], (360, 1)), "paper", 120.0, 0.05)
    assert found[180] == pytest.approx(np.hypot(2.4, 0.8))


def test_a_point_that_is_not_seen_does_not_count() -> None:
    weights = np.full((360, 2), 0.5)
    weights[100:200, 1] = 0.0
    found = speed(straight(TWO), weights, "sum", 120.0, 0.05)
    assert found[150] == pytest.approx(3.0)
    assert found[300] == pytest.approx(3.5)


def test_energy_is_in_units_of_its_mean() -> None:
    times = np.arange(600) / 120.0
    swing = np.zeros((600, 2, 3))
    swing[:, 0, 2] = 0.3 * np.sin(2 * np.pi * times)
    found = energy_of(points(swing))
    assert found.world.mean() == pytest.approx(1.0)
    assert found.world.max() == pytest.approx(np.pi / 2, rel=0.04)  # a sine's highest speed over its mean one


def test_the_body_centre_frame_takes_away_how_the_body_moves_as_a_whole() -> None:
    count = 600
    times = np.arange(count) / 120.0
    base = points(np.zeros((count, 2, 3)))
    origins = np.stack([times, np.sin(times), 0 * times], axis=-1)
    half = 0.4 * times
    turns = np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=-1)
    yaw = 2 * half
    arm = np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1)
    moving = np.stack([origins + arm, origins - 0.5 * arm], axis=1)
    carried = Points(base.names, moving, base.seen, turns, origins, base.weights, base.hands, base.feet, 120.0)
    assert np.abs(speed(carried.local(), carried.seen * carried.weights, "sum", 120.0, 0.05)).max() < 1e-9
    assert speed(moving, carried.seen * carried.weights, "sum", 120.0, 0.05)[300] > 0.5


def test_a_body_at_rest_has_no_energy() -> None:
    found = energy_of(points(np.ones((100, 2, 3))))
    assert not found.world.any()
    assert not found.local.any()


def test_an_unknown_kind_is_refused_by_name() -> None:
    with pytest.raises(BodyError, match="no energy 'kinetic'; there are rms, sum, paper"):
        energy_of(points(np.ones((10, 2, 3))), "kinetic")


def test_curves_cannot_be_changed() -> None:
    curve = Energy(np.zeros(3), np.ones(3), np.ones(3)).world
    with pytest.raises(ValueError, match="read-only"):
        curve[0] = 2.0
