"""A robot's line: it grows and is cut, what is settled stays, and nothing jumps."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.live.robot.dance import STANCE, RobotDance
from onbeat.live.robot.line import LONGEST, RobotLine
from onbeat.live.robot.path import Path
from onbeat.motion import rotations as rot
from onbeat.robots.legs.ik import Legs
from prepared_robots import prepared

REST, DANCE = 0, 1


def empty() -> RobotLine:
    robot, rest, dance = prepared()
    return RobotLine([rest, dance], robot)


def changeful(rng: np.random.Generator, moves: int) -> RobotLine:
    """A line of many short moves, hastily cut."""
    line = empty()
    for _ in range(moves):
        start = rng.uniform(0, 5)
        line.add(int(rng.integers(2)), start, start + rng.uniform(0.1, 2.0), float(rng.choice([0.7, 1.0, 1.4])))
        if rng.uniform() < 0.4:
            line.cut(max(line.end - rng.uniform(0, 1.0), 0.0))
    return line


@pytest.mark.parametrize("seed", range(6))
def test_what_is_settled_never_changes(seed: int):
    rng, line = np.random.default_rng(seed), empty()
    line.add(REST, 0.0, 2.0)
    settled, before = np.zeros(0), np.zeros((0, 36))
    for _ in range(25):
        deed = rng.uniform()
        if deed < 0.5:
            start = rng.uniform(0, 5)
            line.add(int(rng.integers(2)), start, start + rng.uniform(0.1, 1.5), float(rng.choice([0.8, 1.0])))
        elif deed < 0.7:
            line.cut(rng.uniform(line.settled, max(line.end, line.settled + 1e-3)))
        else:
            new = np.linspace(line.settled, line.settled + rng.uniform(0, 0.8), 5)[:-1]
            line.settle(float(new[-1]))
            settled, before = np.concatenate((settled, new)), np.concatenate((before, line.configurations(new)))
        if len(settled):
            assert np.array_equal(line.configurations(settled), before)
            assert np.array_equal(line.configurations(settled[-3:]), before[-3:])


def test_nothing_jumps_and_ranges_are_kept_where_dances_go_over_into_each_other():
    robot, _, dance = prepared()
    line = changeful(np.random.default_rng(1), 20)
    fps = 240
    times = np.arange(0, line.end + 1, 1 / fps)
    qpos = line.configurations(times)
    body = robot.body
    assert (qpos[:, 7:] >= body.low - 1e-9).all()
    assert (qpos[:, 7:] <= body.high + 1e-9).all()
    own = np.abs(np.diff(dance.angles, 2, axis=0)).max() * dance.motion.fps**2
    assert np.abs(np.diff(qpos[:, 7:], 2, axis=0)).max() * fps**2 < 1.4**2 * own + 80
    assert np.abs(np.diff(qpos[:, :3], 2, axis=0)).max() * fps**2 < 15
    turned = rot.angle_between(qpos[1:, 3:7], qpos[:-1, 3:7])
    assert turned.max() * fps < 6


def test_feet_stay_where_they_are_through_all_joins():
    robot, _, _ = prepared()
    line = changeful(np.random.default_rng(2), 20)
    places = STANCE.feet(Legs.of(robot))[0]
    found = Legs.of(robot).feet(line.configurations(np.arange(0, line.end, 0.01)))[0]
    assert np.abs(found - places).max() < 2e-4


def test_what_goes_on_is_made_longer_and_is_the_dance_itself():
    robot, _, dance = prepared()
    line = empty()
    line.add(DANCE, 1.0, 2.0)
    line.add(DANCE, 2.0, 4.5)
    times = np.arange(0, 3.5, 0.013)
    assert line.end == pytest.approx(3.5)
    assert np.array_equal(line.configurations(times), Path(dance, robot)(1.0 + times))
    assert line.showing(2.5) == (DANCE, pytest.approx(3.5))


def test_a_move_is_danced_as_it_is_once_it_is_gone_over_into():
    robot, _, dance = prepared()
    line = empty()
    line.add(REST, 0.0, 3.0)
    line.add(DANCE, 0.0, 7.0)
    late = np.array([3.0 + LONGEST])
    assert line.angles(late) == pytest.approx(Path(dance, robot)(late - 3.0)[:, 7:])
    assert line.showing(2.9) == (REST, pytest.approx(2.9))
    assert line.root(late)[0] == pytest.approx(Path(dance, robot)(late - 3.0)[:, :3])


def test_behind_its_end_it_comes_to_rest_and_settling_makes_it_longer():
    line = empty()
    line.add(DANCE, 6.0, 6.9)
    after = line.angles(np.array([30.0, 40.0]))
    assert np.array_equal(after[0], after[1])
    line.settle(3.0)
    assert line.end == 3.0


def test_forgetting_what_is_over_keeps_the_rest_and_is_flat():
    line = changeful(np.random.default_rng(3), 60)
    times = np.arange(line.end - 3, line.end, 0.05)
    before = line.configurations(times)
    line.forget(line.end - 3)
    assert np.array_equal(line.configurations(times), before)
    assert len(line.moves) < 12


def test_what_cannot_be_is_said():
    robot, _, _ = prepared()
    line = empty()
    with pytest.raises(PlanError, match="nothing is on the line"):
        line.angles(np.zeros(1))
    with pytest.raises(PlanError, match="there is no dance 7"):
        line.add(7, 0.0, 1.0)
    for seconds in ((2.0, 1.0), (-1.0, 1.0), (0.0, 99.0), (float("nan"), 1.0)):
        with pytest.raises(PlanError, match="cannot be"):
            line.add(DANCE, *seconds)
    with pytest.raises(PlanError, match="a rate of 0"):
        line.add(DANCE, 0.0, 1.0, 0.0)
    line.add(DANCE, 0.0, 3.0)
    line.settle(2.0)
    with pytest.raises(PlanError, match="settled up to"):
        line.cut(1.0)
    with pytest.raises(PlanError, match="one is needed"):
        RobotLine([], robot)


def test_dances_that_stand_elsewhere_are_refused():
    robot, rest, dance = prepared()
    away = dance.motion.replace(root_positions=dance.motion.root_positions + np.array([0.1, 0, 0]))
    with pytest.raises(PlanError, match="100 mm"):
        RobotLine([rest, RobotDance(away, dance.angles, dance.beats, dance.keyposes)], robot)
