"""Bars from how much each beat sounds like a downbeat."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.music.bars import find_downbeats, harmony_distance


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
