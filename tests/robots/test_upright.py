"""Dancers who do not stand."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.motion.unitree_g1 import G1
from onbeat.robots.upright import LyingWarning, root_tilt, warn_of_lying


def test_lying_is_told_with_its_share_and_beginning():
    tilt = np.repeat([5.0, 85.0, 10.0], [30, 20, 50])
    with pytest.warns(LyingWarning, match=r"over 60° from upright 20% of the time \(first at 1\.0 s\)"):
        warn_of_lying(tilt, 30.0)


def test_a_bow_is_not():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_lying(np.repeat([5.0, 55.0, 75.0], [60, 37, 3]), 30.0)


def test_a_robot_leans_as_its_root_does_however_it_is_turned():
    turns = np.tile(rot.IDENTITY, (3, len(G1.skeleton), 1))
    turns[1, 0] = rot.yaw(np.array(2.0))
    turns[2, 0] = rot.multiply(rot.yaw(np.array(2.0)), rot.about(np.array([0.0, 1.0, 0.0]), np.array(np.radians(75))))
    motion = Motion(G1.skeleton, turns, np.zeros((3, 3)), fps=30)
    np.testing.assert_allclose(root_tilt(motion), [0, 0, 75], atol=1e-4)
