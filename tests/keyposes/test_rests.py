"""Poses that are held."""

import numpy as np

from onbeat.keyposes.rests import nearest_to_beat

T = np.arange(0, 4, 1 / 120)
HELD = np.clip(np.abs(T - 2.0) - 0.2, 0.0, 1.0)  # still from 1.8 to 2.2 s
AT = np.array([2.0])


def test_a_hold_across_the_beat_is_on_the_beat() -> None:
    assert nearest_to_beat(AT, np.array([1.9]), HELD, 0.01).tolist() == [1.9]


def test_a_hold_beside_the_beat_is_where_it_is_nearest() -> None:
    assert np.allclose(nearest_to_beat(AT, np.array([1.5]), HELD, 0.01), [1.79], atol=1e-6)
    assert np.allclose(nearest_to_beat(AT, np.array([2.5]), HELD, 0.01), [2.21], atol=1e-6)


def test_nothing_is_moved_without_an_allowance() -> None:
    curve = (T - 2.0) ** 2
    assert np.allclose(nearest_to_beat(AT, np.array([1.5]), curve, 0.0), AT)


def test_beats_without_a_candidate_stay_without() -> None:
    found = nearest_to_beat(np.array([np.nan, 2.0]), np.array([1.0, 2.0]), HELD, 0.05)
    assert np.isnan(found[0])
    assert found[1] == 2.0
