"""Who dances: bodies put together, drawn where they are, and the names that can be asked for."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.examples.troupe import dance_library
from onbeat.live.cast import Known, distinct, following
from onbeat.live.robot.cast import on_robot
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.motion import Motion
from onbeat.robots.model import robot_named


def known(place: int, name: str | None = None) -> Known:
    one = dance_library()[place]
    motion = one.motion if name is None else one.motion.replace(name=name)
    return Known(motion, np.asarray(one.beats), np.asarray(one.keyposes))


@pytest.fixture(scope="module")
def cast():
    return following([known(0, "step"), known(1, "step")])


def test_two_of_a_name_can_both_be_asked_for(cast):
    assert cast.conductor.picker.names == ("step", "step 2")
    assert distinct(["a", "a", "a 2", "a"]) == ["a", "a 2", "a 2 2", "a 3"]


def test_points_are_where_the_rotations_put_the_joints(cast):
    own = np.arange(0.5, 1.0, 0.1)
    poses = cast.dancer.poses(7, cast.dancer.followed.values(own, cast.dancer.start(0.5)), own)
    assert [pose.number for pose in poses] == list(range(7, 12))
    rotations, roots = np.stack([p.rotations for p in poses]), np.stack([p.root for p in poses])
    places = forward_kinematics(cast.dancer.skeleton, rotations, roots)[1]
    columns = [cast.who.joints.index(name) for name in cast.who.points]
    assert np.allclose(places[:, columns], [pose.points for pose in poses], atol=1e-5)


def test_the_body_stands_on_the_floor_that_is_told(cast):
    rotations, roots = cast.conductor.line.pose(np.array([0.2]))
    lowest = forward_kinematics(cast.dancer.skeleton, rotations, roots)[1][..., 2].min()
    assert cast.drawn.floor == pytest.approx(lowest, abs=0.08)


def test_bounds_hold_what_the_clips_themselves_do(cast):
    turned = cast.dancer.turned
    motion = dance_library()[0].motion
    times = np.arange(0, motion.duration - 0.1, 1 / 60)

    class Shown:
        def pose(self, own):
            shown = motion.at(own)
            return shown.rotations, shown.root_positions

    line, turned.line = turned.line, Shown()
    try:
        values = turned.values(times, turned.start(0.0))
    finally:
        turned.line = line
    assert (np.abs(np.diff(values, axis=0)) * 60 <= turned.bounds.speed * (1 + 1e-9)).all()


def test_without_a_dance_or_beats_there_is_no_cast():
    with pytest.raises(PlanError, match="no choreography"):
        following([])
    one = known(0)
    with pytest.raises(PlanError, match="two or more"):
        following([Known(one.motion, np.zeros(0), np.zeros(0))])


def test_a_dancer_of_another_build_is_put_on_the_first_ones_bones():
    other = known(len(dance_library()) - 1)
    both = following([known(0), other])
    assert both.dancer.skeleton == dance_library()[0].motion.skeleton


@pytest.fixture(scope="module")
def robot():
    one = known(0)
    part = one.motion[: round(8 * one.motion.fps)]
    return on_robot([Known(Motion(part.skeleton, part.rotations, part.root_positions, part.fps, "part"),
                           one.beats[one.beats < 8], one.keyposes[one.keyposes < 8])], robot_named("g1"))  # fmt: skip


def test_a_robot_is_drawn_where_its_hinges_put_it(robot):
    own = np.array([0.3, 0.4])
    (first, _) = robot.dancer.poses(0, robot.dancer.values(own, robot.dancer.start(0.3)), own)
    assert first.angles.shape == (29,)
    assert first.rotations.shape == (1, 4)
    assert len(first.points) == len(robot.who.points)
    assert first.points[:, 2].min() > -0.05
    assert first.points[:, 2].max() < 1.6
    assert robot.drawn.floor == pytest.approx(0.0, abs=0.02)


def test_a_robots_bounds_are_its_models(robot):
    body = robot_named("g1").body
    assert (robot.dancer.bounds.low >= body.low - 1e-9).all()
    assert (robot.dancer.bounds.speed <= np.asarray(body.speed) + 1e-9).all()
