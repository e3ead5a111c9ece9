"""Pushing apart what still touches."""

import numpy as np
import pytest

from onbeat.robots.ik.clear import LEAST, cleared, gaps
from onbeat.robots.ik.collision import capsules_of
from onbeat.robots.ik.directions import aims_of
from onbeat.robots.ik.trajectory import Problem, Rules, solve
from onbeat.robots.ik.tree import ROOT, tree_of
from onbeat.robots.model import robot_named

pytest.importorskip("mujoco")


def test_an_arm_in_the_trunk_comes_out(swinger):
    robot = robot_named("g1")
    body, capsules, dancer = robot.body, capsules_of(robot), swinger[:30]
    wide, every = np.full(ROOT, np.inf), np.ones(ROOT + 29)
    low, high = np.concatenate((-wide, body.low)), np.concatenate((wide, body.high))
    rules = Rules(low, high, 0 * every, 0.03 * every, 0.02 * every, 0.005 * every, 50 * every, 10.0)
    problem = Problem(
        tree_of(body), aims_of(dancer, robot), capsules, rules, np.ones((30, len(capsules.pairs))), 1 / 60
    )
    x = solve(problem, np.tile(np.clip(0.1 * every, low, high), (30, 1))).x
    x[12:18, ROOT + body.names.index("left_shoulder_yaw_joint")] = -1.3
    x[12:18, ROOT + body.names.index("left_elbow_joint")] = 0.2
    x[12:18, ROOT + body.names.index("left_shoulder_roll_joint")] = 0.0
    assert gaps(problem, x).min() < 0
    assert (gaps(problem, cleared(problem, x)) >= LEAST * capsules.margins).all()
