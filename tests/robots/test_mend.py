"""Trying again where a solution is caught."""

import numpy as np

from onbeat.motion.unitree_g1 import G1
from onbeat.robots.ik.mend import spread, stretches_of
from onbeat.robots.ik.trajectory import Rules
from onbeat.robots.ik.tree import ROOT


def test_troubles_that_are_near_are_one_stretch():
    trouble = np.zeros(600, bool)
    trouble[[100, 110, 300]] = True
    assert [(s.part.start + s.first, s.part.start + s.last) for s in stretches_of(trouble, 1 / 60)] == [
        (100, 111),
        (300, 301),
    ]


def test_without_trouble_there_is_no_stretch():
    assert stretches_of(np.zeros(10, bool), 1 / 60) == []


def test_ends_of_the_dance_are_free():
    (stretch,) = stretches_of(np.ones(10, bool), 1 / 60)
    assert stretch.pinned == (0, 0)
    assert stretch.part == slice(0, 10)


def test_poses_are_spread_within_limits_and_unlike_each_other():
    wide, every = np.full(ROOT, np.inf), np.ones(ROOT + 29)
    low, high = np.concatenate((-wide, G1.low)), np.concatenate((wide, G1.high))
    seeds = spread(Rules(low, high, every, every, every, every, every, 1.0), 12)
    assert ((seeds >= low) & (seeds <= high)).all()
    apart = np.linalg.norm(seeds[:, None] - seeds[None], axis=-1) + 10 * np.eye(12)
    assert apart.min() > 1
