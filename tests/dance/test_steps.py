from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.blend import Windows
from onbeat.dance.steps import FARTHEST, HIGHEST, LIFT, MOST_TURNED, PARTED, Steps, steps_between
from onbeat.motion import rotations as rot

TIMES = np.arange(180) / 60
MOVES = (TIMES >= 1.0).astype(np.int64) + (TIMES >= 2.0)
WINDOWS = Windows(np.array([1.0, 2.0]), np.array([0.4, 0.4]))


def stepped(places: tuple[float, float, float], yaws=(0.0, 0.0, 0.0), contacts: np.ndarray | None = None) -> Steps:
    """The left foot of three moves rests at three places; the right one never moves."""
    soles = np.zeros((180, 2, 3))
    soles[:, 0, 0] = np.array(places)[MOVES]
    turns = np.tile(rot.IDENTITY, (180, 2, 1))
    turns[:, 0] = rot.yaw(np.array(yaws)[MOVES])
    contacts = np.ones((180, 2), bool) if contacts is None else contacts
    return steps_between(contacts, soles, turns, MOVES, WINDOWS, TIMES)


def test_feet_that_meet_rest_through_the_join():
    steps = stepped((0.0, 0.9 * FARTHEST, 0.0))
    assert steps.contacts.all()
    assert not steps.lifts.any()


def test_a_foot_too_far_off_is_lifted_across_and_the_other_rests():
    steps = stepped((0.0, 0.15, 0.15))
    off = TIMES[~steps.contacts[:, 0]]
    assert off.min() >= 1.0 - 0.2 * PARTED - 1e-9
    assert off.max() < 1.0 + 0.2 * PARTED
    assert len(off) >= 0.3 * PARTED * 60
    assert steps.lifts[:, 0].max() == pytest.approx(LIFT * 0.15, rel=0.05)
    assert stepped((0.0, 1.0, 1.0)).lifts.max() <= HIGHEST
    assert steps.contacts[:, 1].all()


def test_small_gaps_add_up_until_the_foot_steps():
    steps = stepped((0.0, 0.7 * FARTHEST, 1.4 * FARTHEST))
    assert steps.contacts[:90, 0].all()
    assert not steps.contacts[120, 0]


def test_a_foot_that_was_lifted_meanwhile_begins_anew():
    contacts = np.ones((180, 2), bool)
    contacts[80:95, 0] = False
    assert stepped((0.0, 0.7 * FARTHEST, 1.4 * FARTHEST), contacts=contacts).contacts[100:, 0].all()


def test_a_foot_turned_too_far_steps():
    assert not stepped((0.0, 0.0, 0.0), (0.0, 1.2 * MOST_TURNED, 0.0)).contacts[60, 0]


def test_a_foot_that_rests_on_one_side_only_is_in_the_air_around_the_join():
    contacts = np.ones((180, 2), bool)
    contacts[60:90, 0] = False
    steps = stepped((0.0, 0.0, 0.0), contacts=contacts)
    assert not steps.contacts[55:90, 0].any()
    assert steps.contacts[:48, 0].all()
    assert not steps.lifts.any()
