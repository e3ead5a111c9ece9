"""Smoothness: derivatives of known curves, jolts at joins, link errors."""

import numpy as np
import pytest

from onbeat.errors import MetricError
from onbeat.metrics import smoothness
from onbeat.motion import rotations as rot


def test_derivatives_of_a_sine() -> None:
    times = np.arange(240) / 60
    path = np.stack((np.sin(4 * times), 0 * times, 0 * times), axis=1)
    for order in (1, 2, 3):
        at, values = smoothness.derivative(path, 60, order)
        exact = np.abs(4**order * (np.cos(4 * at) if order % 2 else np.sin(4 * at)))
        assert values == pytest.approx(exact, abs=0.015 * 4**order)
        assert at[-1] - at[0] > 3.7


def test_steady_movement_has_no_jerk_up_to_its_ends() -> None:
    path = np.outer(np.arange(90) / 30, [1.0, -2.0, 0.5])
    assert smoothness.derivative(path, 30, 3)[1] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("fps", [30, 120])
def test_frames_per_second_do_not_matter(sway, fps: float) -> None:
    want = smoothness.evaluate(sway(fps=60), np.zeros(0))["jerk_hands_elsewhere"]
    assert smoothness.evaluate(sway(fps=fps), np.zeros(0))["jerk_hands_elsewhere"] == pytest.approx(want, rel=0.01)


def test_a_jolt_shows_inside_the_window_of_its_join_alone(sway) -> None:
    motion = sway()
    turned = motion.rotations.copy()
    arm = motion.skeleton.index("lhumerus")
    turned[300:, arm] = rot.multiply(rot.about(np.array([0.0, 1, 0]), 0.5), turned[300:, arm])
    found = smoothness.evaluate(motion.replace(rotations=turned), np.array([5.0]), [motion])
    assert found["jerk_hands_joins"] > 1.5 * found["jerk_hands_elsewhere"]
    assert found["jerk_hands_p95_ratio"] > 4
    assert found["jerk_hands_elsewhere"] == pytest.approx(found["jerk_hands_source"], rel=0.05)
    assert found["jerk_hands_ratio"] == pytest.approx(found["jerk_hands_joins"] / found["jerk_hands_source"])
    assert found["jerk_feet_joins"] == pytest.approx(0.0, abs=1e-6)
    assert found["jerk_feet_ratio"] is None


def test_without_source_joins_stand_against_elsewhere(sway) -> None:
    found = smoothness.evaluate(sway(), np.array([5.0]))
    assert found["jerk_hands_source"] is None
    assert found["jerk_hands_ratio"] == pytest.approx(1.0, abs=0.25)


def test_too_short_to_differentiate(sway) -> None:
    assert smoothness.evaluate(sway(0.05), np.zeros(0))["jerk_all_elsewhere"] is None


def test_link_errors_of_joins(sway) -> None:
    clip = sway()
    same = smoothness.join_link_errors([clip, clip], [(0, 0.0, 2.0), (1, 2.0, 4.0)])
    assert same == pytest.approx([0.0], abs=1e-6)
    # From one end of the swing (0.25 s) to the other (0.75 s) both arms turn by 1.6 rad; without collars and hands of
    # their own, all four links of an arm do.
    ends = smoothness.join_link_errors([clip], [(0, 0.0, 0.25), (0, 0.75, 2.0), (0, 0.75, 1.0)])
    assert ends[0] == pytest.approx(8 * np.degrees(1.6) / 17, rel=1e-6)
    assert len(ends) == 2
    assert smoothness.join_link_errors([clip], [(0, 0.0, 1.0)]).shape == (0,)


@pytest.mark.parametrize(
    ("paths", "fps", "message"),
    [
        (np.zeros(3), 30.0, r"paths have shape \(3,\); \(frames, ..., 3\) is needed"),
        (np.zeros((5, 2)), 30.0, r"shape \(5, 2\)"),
        (np.where(np.arange(15).reshape(5, 3) == 7, np.nan, 0.0), 30.0, "not a number at frame 2"),
        (np.zeros((5, 3)), 0.0, "0.0 frames per second"),
    ],
)
def test_bad_input_is_named(paths: np.ndarray, fps: float, message: str) -> None:
    with pytest.raises(MetricError, match=message):
        smoothness.derivative(paths, fps, 1)
