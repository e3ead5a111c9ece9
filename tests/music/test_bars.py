"""Bars from how much each beat sounds like a downbeat."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.bars import (
    downbeat_log_odds,
    find_downbeats,
    harmony_distance,
    learned_downbeats,
    likeliest_bars,
)


@pytest.mark.parametrize("meter", [2, 3, 4, 5, 6, 7])
@pytest.mark.parametrize("phase", [0, 1])
def test_each_meter_is_found_where_it_is_clear(meter: int, phase: int) -> None:
    odds = np.where((np.arange(84) - phase) % meter == 0, 2.5, -2.5)
    downbeats, found = find_downbeats(odds)
    assert found == meter
    np.testing.assert_array_equal(np.flatnonzero(downbeats), np.arange(phase, 84, meter))


def test_nothing_heard_is_four_in_a_bar() -> None:
    downbeats, meter = find_downbeats(np.zeros(32))
    assert meter == 4
    assert (np.diff(np.flatnonzero(downbeats)) == 4).all()


def test_a_bar_too_long_is_survived() -> None:
    places = np.concatenate([np.arange(0, 40, 4), np.arange(42, 80, 4)])
    odds = np.full(80, -1.5)
    odds[places] = 2.5
    downbeats, meter = find_downbeats(odds)
    assert meter == 4
    np.testing.assert_array_equal(np.flatnonzero(downbeats)[-9:], np.arange(46, 80, 4))


def test_harmony_distance_looks_as_far_as_asked() -> None:
    chroma = np.repeat(np.eye(2), 4, axis=0)
    assert harmony_distance(chroma, 2)[4] == pytest.approx(1.0)
    assert harmony_distance(chroma, 2)[2] == pytest.approx(0.0)
    assert harmony_distance(np.zeros((3, 12)), 1).tolist() == [0.0, 0.0, 0.0]


def test_the_learned_cue_finds_bars_where_harmony_says_nothing() -> None:
    frames = np.arange(20, 3000, 50)
    odds = np.full((3000, 2), -6.0, np.float32)
    odds[frames, 0] = 2.0
    odds[frames[1::3], 1] = 2.0
    odds[frames[::3], 1] = odds[frames[2::3], 1] = -4.0
    cue = learned_downbeats(odds, frames)
    assert cue[1] > 0.0 - 1e-6 > cue[0]
    downbeats, meter = find_downbeats(downbeat_log_odds(np.zeros((60, 61)), np.zeros(60), cue))
    assert meter == 3
    np.testing.assert_array_equal(np.flatnonzero(downbeats), np.arange(1, 60, 3))


def test_clear_bars_score_higher_than_unclear_ones() -> None:
    clear = np.where(np.arange(60) % 4 == 0, 2.0, -2.0)
    mixed = np.random.default_rng(0).permutation(clear)
    assert likeliest_bars(clear)[2] > likeliest_bars(mixed)[2] > likeliest_bars(np.full(60, -2.0))[2]
    assert likeliest_bars(np.zeros(0))[2] == 0.0
