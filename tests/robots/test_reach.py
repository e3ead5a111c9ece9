"""What is out of reach is given up smoothly."""

from __future__ import annotations

import numpy as np

from onbeat.robots.legs.hips import CROUCHED, feet_below, hips_apart, standing_height
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.reach import below, reachable
from onbeat.robots.model import robot_named

LEGS = Legs.of(robot_named("g1"))


def test_the_path_below_is_below_smooth_and_no_lower_than_it_has_to():
    values = np.ones(200)
    values[90:95] = 0.3
    path = below(values, 60)
    assert (path <= values + 1e-12).all()
    np.testing.assert_allclose(path[[*range(40), *range(-40, 0)]], 1)
    assert path.min() >= 0.3 - 1e-12
    assert np.abs(np.diff(path)).max() < 0.1


def test_hips_that_are_too_high_come_down_until_the_feet_stand():
    places, turns = feet_below(LEGS, hips_apart(LEGS), 0.0)
    high = standing_height(LEGS, CROUCHED)
    wanted = np.zeros((240, 36))
    wanted[:, 2], wanted[:, 3] = high + 0.2 * np.exp(-((np.linspace(-4, 4, 240)) ** 2)), 1
    ease = np.tile(np.array([0, 0, high, 1.0, 0, 0, 0]), (240, 1))
    places, turns = np.tile(places, (240, 1, 1)), np.tile(turns, (240, 1, 1))
    done = reachable(LEGS, wanted, ease, places, turns, 60)
    np.testing.assert_allclose(LEGS.feet(done)[0], places, atol=1e-5)
    assert done[:, 2].max() > high + 0.03
    assert np.abs(np.diff(done[:, 2], 2)).max() * 3600 < 8
