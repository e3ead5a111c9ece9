"""Points of a segment back on a body that plays."""

from __future__ import annotations

import numpy as np
import pytest

from made_segments import danced
from onbeat.errors import MetricError
from onbeat.examples.body import Build
from onbeat.motion import Motion
from onbeat.recognition.placing import placed
from onbeat.recognition.segments import FRAMES, segments_of


def segment(motion: Motion, start: float, end: float, frame: str, moments: int = 128):
    return segments_of([motion], [(start, end)], [""], [""], [0], frame=frame, moments=moments)


@pytest.mark.parametrize("frame", FRAMES)
def test_a_motions_own_points_give_it_back(frame: str):
    motion = danced()[0].motion[60:180]
    read = segment(motion, 0, float(motion.times[-1]), frame)
    again = placed(read.positions[0], read.elements, motion, float(read.durations[0]))
    assert len(again) == len(motion)
    assert np.abs(again.positions - motion.positions).max() < 0.01


@pytest.mark.parametrize("frame", FRAMES)
def test_the_points_come_back_on_another_body_that_danced_something_else(frame: str):
    source, other = danced()[0].motion, danced()[5].motion
    read = segment(source, 1, 2.5, frame, 64)
    made = placed(read.positions[0], read.elements, other[30:100], 1.5)
    again = segment(made, 0, float(made.times[-1]), frame, 64)
    assert np.abs(again.positions - read.positions).mean() < 0.01  # bodies have other proportions
    assert made.skeleton is other.skeleton


def test_the_feet_are_as_low_as_those_of_the_base():
    motion = danced()[0].motion
    read = segment(motion, 1, 3, "start")
    away = np.array([4.0, 5.0, 6.0])
    base = Motion(Build(1.5).skeleton, motion.rotations[:90], motion.root_positions[:90] + away, 60)
    made = placed(read.positions[0], read.elements, base, 2.0, "small")
    feet = [made.skeleton.names.index(side + "ToeBase") for side in ("Left", "Right")]
    assert made.positions[:, feet, 2].min() == pytest.approx(base.positions[:, feet, 2].min(), abs=1e-6)
    assert np.allclose(made.positions[0, 0, :2], base.positions[0, 0, :2], atol=1e-6)
    assert made.name == "small"


def test_the_length_is_as_asked_whatever_the_base_lasts():
    motion = danced()[0].motion
    read = segment(motion, 1, 3, "start")
    for seconds in (0.02, 0.5, 7.0):
        made = placed(read.positions[0], read.elements, motion[:20], seconds)
        assert abs((len(made) - 1) / made.fps - seconds) < 1 / made.fps


def test_what_cannot_be_placed_is_refused():
    motion = danced()[0].motion
    read = segment(motion, 1, 3, "start")
    points, names = read.positions[0], read.elements
    with pytest.raises(MetricError, match="no left_hip"):
        placed(points, tuple("x" if name == "left_hip" else name for name in names), motion, 1.0)
    with pytest.raises(MetricError, match="all numbers"):
        placed(points * np.nan, names, motion, 1.0)
    for seconds in (0.0, -1.0, np.nan, 1e9):
        with pytest.raises(MetricError, match="a length of"):
            placed(points, names, motion, seconds)
