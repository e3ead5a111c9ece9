"""The level of the beat: chosen by what makes bars."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.music.metrical import in_range, likeliest_level, metrical_levels
from onbeat.music.tempo import beat_space

SPACE = beat_space(100.0, 60.0)


def heard(step: int = 50, strong: float = 3.0, weak: float = -1.0) -> np.ndarray:
    """Log odds with beats every ``step`` frames and something between them."""
    odds = np.full(3000, -3.0)
    odds[20::step] = strong
    odds[20 + step // 2 :: step] = weak
    return odds


def steps(levels: list[np.ndarray]) -> set[int]:
    return {int(np.median(np.diff(beats))) for beats in levels}


def test_half_double_and_third_are_offered() -> None:
    assert {25, 50, 100, 150} <= steps(metrical_levels(heard(), SPACE, 1.5))


def test_beats_between_the_beats_are_offered() -> None:
    levels = metrical_levels(heard(weak=-0.5), SPACE, 1.5)
    phases = {(int(np.median(np.diff(beats))), int(beats[5]) % 50) for beats in levels}
    assert {(50, 20), (50, 45)} <= phases


@pytest.mark.parametrize("right", [25, 50, 100])
def test_bars_decide_where_beats_do_not(right: int) -> None:
    odds = heard()
    levels = metrical_levels(odds, SPACE, 1.5)
    chosen = likeliest_level(levels, odds, SPACE, lambda beats: 200.0 * (np.median(np.diff(beats)) == right))
    assert np.median(np.diff(chosen)) == right


def test_without_bars_the_beats_decide() -> None:
    odds = heard()
    chosen = likeliest_level(metrical_levels(odds, SPACE, 1.5), odds, SPACE, lambda _: 0.0)
    assert np.median(np.diff(chosen)) == 50


@pytest.mark.parametrize(("favour", "chosen"), [(0.8, 50), (4.0, 75)])
def test_a_pulse_across_the_bars_needs_more_than_a_little(favour: float, chosen: int) -> None:
    """Odds that say as much for each level: bars that are a little likelier do not make a beat and a half one."""
    odds, pulses = np.zeros(3000), [np.arange(20, 2990, step) for step in (50, 75)]
    flat = replace(SPACE, log_prior=np.zeros(len(SPACE.log_prior)))
    found = likeliest_level(pulses, odds, flat, lambda beats: favour * (np.median(np.diff(beats)) == 75))
    assert np.median(np.diff(found)) == chosen


def test_nothing_heard_and_too_short() -> None:
    assert len(likeliest_level([], np.zeros(3), SPACE, lambda _: 0.0)) == 0
    short = np.full(60, -1.0)
    levels = metrical_levels(short, SPACE, 1.5)
    assert len(likeliest_level(levels, short, SPACE, lambda _: 0.0)) <= 3


def test_a_range_of_tempi_keeps_their_changes() -> None:
    part = in_range(SPACE, 90.0, 130.0)
    tempi = 6000.0 / part.intervals
    assert tempi.min() >= 90.0
    assert tempi.max() <= 130.0
    assert part.log_change.shape == (len(tempi), len(tempi))
