"""A robot on its floor, tick by tick."""

from __future__ import annotations

import numpy as np

from onbeat.robots.simulation.reference import Reference, reference
from onbeat.robots.simulation.world import RATE, Options, World
from robot_dances import made_dance


def begun(seconds: float = 1.0) -> tuple[World, Reference]:
    robot, motion = made_dance()
    told = reference(robot, motion[:30], RATE, seconds)
    return World(robot, told, Options(), np.random.default_rng(0)), told


def test_what_brakes_only_sinks_and_stands_again_where_it_is_placed():
    world, told = begun()
    for _ in range(300):
        world.lie()
    assert world.data.qpos[2] < 0.8 * told.qpos[0, 2]
    world.place(400)
    assert np.array_equal(world.data.qpos, told.qpos[400])
    for tick in range(400, 500):
        world.step(tick)
    assert np.abs(world.data.qpos[:3] - told.qpos[499, :3]).max() < 0.01


def test_a_reference_whose_beginning_is_forgotten_is_the_same_dance():
    whole, told = begun(0.2)
    rolling, _ = begun(0.2)
    for tick in range(200):
        whole.step(tick)
    for start in range(0, 200, 50):
        first = max(start - 20, 0)
        rolling.go_on(Reference._make(part[first : start + 51] for part in told))
        for tick in range(start, start + 50):
            rolling.step(tick - first)
    assert np.array_equal(whole.data.qpos, rolling.data.qpos)
