from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.capture.pose import best_turns, bridge, bridge_places
from onbeat.motion import rotations as rot


@given(st.integers(0, 2**32 - 1), st.integers(2, 6))
@settings(max_examples=50, deadline=None)
def test_a_turn_is_found_from_two_directions_or_more(seed: int, count: int):
    rng = np.random.default_rng(seed)
    local, turn = rng.normal(size=(count, 3)), rot.exp(rng.normal(size=(4, 3)))
    found, good = best_turns(local, rot.rotate(turn[:, None], local), np.ones(count))
    assert rot.angle_between(found, turn)[good].max(initial=0) < 1e-3
    assert good.all() or np.linalg.svd(local)[1][1] < 0.1 * np.linalg.svd(local)[1][0]


def test_one_direction_tells_no_turn():
    _, good = best_turns(np.array([[1.0, 0, 0], [2.0, 0, 0]]), np.array([[[0, 1.0, 0], [0, 2.0, 0]]]), np.ones(2))
    assert not good.any()


def test_what_is_not_seen_does_not_count():
    world = np.eye(3)[None] + 0.0
    world[0, 2] = np.nan
    found, good = best_turns(np.eye(3), world, np.ones(3))
    assert good.all()
    assert rot.angle_between(found, rot.IDENTITY).max() < 1e-6


def test_bridges_reach_from_the_last_good_to_the_next():
    path = rot.yaw(np.linspace(0, 1, 11))
    good = np.ones(11, bool)
    good[3:7] = False
    broken = np.where(good[:, None], path, rot.IDENTITY)
    assert rot.angle_between(bridge(broken, good), path).max() < 1e-6
    places = np.linspace(0, 1, 11)[:, None] * np.ones(3)
    assert np.allclose(bridge_places(np.where(good[:, None], places, 9.0), good), places)


def test_where_nothing_is_good_nothing_is_turned_or_moved():
    none = np.zeros(4, bool)
    assert np.array_equal(bridge(rot.yaw(np.ones(4)), none), np.tile(rot.IDENTITY, (4, 1)))
    assert not bridge_places(np.ones((4, 3)), none).any()
