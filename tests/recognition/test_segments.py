"""Segments: one length, one body, neither place nor facing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_segments import cycles_of, danced, made
from onbeat.errors import BodyError, MetricError
from onbeat.examples.body import Build
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot
from onbeat.recognition.segments import Segments, links_of, segments_of


def one(motion: Motion, start: float, end: float, **how: object) -> Segments:
    return segments_of([motion], [(start, end)], ["bow"], ["Aiko"], [0], **how)


def test_neither_place_nor_facing_is_in_a_segment():
    motion = danced()[0].motion
    elsewhere = turned(motion, 2.0, np.array([3.0, -1.0, 0.5]))
    for frame in ("start", "body"):
        here, there = one(motion, 1, 2.5, frame=frame), one(elsewhere, 1, 2.5, frame=frame)
        assert np.allclose(here.positions, there.positions, atol=1e-9)


def turned(motion: Motion, yaw: float, shift: np.ndarray) -> Motion:
    turn = rot.yaw(np.array(yaw))
    rotations = motion.rotations.copy()
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    return motion.replace(rotations=rotations, root_positions=rot.rotate(turn, motion.root_positions) + shift)


def test_steps_stay_in_only_where_places_are_seen_from_the_start():
    motion = danced()[0].motion
    travelled = motion.root_positions + np.linspace(0, 1, len(motion))[:, None] * [0.0, 2.0, 0.0]
    walking = motion.replace(root_positions=travelled)
    assert not np.allclose(one(motion, 1, 3).positions, one(walking, 1, 3).positions, atol=0.01)
    seen = [one(m, 1, 3, frame="body").positions for m in (motion, walking)]
    assert np.allclose(*seen, atol=1e-9)


def test_how_tall_a_dancer_is_is_not_in_a_segment():
    still = [Motion(Build(t).skeleton, np.tile([1.0, 0, 0, 0], (31, 26, 1)), np.zeros((31, 3)), 30) for t in (1.5, 1.9)]
    both = segments_of(still, [(0, 1)] * 2, ["", ""], ["", ""], [0, 0])
    assert np.allclose(both.positions[0], both.positions[1])
    assert both.sizes[1] / both.sizes[0] == pytest.approx(1.9 / 1.5)


def test_the_rate_of_the_motion_does_not_matter():
    thirty, sixty = danced(30.0)[0].motion, danced(60.0)[0].motion
    assert np.abs(one(thirty, 1.0, 2.0).positions - one(sixty, 1.0, 2.0).positions).max() < 0.02


def test_first_and_last_moment_are_the_ends_of_the_span():
    motion = danced()[0].motion
    read = one(motion, 0.0, motion.times[-1])
    p, hips = motion.positions, list(motion.skeleton.names).index("Hips")
    height = (p[-1, hips, 2] - p[0, hips, 2]) / read.sizes[0]
    assert read.positions[0, -1, read.elements.index("hips"), 2] == pytest.approx(height, abs=1e-9)


def test_segments_of_three_frames_work_and_shorter_ones_are_refused():
    motion = danced(30.0)[0].motion
    assert one(motion, 1.0, 1.0 + 2 / 30).positions.shape[1] == 32
    with pytest.raises(MetricError, match=r"segment 0 of .* long; 0\.0667 s \(3 frames\) are the least"):
        one(motion, 1.0, 1.0 + 1 / 30)


@pytest.mark.parametrize(
    ("start", "end", "says"),
    [
        (np.nan, 1.0, "numbers are needed"),
        (0.0, np.inf, "numbers are needed"),
        (2.0, 1.0, "end after its start"),
        (-1.0, 1.0, "from -1"),
        (0.0, 1e9, "the motion lasts"),
    ],
)
def test_spans_that_cannot_be_are_refused(start: float, end: float, says: str):
    with pytest.raises(MetricError, match=says):
        one(danced()[0].motion, start, end)


def test_lists_that_disagree_and_no_motion_are_refused():
    motion = danced()[0].motion
    with pytest.raises(MetricError, match=r"\[1, 2, 1, 1, 1\] motions"):
        segments_of([motion], [(0, 1), (1, 2)], [""], [""], [0])
    with pytest.raises(MetricError, match="one at least"):
        segments_of([], [], [], [], [])
    with pytest.raises(MetricError, match="start, body, ground"):
        one(motion, 0, 1, frame="world")
    with pytest.raises(MetricError, match="3 at least"):
        one(motion, 0, 1, moments=2)


def test_a_body_without_a_knee_is_refused_by_name():
    bare = Motion(Skeleton(("hips",), [-1], [[0, 0, 0]]), np.tile([1.0, 0, 0, 0], (60, 1, 1)), np.zeros((60, 3)), 30)
    with pytest.raises(BodyError, match="left_knee"):
        one(bare, 0, 1)


def test_velocities_are_body_sizes_a_second():
    rising = np.zeros((1, 5, 1, 3))
    rising[0, :, 0, 2] = np.arange(5)
    assert np.allclose(Segments(rising, [2.0], "x", "y", [0], ("hips",), [0]).velocities[..., 2], 2.0)


def test_some_are_chosen_by_mask_indices_slice_or_none():
    segments = made()
    mask = np.array(segments.task) == "task 1"
    for chosen in (mask, mask.tolist(), np.flatnonzero(mask), np.flatnonzero(mask).tolist()):
        assert segments[chosen].task == ("task 1",) * 6
        assert np.array_equal(segments[chosen].positions, segments.positions[mask])
    assert segments[2:4].cycle.tolist() == segments.cycle[2:4].tolist()
    assert len(segments[[]]) == 0


def test_values_that_are_no_numbers_are_refused():
    segments = made()
    broken = segments.positions.copy()
    broken[5, 3, 1, 0] = np.nan
    with pytest.raises(MetricError, match=r"segment 5 \('task 1' by 'person 1'\) has a place that is not a number"):
        replace(segments, positions=broken)
    with pytest.raises(MetricError, match="beyond 1e\\+06 body sizes"):
        replace(segments, positions=segments.positions * 1e300)
    with pytest.raises(MetricError, match="no body size"):
        replace(segments, sizes=np.full(len(segments), np.inf))
    with pytest.raises(MetricError, match="no duration"):
        replace(segments, durations=np.zeros(len(segments)))
    with pytest.raises(MetricError, match=r"of shape \(24, 2, 6, 3\)"):
        replace(segments, positions=segments.positions[:, :2])
    with pytest.raises(MetricError, match="'task': 3"):
        replace(segments, task=("a", "b", "c"))


def test_nobody_can_change_a_segment():
    with pytest.raises(ValueError, match="read-only"):
        made().positions[0] = 0


def test_links_count_from_the_hips_outwards():
    assert links_of(["left_hip", "left_knee", "left_ankle", "left_toe"]).tolist() == [1, 2, 3, 4]
    assert links_of(["hips", "right_hand", "C7"]).tolist() == [0, 7, 1]


def test_the_other_cycle_is_nearer_than_any_other_task():
    found = cycles_of(danced(), frame="body")
    apart = np.square(found.positions[:, None] - found.positions).mean(axis=(2, 3, 4))
    task = np.array(found.task)
    other = np.arange(len(found)) ^ 1  # the two cycles of a clip follow each other
    assert (apart[np.arange(len(found)), other] < np.where(task[:, None] == task, np.inf, apart).min(axis=1)).all()
