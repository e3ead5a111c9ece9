"""All steps from a dance to a robot's."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from onbeat.errors import BodyError, PlanError
from onbeat.examples.dancers import DANCERS
from onbeat.examples.dances import perform_dance
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import hinge_angles
from onbeat.retime.lock import TimeMap
from onbeat.robots.document import robot_document
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import robot_named
from onbeat.robots.perform import Staged, is_of, limits_of, stage
from onbeat.robots.simulate import Options, simulate
from onbeat.robots.state import configurations
from onbeat.robots.upright import LyingWarning

G1 = robot_named("g1")


@cache
def danced(feet: str = "planted") -> Staged:
    """Seven seconds of the river dance a fifth faster."""
    clip = perform_dance(DANCERS[0], "river dance", 1.0, 1, np.random.default_rng(0), fps=60)
    motion = clip.motion[: 7 * 60]
    return stage(motion, G1, TimeMap.steady(1.2), clip.beats[clip.beats < 7], clip.keyposes[clip.keyposes < 7], feet)


def test_a_dancer_becomes_the_robot_faster_and_inside_its_limits():
    made = danced()
    assert is_of(made.motion, G1)
    assert made.motion.duration == pytest.approx(7 / 1.2, abs=0.05)
    assert made.limits.violations == (0, 0)


def test_planted_feet_do_not_move_and_the_zero_moment_point_is_over_them():
    made = danced()
    places, _ = Legs.of(G1).feet(configurations(G1, made.motion))
    assert np.abs(places - places[0]).max() < 2e-3
    assert made.standing.all()
    assert made.balanced.margin.min() > 0


def test_what_the_balance_does_leaves_the_arms_as_they_were():
    made = danced()
    arms = [k for k, name in enumerate(G1.body.names) if "shoulder" in name or "elbow" in name]
    before, after = (hinge_angles(G1.body, motion)[:, arms] for motion in (made.legs, made.motion))
    assert np.abs(before - after).max() < 1e-9


def test_it_is_upright_to_the_end_by_its_own_sensors_and_meets_its_beats():
    made = danced()
    trial = simulate(G1, made.motion, Options())
    assert trial.upright
    document = robot_document(G1, made, trial, "planted")
    assert document.trial is not None
    assert document.trial.fell_at is None
    assert document.trial.beats_met == document.trial.beats > 5
    assert document.zmp.inside == 1.0
    assert document.speed == pytest.approx(1.2)


def test_a_robot_of_another_body_is_no_own_motion_but_is_retargeted_from():
    assert not is_of(danced().motion, robot_named("talos"))
    assert limits_of(G1).joints == G1.body.names


def test_a_dance_that_has_no_time_is_refused():
    with pytest.raises((PlanError, BodyError)):
        stage(danced().motion, G1, TimeMap.steady(1.0, at=99.0), np.arange(0, 5, 0.5), np.zeros(0))


def test_a_dancer_who_lies_is_told_of():
    clip = perform_dance(DANCERS[0], "river dance", 1.0, 1, np.random.default_rng(0), fps=30)
    down = rot.about(np.array([1.0, 0.0, 0.0]), np.array(-np.pi / 2))
    turns = clip.motion.rotations[:30].copy()
    turns[:, 0] = rot.multiply(down, turns[:, 0])
    lying = clip.motion[:30].replace(rotations=turns)
    with pytest.warns(LyingWarning, match="from upright 100% of the time"):
        stage(lying, G1, TimeMap.steady(1.0), np.array([0.2, 0.7]), np.array([0.2]))
