"""The master's body in the pupil's place: what lies between them is what the pupil does otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from made_segments import danced
from onbeat.errors import MetricError
from onbeat.motion import Body, Motion
from onbeat.motion import rotations as rot
from onbeat.motion.edit import scaled
from onbeat.recognition.ghost import Beside, beside
from onbeat.recognition.pupil import pairing
from onbeat.recognition.segments import segments_of


def seen(pupil: Motion, master: Motion, spans: list[tuple[float, float]], theirs: list[tuple[float, float]]) -> Beside:
    count = len(spans)
    names = ([""] * count, [""] * count, [0] * count)
    mine = segments_of([pupil] * count, spans, *names, frame="ground", moments=40)
    wanted = segments_of([master] * count, theirs, *names, frame="ground", moments=40)
    return beside(pupil, master, spans, theirs, pairing(mine, wanted))


def elsewhere(motion: Motion) -> Motion:
    """The same dance, larger, turned and on another spot."""
    turn = rot.yaw(1.0)
    rotations = motion.rotations.copy()
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    root = rot.rotate(turn, motion.root_positions) + np.array([3.0, -2.0, 0.4])
    return scaled(motion.replace(rotations=rotations, root_positions=root), 1.3)


def test_size_place_and_front_of_the_master_do_not_count():
    motion = danced()[0].motion
    found = seen(motion, elsewhere(motion), [(0.5, 4.5)], [(0.5, 4.5)])
    assert np.abs(found.errors).max() < 1e-4
    assert np.abs(found.master.positions - found.pupil.positions).max() < 1e-4


def test_who_dances_slower_is_met_at_the_same_moment():
    motion = danced()[0].motion
    slow = motion.at(np.arange(2 * len(motion)) / (2 * motion.fps))
    found = seen(slow, motion, [(1.0, 9.0)], [(0.5, 4.5)])
    assert len(found.pupil) == pytest.approx(8 * motion.fps, abs=2)
    assert np.abs(found.errors).max() < 0.03


def test_an_arm_that_is_held_otherwise_is_told_from_the_rest():
    motion = danced()[0].motion
    body = Body.of(motion.skeleton)
    rotations = motion.rotations.copy()
    arm = body["left_elbow"]
    rotations[:, arm] = rot.multiply(rotations[:, arm], rot.about(np.array([0.0, 0, 1]), np.full(len(motion), 0.5)))
    found = seen(motion.replace(rotations=rotations), motion, [(0.5, 4.5)], [(0.5, 4.5)])
    mean = dict(zip(found.elements, found.errors.mean(axis=0), strict=True))
    assert max(mean, key=mean.__getitem__) in ("left_wrist", "left_hand")
    assert mean["right_wrist"] < 0.3 * mean["left_wrist"]
    levels = dict(zip(motion.skeleton.names, found.joint_errors().mean(axis=0), strict=True))
    assert levels[motion.skeleton.names[body["left_wrist"]]] == pytest.approx(mean["left_wrist"])


def test_between_segments_nothing_is_compared():
    motion = danced()[0].motion
    found = seen(motion, motion, [(0.5, 1.5), (3.0, 4.0)], [(0.5, 1.5), (3.0, 4.0)])
    gap = slice(round(1.1 * motion.fps), round(2.4 * motion.fps))
    assert np.isnan(found.errors[gap]).all()
    assert np.isfinite(found.errors[: round(0.9 * motion.fps)]).all()
    assert found.starts.tolist() == [0.0, 2.5]


def test_no_segment_is_refused():
    motion = danced()[0].motion
    with pytest.raises(MetricError, match="0 segments"):
        beside(motion, motion, [], [], np.zeros((0, 8)))
