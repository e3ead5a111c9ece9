from __future__ import annotations

import numpy as np
import pytest

from onbeat.motion import rotations as rot
from onbeat.motion.contacts import point_speeds, resting, runs, twist


def stepping(fps: float, floor: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A point that rests for 0.6 s and steps 0.4 m in 0.4 s, and its twin that does so half a second later."""
    t = np.arange(round(6 * fps)) / fps

    def path(t):
        part = np.clip(((t % 1.0) - 0.6) / 0.4, 0, 1)
        ease = part**2 * (3 - 2 * part)
        return np.stack(
            (np.zeros_like(t), 0.4 * (np.floor(t) + ease), floor + 0.12 * np.sin(np.pi * part) ** 2), axis=1
        )

    return t, np.stack((path(t), path(t + 0.5)), axis=1)


@pytest.mark.parametrize("fps", [30, 60, 120])
@pytest.mark.parametrize("floor", [0.0, -0.3, 1.2])
def test_rests_are_found_at_any_rate_and_floor(fps, floor):
    t, paths = stepping(fps, floor)
    rests, found = resting(paths, fps)
    assert found == pytest.approx(floor, abs=1e-3)
    for first, last in runs(rests[:, 0]):
        assert (t[first] + 0.12) % 1.0 < 0.24, "comes down when the point does"
        if last < len(t):
            assert abs(t[last] % 1.0 - 0.6) < 0.12, "lifts when the point does"
    assert len(runs(rests[:, 0])) == 6


def test_rates_agree():
    labels = {fps: resting(stepping(fps)[1], fps)[0] for fps in (30, 60, 120)}
    for fps in (60, 120):
        assert np.mean(labels[fps][:: fps // 30] != labels[30]) < 0.03


def test_slow_but_high_and_low_but_fast_are_no_contacts():
    t = np.arange(120) / 60
    high = np.stack((0 * t, 0 * t, np.where(t < 1, 0.0, 0.3)), axis=1)
    fast = np.stack((np.where(t < 1, 0.0, (t - 1) * 1.5), 0 * t, 0 * t), axis=1)
    rests, _ = resting(np.stack((high, fast), axis=1), 60)
    assert rests[:50].all()
    assert not rests[75:].any()


def test_a_touch_shorter_than_a_tenth_of_a_second_is_none_and_a_short_gap_is_filled():
    height = np.zeros(200)
    height[100:108] = 0.3
    height[108:114] = 0.0
    height[114:] = 0.3
    path = np.stack((np.zeros(200), np.zeros(200), height), axis=1)[:, None]
    path[100:, :, 0] = np.linspace(0, 2, 100)[:, None]
    rests, _ = resting(path, 120)
    assert len(runs(rests[:, 0])) == 1


def test_one_frame_has_no_speed():
    assert point_speeds(np.ones((1, 2, 3)), 60).tolist() == [[0.0, 0.0]]
    assert resting(np.ones((1, 2, 3)), 60)[0].all()


def test_runs_of_nothing():
    assert runs(np.zeros(4, bool)) == []
    assert runs(np.zeros(0, bool)) == []


def test_twist_is_the_turn_about_the_vertical_whatever_the_tilt():
    tilt = rot.about(np.array([1.0, 0, 0]), 0.4)
    assert twist(tilt, rot.multiply(rot.yaw(0.7), tilt)) == pytest.approx(0.7)
    assert twist(tilt, -rot.multiply(rot.yaw(-0.7), tilt)) == pytest.approx(-0.7)


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_lost_frames_far_below_change_no_other_contact(fps):
    _, paths = stepping(fps)
    bad = slice(3 * fps, 3 * fps + round(0.2 * fps))
    broken = paths.copy()
    broken[bad] = [0.0, 0.0, -0.9]
    (rests, floor), (expected, sound) = resting(broken, fps), resting(paths, fps)
    assert floor == pytest.approx(sound, abs=1e-3)
    assert not rests[bad.start + 1 : bad.stop - 1].any()
    far = np.abs(np.arange(len(paths)) / fps - 3.1) > 0.4
    assert np.array_equal(rests[far], expected[far])
