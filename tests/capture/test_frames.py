from __future__ import annotations

import numpy as np
import pytest

from capture.marked import dancing, hidden, marked
from onbeat.capture import fit_body, marker_body_frames
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.body import body_frames


def test_frames_of_markers_are_those_of_the_body_under_them():
    motion = dancing(1.0)
    markers = marked(motion, noise_m=0.001)
    turns, origins = marker_body_frames(markers)
    for body in (motion, fit_body(markers).motion):
        true_turns, true_origins = body_frames(body)
        assert np.degrees(rot.angle_between(turns, true_turns)).max() < 3
        assert np.linalg.norm(origins - true_origins, axis=1).max() < 0.015


def test_gaps_of_the_pelvis_are_bridged():
    motion = dancing(1.0)
    markers = marked(motion)
    holed = hidden(hidden(markers, "LFWT", 0.3, 0.8), "RBWT", 0.3, 0.8)
    turns, origins = marker_body_frames(holed)
    true_turns, true_origins = body_frames(motion)
    assert np.degrees(rot.angle_between(turns, true_turns)).max() < 4
    assert np.linalg.norm(origins - true_origins, axis=1).max() < 0.05


def test_arms_and_legs_are_not_needed_but_shoulders_are():
    markers = marked(dancing(0.5))
    trunk = markers.chosen(["LFWT", "RFWT", "LBWT", "RBWT", "LSHO", "RSHO"])
    assert marker_body_frames(trunk)[0].shape == (30, 4)
    with pytest.raises(BodyError, match="left_shoulder"):
        marker_body_frames(markers.chosen(["LFWT", "RFWT", "LBWT", "RBWT"]))
