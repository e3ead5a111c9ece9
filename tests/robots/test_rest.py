"""A robot in its zero configuration."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat.robots.description.rest import excluded, rest_frames, segment_distances, standing_height
from onbeat.robots.description.toml import described

POINT = st.tuples(*[st.floats(-1, 1).map(lambda x: round(x, 2))] * 3)


@given(POINT, POINT, POINT, POINT)
def test_no_points_of_two_segments_are_nearer_than_their_distance(a, b, c, d):
    ends = [np.array(point) for point in (a, b, c, d)]
    found = float(segment_distances(*ends))
    s, t = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41))
    first = ends[0] + s[..., None] * (ends[1] - ends[0])
    other = ends[2] + t[..., None] * (ends[3] - ends[2])
    nearest = np.linalg.norm(first - other, axis=-1).min()
    assert found <= nearest + 1e-9
    reach = np.linalg.norm(ends[1] - ends[0]) + np.linalg.norm(ends[3] - ends[2])
    assert found >= nearest - reach / 40


def test_distances_are_exact():
    square = np.array([[0, 0, 0], [1, 0, 0]], float)
    for other, distance in (
        ([[0, 2, 0], [1, 2, 0]], 2),  # along each other
        ([[0.5, -1, 1], [0.5, 1, 1]], 1),  # across
        ([[2, 0, 0], [3, 0, 0]], 1),  # in line
        ([[0.3, 0, 0.5], [0.3, 0, 0.5]], 0.5),  # a point
    ):
        assert segment_distances(*square, *np.array(other, float)) == pytest.approx(distance, abs=1e-12)


def test_neighbours_and_what_overlaps_are_not_looked_at():
    pairs = {frozenset(pair) for pair in excluded(described("g1"))}
    assert frozenset(("pelvis", "left_hip_roll_link")) in pairs
    assert frozenset(("left_hip_yaw_link", "left_knee_link")) in pairs
    for apart in (
        ("torso_link", "left_elbow_link"),
        ("torso_link", "left_shoulder_yaw_link"),
        ("left_hip_yaw_link", "right_hip_yaw_link"),
        ("left_ankle_roll_link", "right_ankle_roll_link"),
        ("left_wrist_yaw_link", "right_wrist_yaw_link"),
        ("pelvis", "left_wrist_yaw_link"),
    ):
        assert frozenset(apart) not in pairs


@pytest.mark.parametrize(("name", "height"), [("g1", 0.7919), ("hrp4c", 0.7842), ("talos", 1.0831)])
def test_it_stands_as_high_as_it_is(name: str, height: float):
    assert standing_height(described(name)) == pytest.approx(height, abs=1e-4)
    assert next(iter(rest_frames(described(name)))) == described(name).root.link
