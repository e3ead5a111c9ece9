"""Laws of the metrics of motion: where and which way a dance faces does not matter, nor when it begins."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.metrics import feet, smoothness
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

SIDE_JOINTS = ("humerus", "radius", "wrist", "femur", "tibia", "foot")
LEFT = [[-0.2, 0, 0.1], [0, 0, -0.3], [0, 0, -0.25], [-0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4]]
BODY = Skeleton(
    ("hips", "chest", *(side + joint for side in "lr" for joint in SIDE_JOINTS)),
    [-1, 0, 1, 2, 3, 0, 5, 6, 1, 8, 9, 0, 11, 12],
    [[0, 0, 0], [0, 0, 0.4], *LEFT, *([-x, y, z] for x, y, z in LEFT)],
)
JOINS = np.array([0.6, 1.4])


def wandering(seed: int, seconds: float = 2.0, fps: float = 30.0) -> Motion:
    draw = np.random.default_rng(seed)
    turns = np.cumsum(draw.normal(0, 0.05, (round(seconds * fps), len(BODY), 3)), axis=0)
    path = np.cumsum(draw.normal(0, 0.01, (len(turns), 3)), axis=0)
    return Motion(BODY, rot.exp(turns), path, fps)


def measured(motion: Motion, joins: np.ndarray) -> dict[str, float]:
    """All that can be measured; a dance without its source has no scores of it."""
    contacts = np.random.default_rng(5).random((len(motion), 2)) < 0.7
    scores = feet.evaluate(motion, contacts, joins) | smoothness.evaluate(motion, joins)
    return {name: value for name, value in scores.items() if value is not None}


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 999), st.floats(-3, 3), st.floats(-50, 50), st.floats(-50, 50))
def test_place_and_facing_do_not_matter(seed: int, yaw: float, x: float, y: float) -> None:
    motion = wandering(seed)
    turned = motion.rotations.copy()
    turned[:, 0] = rot.multiply(rot.yaw(yaw), turned[:, 0])
    path = rot.rotate(rot.yaw(yaw), motion.root_positions) + np.array([x, y, 0.0])
    moved = motion.replace(rotations=turned, root_positions=path)
    assert measured(moved, JOINS) == pytest.approx(measured(motion, JOINS), rel=1e-5, abs=1e-7)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 999))
def test_a_join_is_its_window(seed: int) -> None:
    motion = wandering(seed)
    spans = JOINS[:, None] + np.array([-0.4, 0.4])
    assert measured(motion, spans) == measured(motion, JOINS)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 999), st.sampled_from([0.5, 2.0]))
def test_faster_motion_has_more_jerk(seed: int, speed: float) -> None:
    motion = wandering(seed)
    path = motion.positions[:, :1]
    (_, base), (_, other) = (smoothness.derivative(path, fps, 3) for fps in (30.0, 30.0 * speed))
    assert (other.mean() > base.mean()) == (speed > 1)
