"""Steps that a robot can do."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from onbeat.robots.legs.footfalls import BOTH, CLEARANCE, NEAREST, QUICKEST, WIDEST, Stand, footfalls
from onbeat.robots.legs.tasks import Task

HIPS = 0.2
FIRST = Stand(np.array([[0.0, 0.1], [0.0, -0.1]]), np.zeros(2))


def step(foot: str, start: float, y: float, x: float = 0.0, heading: float = 0.0) -> Task:
    return Task("step", foot, start, start + 0.2, (x, y), heading, 0.3)


def test_steps_get_the_time_they_need_and_never_overlap():
    wild = [step(("left", "right")[n % 2], 0.5 + 0.15 * n, 0.1 + 0.05 * n) for n in range(20)]
    done = footfalls(FIRST, wild, HIPS, 6.0).steps
    assert 2 <= len(done) < 20
    assert all(s.end - s.start >= QUICKEST - 1e-9 for s in done)
    assert all(b.start - a.end >= BOTH - 1e-9 for a, b in itertools.pairwise(done))


def test_feet_never_come_nearer_or_farther_than_they_may():
    middles, _, standing = footfalls(FIRST, [step("left", 1, 2.0), step("right", 2, 1.9)], HIPS, 4.0).paths(240, 60)
    apart = (middles[:, 0] - middles[:, 1])[standing.all(axis=1), 1]
    assert apart.max() <= WIDEST * HIPS + 1e-9
    assert apart.min() >= NEAREST * HIPS - 1e-9
    assert standing.any(axis=1).all()


def test_a_foot_turns_no_farther_than_the_other_allows_even_turned_about():
    turned = Stand(FIRST.middles @ np.array([[-1.0, 0], [0, -1]]), np.full(2, np.pi))
    (done,) = footfalls(turned, [step("left", 1, -0.12, heading=np.pi + 2.0)], HIPS, 4.0).steps
    assert done.heading == pytest.approx(np.pi + 0.5)


def test_paths_lift_the_foot_and_set_it_down_where_it_belongs():
    falls = footfalls(FIRST, [step("left", 1, 0.12, x=0.1)], HIPS, 4.0)
    middles, _, standing = falls.paths(240, 60)
    assert middles[~standing[:, 0], 0, 2].max() > CLEARANCE * 0.99
    np.testing.assert_allclose(middles[-1, 0], [0.1, 0.12, 0], atol=1e-12)
    np.testing.assert_array_equal(middles[standing[:, 0], 0, 2], 0)


def test_steps_at_the_very_ends_are_left_out():
    assert not footfalls(FIRST, [step("left", 0.0, 0.13), step("right", 3.9, -0.13)], HIPS, 4.0).steps
