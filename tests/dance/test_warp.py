"""The time warp: its limits hold between any two times, and stops come to their beats."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from onbeat._shapes import Array, Times
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.warp import FASTEST, KNOT, REACH, SLOWEST, SPEED, Warp, fit_warp, pair_stops

NOWHERE, ONE = np.zeros(0), np.array([3.0])
rates_of_moves = st.lists(st.sampled_from([0.85, 0.925, 1.0, 1.075, 1.15]), min_size=4, max_size=4)
few = st.lists(st.floats(0.0, 2.0), max_size=6, unique=True)
times = st.lists(st.floats(0.05, 11.9), max_size=40, unique=True).map(lambda values: np.array(sorted(values)))


def plan_of(rates: list[float], length: float = 3.0) -> DancePlan:
    """Moves of ``length`` seconds, each of a clip of its own."""
    moves = [Move(k, 1.0, 1.0 + rate * length, k * length, rate) for k, rate in enumerate(rates)]
    return DancePlan(tuple(moves), length * len(rates))


def still(plan: DancePlan, speed: float = 0.0) -> tuple[Times, Array]:
    """A hand that always moves at the same speed, for which no limit of speed matters."""
    clock = np.arange(0.0, plan.duration, 1 / 60)
    return clock, np.full(len(clock), speed)


def slopes_of(warp: Warp, plan: DancePlan, seed: int) -> Array:
    """Plan seconds a dance second between random pairs of dance times."""
    pairs = np.random.default_rng(seed).uniform(0.0, plan.duration, (400, 2))
    pairs = pairs[np.abs(pairs[:, 1] - pairs[:, 0]) > 1e-3]
    return (warp(pairs[:, 1]) - warp(pairs[:, 0])) / (pairs[:, 1] - pairs[:, 0])


@settings(max_examples=40, deadline=None)
@given(stops=times, beats=times, rates=rates_of_moves)
def test_rates_stay_within_bounds_between_any_two_times(stops: Times, beats: Times, rates: list[float]) -> None:
    plan = plan_of(rates)
    warp = fit_warp(plan, stops, beats, *still(plan, 0.5))
    slopes = slopes_of(warp, plan, len(stops))
    assert slopes.min() >= SLOWEST / max(rates) - 1e-6
    assert slopes.max() <= FASTEST / min(rates) + 1e-6
    assert np.all(np.diff(warp.values) > 0)
    assert (warp.values[0], warp.values[-1]) == (0.0, pytest.approx(plan.duration, abs=1e-9))


@settings(max_examples=30, deadline=None)
@given(stops=times, beats=times, rates=rates_of_moves)
def test_clips_play_within_the_bounds_too(stops: Times, beats: Times, rates: list[float]) -> None:
    plan = plan_of(rates)
    warp = fit_warp(plan, stops, beats, *still(plan))
    clock = np.linspace(0.0, plan.duration - 1e-6, 3000)
    own = np.array(rates)[plan.clip_times(warp(clock))[0]]
    played = own * warp.rates[np.searchsorted(warp.knots, clock, side="right") - 1]
    assert played.min() >= SLOWEST - 1e-6
    assert played.max() <= FASTEST + 1e-6


@settings(max_examples=60, deadline=None)
@given(stops=times, beats=times)
def test_pairs_are_one_to_one_in_order_and_near(stops: Times, beats: Times) -> None:
    pairs = pair_stops(stops, beats)
    for (stop, beat), (later_stop, later_beat) in itertools.pairwise(pairs):
        assert stop < later_stop
        assert beat < later_beat
    assert all(abs(stops[stop] - beats[beat]) < REACH for stop, beat in pairs)


@settings(max_examples=40, deadline=None)
@given(
    stops=st.lists(st.floats(0.0, 2.0), max_size=6, unique=True),
    beats=st.lists(st.floats(0.0, 2.0), max_size=6, unique=True),
)
def test_pairs_are_the_best_of_all(stops: list[float], beats: list[float]) -> None:
    heard, seen = np.array(sorted(beats)), np.array(sorted(stops))

    def worth(chosen: list[tuple[int, int]]) -> float:
        return sum(max(0.0, 1 - ((seen[i] - heard[j]) / REACH) ** 2) for i, j in chosen)

    every = (
        worth(list(zip(left, right, strict=True)))
        for count in range(min(len(seen), len(heard)) + 1)
        for left in itertools.combinations(range(len(seen)), count)
        for right in itertools.combinations(range(len(heard)), count)
    )
    assert worth(pair_stops(seen, heard)) == pytest.approx(max(every), abs=1e-9)


@settings(max_examples=30, deadline=None)
@given(arrays(float, 300, elements=st.floats(0.0, 3.0)), times, times)
def test_the_fastest_hand_hardly_gets_faster(speeds: Array, stops: Times, beats: Times) -> None:
    plan = plan_of([1.0] * 4)
    clock = np.linspace(0.0, plan.duration, len(speeds))
    warp = fit_warp(plan, stops, beats, clock, speeds)
    middles = (warp.knots[:-1] + warp.knots[1:]) / 2
    rates = np.maximum(warp.rates, 1.0)  # where time runs no faster, no hand does
    now = np.interp(warp(middles), clock, speeds)
    tried = np.interp(
        np.clip(middles[:, None] + np.arange(-REACH, REACH + 0.01, 0.06), 0, plan.duration - 1e-6), clock, speeds
    )
    known = np.minimum(now, tried.max(axis=1))
    assert np.all(rates * known <= SPEED * speeds.max() + 1e-6)


def test_a_dance_on_the_beat_is_left_as_it_is() -> None:
    plan, beats = plan_of([1.0] * 4), np.arange(0.5, 12.0, 0.5)
    warp = fit_warp(plan, beats, beats, *still(plan))
    assert np.abs(warp.rates - 1).max() < 1e-6


@pytest.mark.parametrize(
    ("stops", "beats"), [(NOWHERE, NOWHERE), (np.array([3.0]), NOWHERE), (NOWHERE, np.array([3.0]))]
)
def test_without_pairs_nothing_is_done(stops: Times, beats: Times) -> None:
    plan = plan_of([1.0, 1.0])
    warp = fit_warp(plan, stops, beats, *still(plan))
    assert np.abs(warp(np.array([0.7, 5.0])) - [0.7, 5.0]).max() < 1e-12


def test_stops_near_beats_come_to_them() -> None:
    beats = np.arange(0.6, 11.5, 0.6)
    stops = beats + 0.06 * np.sin(np.arange(len(beats)))
    plan = plan_of([1.0] * 4)
    warp = fit_warp(plan, stops, beats, *still(plan, 0.2))
    before, after = np.abs(stops - beats), np.abs(warp.inverse(stops) - beats)
    assert after.max() < 0.02
    assert after.mean() < 0.3 * before.mean()


def test_a_stop_beyond_reach_is_left_alone() -> None:
    plan = plan_of([1.0, 1.0])
    warp = fit_warp(plan, np.array([3.0]), np.array([3.0 + REACH + 0.01]), *still(plan))
    assert np.abs(warp.rates - 1).max() < 1e-9


@settings(max_examples=30, deadline=None)
@given(stops=times, beats=times)
def test_the_inverse_undoes_the_warp(stops: Times, beats: Times) -> None:
    plan = plan_of([1.0] * 4)
    warp = fit_warp(plan, stops, beats, *still(plan))
    clock = np.linspace(0.0, plan.duration, 200)
    assert np.abs(warp.inverse(warp(clock)) - clock).max() < 1e-9
    assert np.diff(warp.knots).max() < 1.5 * KNOT


def test_the_shortest_dance_can_be_warped() -> None:
    plan = plan_of([1.0], length=0.1)
    assert fit_warp(plan, np.array([0.05]), np.array([0.06]), *still(plan)).values[-1] == pytest.approx(0.1)


def test_a_fast_move_is_not_played_faster_wherever_the_warp_puts_it() -> None:
    """The bounds hold for what is seen: a fast move that the warp brings forward has its own bound there."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        starts = np.concatenate(([0.0], np.cumsum(rng.uniform(0.8, 1.6, 12))))
        rates = rng.choice([0.87, 1.0, 1.1], 12)
        moves = [
            Move(0, 0.0, float(rate * (end - start)), float(start), float(rate))
            for start, end, rate in zip(starts[:-1], starts[1:], rates, strict=True)
        ]
        plan = DancePlan(tuple(moves), float(starts[-1]))
        beats = np.arange(0.3, plan.duration, 0.5)
        stops = np.sort(np.clip(beats + rng.uniform(-0.14, 0.14, len(beats)), 0.05, plan.duration - 0.05))
        warp = fit_warp(plan, stops, beats, np.zeros(0), np.zeros(0))
        fine = np.arange(0.0, plan.duration, 0.002)
        own = np.array([move.rate for move in plan.moves])[plan.clip_times(warp(fine))[0]]
        step = np.clip(np.searchsorted(warp.knots, fine, side="right") - 1, 0, len(warp.rates) - 1)
        seen = warp.rates[step] * own
        assert seen.min() >= SLOWEST - 1e-6
        assert seen.max() <= FASTEST + 1e-6
