"""The forward filter is exact: it agrees with a filter that moves every state by hand."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.streaming.forward import LEAP, RESTART, ForwardFilter
from onbeat.music.tempo import beat_space

SMALL = 8.0  # [Hz], for 11 intervals of 2 to 12 frames


def by_hand(log_odds: np.ndarray, sounding: np.ndarray, steadiness: float, weight: float) -> list[float]:
    """Log evidence of each frame, from a table of all states (kind, age)."""
    space = beat_space(SMALL, steadiness)
    prior = np.exp(space.log_prior)
    prior /= prior.sum()
    change = (1.0 - LEAP) * np.exp(space.log_change) + LEAP * prior
    slowness = np.exp(weight * space.log_prior / space.rate)
    start = prior / (prior @ space.intervals)
    states = {(k, age): start[k] for k, length in enumerate(space.intervals) for age in range(length)}

    def weight_of(states: dict[tuple[int, int], float]) -> float:
        return sum(value * slowness[k] ** age for (k, age), value in states.items())

    gained, total = [], 1.0
    for odds, sound in zip(log_odds, sounding, strict=True):
        moved = {(k, age + 1): value for (k, age), value in states.items() if age + 1 < space.intervals[k]}
        ended = np.array([states[k, length - 1] for k, length in enumerate(space.intervals)])
        if sound:
            ended = ended * slowness ** (space.intervals - 1)
            born = (ended @ change + RESTART * total * prior) * np.exp(odds)
        else:
            born = ended
        states = moved | {(k, 0): float(value) for k, value in enumerate(born)}
        gained.append(float(np.log(weight_of(states) / total)))
        total = weight_of(states)
    return gained


@pytest.mark.parametrize("seed", range(4))
def test_equals_moving_every_state(seed: int) -> None:
    rng = np.random.default_rng(seed)
    log_odds = rng.normal(-0.5, 2.0, 60)
    sounding = (rng.random(60) > 0.2).astype(float)
    filter = ForwardFilter(SMALL, 5.0, 1.0)
    gained = [filter.step(float(odds), float(sound)) for odds, sound in zip(log_odds, sounding, strict=True)]
    np.testing.assert_allclose(gained[1:], by_hand(log_odds, sounding, 5.0, 1.0)[1:], rtol=1e-6, atol=1e-9)


def pulses(frames: int, interval: int) -> np.ndarray:
    heard = np.full(frames, -1.5)
    heard[::interval] = 3.0
    return heard


def run(filter: ForwardFilter, log_odds: np.ndarray, sounding: float = 1.0) -> None:
    for value in log_odds:
        filter.step(float(value), sounding)


@pytest.mark.parametrize("interval", [33, 47, 50, 61, 80])
def test_finds_period_and_phase(interval: int) -> None:
    filter = ForwardFilter(100.0)
    run(filter, pulses(8 * interval + 10, interval))
    best = filter.best()
    near = filter.near(best.period, best.ahead)
    assert near.period == pytest.approx(interval, abs=0.6)
    assert near.ahead == pytest.approx(interval - 9, abs=1.0)
    assert near.share > 0.6


def test_a_step_of_the_tempo_is_followed() -> None:
    filter = ForwardFilter(100.0)
    run(filter, np.concatenate([pulses(600, 60), pulses(46 * 6, 46)]))
    assert filter.best().period == pytest.approx(46, rel=0.08)


def test_tempi_rest_while_nothing_sounds() -> None:
    filter = ForwardFilter(100.0, steadiness=40.0, prior_weight=3.0)
    run(filter, pulses(501, 50))
    run(filter, np.zeros(500), sounding=0.0)
    guess = filter.near(50.0, 50.0)
    assert guess.share > 0.3
    assert guess.period == pytest.approx(50.0, abs=0.5)


@pytest.mark.parametrize("value", [-200.0, 0.0, 200.0, 600.0])
def test_odd_evidence_leaves_it_finite(value: float) -> None:
    filter = ForwardFilter(100.0)
    run(filter, np.full(2000, value))
    run(filter, pulses(1000, 50))
    best = filter.best()
    assert np.isfinite([best.period, best.ahead, best.share]).all()
    assert best.period == pytest.approx(50, rel=0.08)


def test_shares_are_shares() -> None:
    filter = ForwardFilter(100.0)
    rng = np.random.default_rng(0)
    for _ in range(300):
        filter.step(float(rng.normal(0.0, 3.0)), 1.0)
        assert 0.0 <= filter.best().share <= 1.0 + 1e-9
        assert 0.0 <= filter.near(50.0, 10.0).share <= 1.0 + 1e-9
