from __future__ import annotations

import numpy as np

from onbeat.dance.stage import CALM, MOST, steering


def walked(turns: np.ndarray, joins: np.ndarray, path: np.ndarray, times: np.ndarray) -> np.ndarray:
    """The path with all that follows each join turned about the place of the join."""
    out = path.copy()
    for turn, join in zip(turns, joins, strict=True):
        rest = np.flatnonzero(times >= join)
        pivot, (c, s) = out[rest[0]].copy(), (np.cos(turn), np.sin(turn))
        out[rest] = pivot + (out[rest] - pivot) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return out


def test_a_straight_walk_is_bent_back_to_the_middle():
    times = np.arange(0, 60, 0.2)
    path = np.stack((0.5 * times, np.zeros(300), np.zeros(300)), axis=1)
    joins = np.arange(1.0, 59.0, 1.0)
    turns = steering(path[np.searchsorted(times, joins)], joins, path, times)
    assert np.abs(turns).max() <= MOST
    bent = walked(turns, joins, path, times)
    assert np.linalg.norm(bent, axis=1).max() < 10.0, "30 m where nothing turns"
    assert np.allclose(np.linalg.norm(np.diff(bent, axis=0), axis=1), 0.1), "no step is made longer"


def test_near_the_middle_nothing_is_turned():
    times = np.arange(0, 20, 0.2)
    path = 0.5 * CALM * np.stack((np.sin(times), np.cos(times), 0 * times), axis=1)
    joins = np.arange(1.0, 19.0)
    assert not steering(path[np.searchsorted(times, joins)], joins, path, times).any()


def test_no_joins_no_turns():
    assert steering(np.zeros((0, 3)), np.zeros(0), np.zeros((5, 3)), np.arange(5.0)).shape == (0,)
