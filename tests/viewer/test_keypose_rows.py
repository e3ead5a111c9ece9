"""Rows, columns and numbers of a sheet: nothing is lost, nothing overlaps, cycles stand under each other."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.viewer.keypose.rows import MOST, in_beats, keypose_numbers, rows_of, spread

NONE = np.zeros(0)


def beats(count: int) -> np.ndarray:
    return 0.3 + 0.5 * np.arange(count)


@pytest.mark.parametrize("every", [1, 2, 3, 7])
@pytest.mark.parametrize("count", [2, 20, 64, 65, 300])
@pytest.mark.parametrize("cycle", [None, 8, 32])
def test_every_keypose_is_in_one_row_and_no_row_is_too_full(every: int, count: int, cycle: int | None):
    at = np.arange(1, count, every)
    rows = rows_of(at, beats(count), NONE, cycle)
    assert sorted(np.concatenate([row.chosen for row in rows]).tolist()) == list(range(len(at)))
    for row in rows:
        assert 1 <= len(row.chosen) <= MOST
        assert len(row.columns) <= MOST
        assert np.all((at[row.chosen] >= row.first) & (at[row.chosen] < row.end))
        assert np.allclose(row.first + row.columns[row.column], at[row.chosen])


def test_rows_begin_with_a_bar():
    rows = rows_of(np.arange(2, 60, 2), beats(60), beats(60)[1::3])
    assert [row.first % 3 for row in rows] == [1] * len(rows)


def test_cycles_stand_in_the_same_columns_with_the_same_numbers():
    figure = np.array([0, 2, 3, 6])
    at = np.concatenate([2 + figure, 10 + figure[[0, 1, 3]], 18 + figure])  # the second cycle misses its third
    rows = rows_of(at, beats(30), NONE, 8)
    assert [row.numbers.tolist() for row in rows] == [[1, 2, 3, 4], [1, 2, 4], [1, 2, 3, 4]]
    assert len({tuple(row.columns) for row in rows}) == 1
    assert rows[1].column.tolist() == [0, 1, 3]
    assert [row.title for row in rows] == ["cycle 1 · beats 3–10", "cycle 2 · beats 11–18", "cycle 3 · beats 19–26"]
    assert keypose_numbers(at, beats(30), NONE, 8).tolist() == [1, 2, 3, 4, 1, 2, 4, 1, 2, 3, 4]


def test_a_long_cycle_is_shown_in_parts_and_its_cycles_stay_under_each_other():
    at = np.arange(0, 128)
    rows = rows_of(at, beats(128), NONE, 64)
    assert [row.title.split(" ·")[0] for row in rows[:4]] == ["cycle 1", "cycle 2", "cycle 1", "cycle 2"]
    assert np.array_equal(rows[0].numbers, rows[1].numbers)
    assert max(row.numbers.max() for row in rows) == 64


def test_a_cycle_longer_than_the_song_is_one_and_ends_with_it():
    at = np.arange(3, 37, 2)
    rows = rows_of(at, beats(37), NONE, 10**30)
    assert [row.title for row in rows] == [row.title for row in rows_of(at, beats(37), NONE, 37)]
    assert keypose_numbers(at, beats(37), NONE, 10**30).tolist() == list(range(1, len(at) + 1))


def test_the_last_cycle_ends_with_the_beats():
    rows = rows_of(np.arange(1, 37, 2), beats(37), NONE, 8)
    assert rows[-1].title == "cycle 5 · beats 34–37"
    assert rows[-1].end - rows[-1].first == 8  # and still stands under the others


def test_a_few_keyposes_have_the_row_for_themselves():
    (row,) = rows_of(np.array([3, 5]), beats(200), NONE)
    assert row.end - row.first < 8


def test_no_keypose_leaves_one_row():
    (row,) = rows_of(np.zeros(0, np.int64), beats(9), NONE)
    assert len(row.chosen) == 0


def test_beats_go_on_at_both_ends():
    times = np.array([-0.2, 0.3, 0.55, 9.8, 11.8])
    assert np.allclose(in_beats(times, beats(20)), [-1, 0, 0.5, 19, 23])


def test_pictures_keep_apart_in_order_and_inside():
    rng = np.random.default_rng(0)
    for count in (1, 2, 8, 12):
        wanted = np.sort(rng.uniform(0, 10, count))
        places = spread(wanted, 0.8, 0.5, 9.5)
        assert np.all(np.diff(places) >= 0.8 - 1e-9)
        assert places.min() >= 0.5 - 1e-9
        assert places.max() <= 9.5 + 1e-9
    far = np.arange(5) * 2.0 + 1
    assert np.allclose(spread(far, 0.8, 0, 10), far)


def test_too_many_pictures_share_the_room():
    assert np.allclose(np.diff(spread(np.full(9, 3.0), 5.0, 0.0, 8.0)), 1.0)
