from itertools import pairwise

import numpy as np
import pytest

from onbeat.retime.windows import widened, windows


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("margin", [0, 1, 4, 100])
def test_windows_are_all_that_is_near_and_nothing_else(seed: int, margin: int):
    violated = np.random.default_rng(seed).random(60) < 0.08
    spans = windows(violated, margin)
    near = np.zeros(60, bool)
    for k in np.flatnonzero(violated):
        near[max(k - margin, 0) : k + margin + 1] = True
    covered = np.zeros(60, int)
    for start, end in spans:
        assert 0 <= start < end <= 60
        covered[start:end] += 1
    np.testing.assert_array_equal(covered, near.astype(int))
    assert spans == sorted(spans)
    assert all(later[0] > first[1] for first, later in pairwise(spans)), "touching ones are one"


def test_nothing_violated_is_no_window():
    assert windows(np.zeros(10, bool), 3) == []
    assert windows(np.zeros(0, bool), 3) == []


def test_all_violated_is_one():
    assert windows(np.ones(10, bool), 3) == [(0, 10)]


def test_a_widened_window_grows_on_both_sides_and_stays_inside():
    assert widened([(5, 8)], 0, 2, 20) == [(3, 10)]
    assert widened([(1, 8)], 0, 4, 9) == [(0, 9)]


def test_those_that_meet_are_joined_and_others_left():
    spans = [(0, 4), (10, 14), (20, 24), (40, 44)]
    assert widened(spans, 1, 6, 50) == [(0, 24), (40, 44)]
    assert widened(spans, 1, 1, 50) == [(0, 4), (9, 15), (20, 24), (40, 44)]
    assert widened(spans, 3, 16, 50) == [(0, 4), (10, 14), (20, 50)]


def test_touching_is_meeting():
    assert widened([(0, 4), (10, 14)], 1, 6, 20) == [(0, 20)]


@pytest.mark.parametrize("seed", range(10))
def test_widening_again_and_again_ends_with_all(seed: int):
    spans = windows(np.random.default_rng(seed).random(100) < 0.05, 2)
    for _ in range(60):
        if not spans:
            return
        covered = sum(end - start for start, end in spans)
        spans = widened(spans, 0, 2, 100)
        assert sum(end - start for start, end in spans) > covered or spans == [(0, 100)]
    assert spans == [(0, 100)]
