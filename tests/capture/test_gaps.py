from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.capture.gaps import fill_gaps, find_jumps, trust
from onbeat.motion import Markers
from onbeat.motion import rotations as rot

FPS = 60.0


def cloud(frames: int = 60) -> np.ndarray:
    """Four markers on a body that turns and moves."""
    t = np.arange(frames) / FPS
    shape = np.array([[0.1, 0, 0], [-0.1, 0.02, 0], [0, 0.1, 0.05], [0, -0.05, 0.1]])
    turn = rot.yaw(2.0 * t)[:, None]
    return rot.rotate(turn, shape) + np.column_stack((t, t**2, np.sin(5 * t)))[:, None]


def holed(positions: np.ndarray, marker: int, first: int, end: int) -> Markers:
    positions = positions.copy()
    positions[first:end, marker] = np.nan
    return Markers(["a", "b", "c", "d"], positions, FPS)


def test_a_short_gap_is_bridged_by_a_smooth_curve():
    whole = cloud()
    filled = fill_gaps(holed(whole, 0, 20, 32))
    assert np.abs(filled.markers.positions - whole).max() < 0.004
    assert filled.by_curve[:, 0].sum() == 12


def test_a_longer_gap_follows_the_bone():
    whole = cloud()
    filled = fill_gaps(holed(whole, 0, 20, 50), [[0, 1, 2, 3]])
    assert np.abs(filled.markers.positions - whole).max() < 1e-9
    assert filled.by_neighbours[:, 0].sum() == 30


def test_a_longer_gap_without_three_others_stays():
    filled = fill_gaps(holed(cloud(), 0, 20, 50), [[0, 1, 2]])
    assert np.isnan(filled.markers.positions[20:50, 0]).all()


def test_nothing_is_filled_before_the_first_or_after_the_last_sight():
    for first, end in ((0, 5), (55, 60)):
        filled = fill_gaps(holed(cloud(), 0, first, end), [[0, 1, 2, 3]])
        assert np.isnan(filled.markers.positions[first:end, 0]).all()
        assert filled.by_curve.sum() + filled.by_neighbours.sum() == 0


@given(st.integers(1, 50), st.integers(1, 40))
@settings(max_examples=40, deadline=None)
def test_what_is_seen_is_never_changed(first: int, length: int):
    markers = holed(cloud(), 1, first, first + length)
    filled = fill_gaps(markers, [[0, 1, 2, 3]]).markers
    assert np.array_equal(filled.positions[markers.seen], markers.positions[markers.seen])


def test_a_ghost_is_found_and_a_fast_hand_is_not():
    positions = np.zeros((60, 2, 3))
    positions[:, 0, 0] = 0.15 * np.sin(np.arange(60) / FPS * 2 * np.pi * 8)  # up to 7.5 m/s
    positions[20:24, 1] = [0.5, 0, 0]
    jumped = find_jumps(positions, FPS)
    assert not jumped[:, 0].any()
    assert np.flatnonzero(jumped[:, 1]).tolist() == [20, 21, 22, 23]


def test_a_marker_may_be_elsewhere_after_a_long_gap():
    positions = np.zeros((120, 1, 3))
    positions[30:60] = np.nan
    positions[60:, 0, 0] = 1.5
    assert not find_jumps(positions, FPS).any()


def test_trust_fades_towards_a_gap_and_is_whole_at_the_ends():
    seen = np.ones((60, 1), bool)
    seen[30:35] = False
    weights = trust(seen, FPS)
    assert weights[0] == weights[-1] == weights[20] == 1
    assert (weights[30:35] == 0).all()
    assert 0 < weights[29] < weights[27] < weights[25] < 1
    assert np.allclose(weights[20:30, 0], weights[35:45, 0][::-1])
