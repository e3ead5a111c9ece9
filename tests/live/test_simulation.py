"""A simulated robot in the loop: it stands, falls, and is put up again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.live.protocol import RATE, Note, Pose
from onbeat.live.robot.simulation import LYING, Simulation
from onbeat.live.robot.ticks import AHEAD
from onbeat.robots.simulate import simulate
from onbeat.robots.simulation.disturb import Push
from onbeat.robots.simulation.world import Options
from onbeat.robots.state import configurations
from prepared_robots import prepared


def poses(seconds: float) -> list[Pose]:
    robot, _, dance = prepared()
    qpos = configurations(robot, dance.motion.resampled(RATE)[: round(seconds * RATE)])
    none = np.zeros((0, 3), np.float32)
    return [Pose(k, k / RATE, row[:3], row[None, 3:7], row[7:], none) for k, row in enumerate(qpos)]


def begun(told: list[Pose], options: Options | None = None) -> Simulation:
    first = np.concatenate((told[0].root, told[0].rotations[0], told[0].angles))
    return Simulation(prepared()[0], first, options)


def run(simulation: Simulation, told: list[Pose], lump: int = 10) -> tuple[list[Pose], list[str]]:
    steps = [simulation.step(told[k : k + lump]) for k in range(0, len(told), lump)]
    return [pose for step in steps for pose in step.poses], [
        event.text for step in steps for event in step.events if isinstance(event, Note)
    ]


def test_it_dances_as_well_as_one_that_knows_the_whole_dance_before():
    robot, _, dance = prepared()
    told = poses(5.0)
    done, notes = run(begun(told), told)
    assert not notes
    assert [pose.number for pose in done] == list(range(len(told) - AHEAD))
    errors = np.array([pose.angles - told[k].angles for k, pose in enumerate(done)])
    known = simulate(robot, dance.motion[: 5 * 60])
    assert known.upright
    assert np.sqrt(np.mean(errors**2)) < 1.2 * np.sqrt(np.mean(known.error**2))


def test_how_many_poses_come_at_once_does_not_matter():
    told = poses(0.6)
    one, other = (run(begun(told), told, lump)[0] for lump in (10, 7))
    assert all(np.array_equal(a.angles, b.angles) for a, b in zip(one, other, strict=True))


def test_a_push_that_is_too_strong_is_a_fall_that_is_told_and_it_is_put_up_again():
    told = poses(5.5)
    simulation = begun(told, Options(pushes=(Push(0.5, (500.0, 0.0, 0.0), 0.15),)))
    done, notes = run(simulation, told)
    assert len(notes) == 2
    assert "fell" in notes[0]
    assert "put up again" in notes[1]
    assert simulation.falls == 1
    assert simulation.fallen_at is None
    assert simulation.why
    heights = np.array([pose.root[2] for pose in done])
    assert heights.min() < 0.4
    assert np.argmin(heights) / RATE < 0.5 + LYING + 1.0
    assert heights[-1] == pytest.approx(told[len(done) - 1].root[2], abs=0.05)


def test_poses_that_cannot_be_are_refused():
    told = poses(0.3)
    simulation = begun(told)
    simulation.step(told[:10])
    with pytest.raises(BodyError, match="pose 12 came after pose 9"):
        simulation.step(told[12:14])
    with pytest.raises(BodyError, match="is not g1's"):
        simulation.step([replace(told[10], angles=told[10].angles * np.nan)])
    with pytest.raises(BodyError, match="is not g1's"):
        simulation.step([replace(told[10], angles=told[10].angles[:5])])
    with pytest.raises(BodyError, match="a first pose of shape"):
        Simulation(prepared()[0], np.zeros(3))
    assert simulation.step([]).poses == ()
