"""The grid of danced beats: small corrections are gentle, large ones are believed when they last; nothing runs back."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.live.beat.bar import Bar
from onbeat.live.beat.fold import Danced
from onbeat.live.beat.grid import Grid


def run(
    grid: Grid, period: float, offset: float, seconds: float, start: float = 0.0, noise: float = 0.0
) -> list[float]:
    """Follow beats at ``offset`` + whole periods, tick by tick; the times of the beats that passed."""
    rng, passed = np.random.default_rng(0), list[float]()
    for tick in range(round(start * 100), round((start + seconds) * 100)):
        number, now = grid.number, (tick + 1) / 100
        grid.go_to(now)
        beat = offset + np.ceil((now - offset) / period) * period + noise * rng.standard_normal()
        grid.follow(Danced(beat, period, 0, 4), now, 0.01)
        assert grid.number - number in (0, 1)
        assert grid.last <= now < grid.next
        if grid.number > number:
            passed.append(grid.last)
    return passed


def test_a_small_correction_is_gentle() -> None:
    grid = Grid(0.5)
    run(grid, 0.5, 0.0, 3.0)
    before = grid.next
    grid.follow(Danced(before + 0.02, 0.5, 0, 4), 3.0, 0.01)
    assert 0.0 < grid.next - before < 0.001
    assert abs(run(grid, 0.5, 0.02, 4.0, 3.0)[-1] % 0.5 - 0.02) < 0.005


def test_jitter_of_what_is_heard_is_smoothed() -> None:
    passed = np.array(run(Grid(0.5), 0.5, 0.0, 20.0, noise=0.02))[4:]
    assert np.abs(passed - np.round(passed / 0.5) * 0.5).max() < 0.008


@pytest.mark.parametrize("period", [0.54, 0.46, 0.65, 0.385])
def test_a_step_of_the_tempo_is_followed_within_four_beats(period: float) -> None:
    grid = Grid(0.5)
    run(grid, 0.5, 0.0, 4.0)
    passed = np.array(run(grid, period, 4.0, 5.0, 4.0))
    assert np.abs(passed - np.round((passed - 4.0) / period) * period - 4.0)[4:].max() < 0.03


def test_a_reading_that_does_not_last_is_not_followed() -> None:
    grid = Grid(0.5)
    run(grid, 0.5, 0.0, 3.0)
    before = grid.next
    for tick in range(8):
        grid.follow(Danced(before + 0.2, 0.5, 0, 4), 3.0 + tick / 100, 0.01)
    assert grid.next == before


def test_a_leap_keeps_the_number_of_the_nearest_beat() -> None:
    grid = Grid(0.5)
    run(grid, 0.5, 0.0, 3.2)
    number, following = grid.number, grid.next
    grid.leap(Danced(following + 5.1, 0.5, 0, 4), 3.2)
    assert (grid.number, round(grid.next, 6)) == (number, round(following + 0.1, 6))


def test_another_count_of_the_bar_has_to_last() -> None:
    bar = Bar()
    bar.hear(Danced(0.0, 0.5, 0, 4), 8, sure=True)
    for number, position in ((9, 1), (10, 3), (11, 3)):  # a slip of one beat
        bar.hear(Danced(0.0, 0.5, position, 4), number)
        assert bar.positions(8, 4).tolist() == [1, 2, 3, 4]
    for number in (12, 13, 14):
        bar.hear(Danced(0.0, 0.5, (number - 11) % 4, 4), number)
    assert bar.positions(11, 2).tolist() == [1, 2]
