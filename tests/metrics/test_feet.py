"""Feet: a planted, a sliding, a rolling and a torn leg."""

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.metrics import feet
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

NO_JOINS = np.zeros(0)


def sliding(skeleton: Skeleton, speed: float = 0.0, seconds: float = 4.0, fps: float = 60.0) -> Motion:
    """A stiff body that slides to its front, and sideways as fast, so that neither component is all."""
    times = np.arange(round(seconds * fps)) / fps
    path = np.stack((speed * times * 0.6, speed * times * 0.8, 0.85 + 0 * times), axis=1)
    return Motion(skeleton, np.tile(rot.IDENTITY, (len(times), len(skeleton), 1)), path, fps)


def both(motion: Motion) -> np.ndarray:
    return np.ones((len(motion), 2), bool)


@pytest.mark.parametrize("fps", [24, 30, 60, 120])
def test_skate_is_the_full_speed_along_the_floor(skeleton: Skeleton, fps: float) -> None:
    motion = sliding(skeleton, 0.3, fps=fps)
    assert feet.contact_speeds(motion, both(motion)) == pytest.approx(0.3)


def test_a_standing_foot_does_not_skate(skeleton: Skeleton) -> None:
    scores = feet.evaluate(sliding(skeleton), both(sliding(skeleton)), NO_JOINS)
    assert scores["skate_elsewhere"] == scores["skate_elsewhere_p95"] == pytest.approx(0.0)
    assert scores["skate_joins"] is None
    assert scores["skate_ratio"] is None


def test_speed_in_the_air_does_not_count(skeleton: Skeleton) -> None:
    motion = sliding(skeleton, 2.0)
    contacts = both(motion)
    contacts[:, 1] = False
    speeds = feet.contact_speeds(motion, contacts)
    assert np.isnan(speeds[:, 1]).all()
    assert speeds[:, 0] == pytest.approx(2.0)


def test_a_foot_that_turns_on_its_heel_does_not_skate(skeleton: Skeleton) -> None:
    still = sliding(skeleton)
    turning = still.rotations.copy()
    turning[:, skeleton.index("lfoot")] = rot.yaw(2 * still.times)
    motion = still.replace(rotations=turning)
    assert np.ptp(motion.positions[:, skeleton.index("ltoes")], axis=0)[0] > 0.1
    assert feet.contact_speeds(motion, both(motion)) == pytest.approx(0.0)


def test_a_sliding_body_cannot_hide_in_the_air(skeleton: Skeleton) -> None:
    motion = sliding(skeleton, 0.4)
    scores = feet.evaluate(motion, ~both(motion), np.array([[1.0, 2.0]]))
    assert scores["skate_joins"] is None
    assert scores["support_joins"] == pytest.approx(0.4)
    assert scores["support_elsewhere"] == pytest.approx(0.4)
    assert scores["support_ratio"] == pytest.approx(1.0)


def test_joins_are_measured_apart_and_against_the_source(skeleton: Skeleton) -> None:
    motion = sliding(skeleton, 0.1)
    path = motion.root_positions.copy()
    jolt = np.abs(motion.times - 2.0) < 0.3
    path[:, 0] += np.cumsum(jolt) * 0.5 / motion.fps
    motion = motion.replace(root_positions=path)
    source = sliding(skeleton, 0.05)
    scores = feet.evaluate(motion, both(motion), np.array([2.0]), [(source, both(source))], window=0.25)
    assert scores["skate_joins"] == pytest.approx(np.hypot(0.56, 0.08), rel=1e-3)
    assert scores["skate_elsewhere"] == pytest.approx(0.1)
    assert scores["skate_source"] == pytest.approx(0.05)
    assert scores["skate_ratio"] == pytest.approx(np.hypot(0.56, 0.08) / 0.05, rel=1e-3)


def test_straight_and_torn_legs(skeleton: Skeleton) -> None:
    scores = feet.evaluate(sliding(skeleton), both(sliding(skeleton)), NO_JOINS)
    assert scores["extension_max"] == pytest.approx(1.0)
    assert scores["over_reach_m"] == pytest.approx(0.0, abs=1e-12)
    assert scores["straight_part"] == 1.0
    motion = sliding(skeleton)
    torn = np.tile(skeleton.offsets, (len(motion), 1, 1))
    torn[100, skeleton.index("lfoot")] *= 1.1
    motion = Motion(skeleton, motion.rotations, motion.root_positions, motion.fps, translations=torn)
    assert feet.evaluate(motion, both(motion), NO_JOINS)["over_reach_m"] == pytest.approx(0.04)


def test_a_bent_leg_is_shorter(skeleton: Skeleton) -> None:
    still = sliding(skeleton)
    bent = still.rotations.copy()
    bent[:, skeleton.index("ltibia")] = rot.about(np.array([1.0, 0, 0]), np.full(len(still), -np.pi / 2))
    extension = feet.leg_extensions(still.replace(rotations=bent))
    assert extension[:, 0] == pytest.approx(np.sqrt(0.5))
    assert extension[:, 1] == pytest.approx(1.0)


def test_acceleration_of_a_push(skeleton: Skeleton) -> None:
    motion = sliding(skeleton)
    path = motion.root_positions.copy()
    path[:, 0] = motion.times**2
    scores = feet.evaluate(motion.replace(root_positions=path), both(motion), NO_JOINS)
    assert scores["acceleration_elsewhere"] == pytest.approx(2.0, rel=0.02)


def test_one_frame_has_nothing_to_measure(skeleton: Skeleton) -> None:
    motion = sliding(skeleton)[:1]
    scores = feet.evaluate(motion, both(motion), NO_JOINS)
    assert scores["skate_elsewhere"] == 0.0
    assert scores["acceleration_elsewhere"] is None


@pytest.mark.parametrize("contacts", [np.ones((3, 2), bool), np.ones((240, 2)), np.ones(240, bool)])
def test_bad_contacts_are_named(skeleton: Skeleton, contacts: np.ndarray) -> None:
    with pytest.raises(MetricError, match=r"contacts are .* of shape .*; bool of shape \(240, 2\)"):
        feet.evaluate(sliding(skeleton), contacts, NO_JOINS)


def test_bad_joins_are_named(skeleton: Skeleton) -> None:
    motion = sliding(skeleton)
    with pytest.raises(MetricError, match=r"joins have shape \(1, 1\)"):
        feet.evaluate(motion, both(motion), np.zeros((1, 1)))
