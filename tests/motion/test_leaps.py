import numpy as np
import pytest

from onbeat.motion.leaps import LEAP, frames_to_use, leap_speeds


def kick(fps: float, speed: float = 14.0, lasts: float = 0.25) -> np.ndarray:
    """(F, 1, 3) a foot that stands, kicks as fast as dancers and fighters do, and stands again."""
    t = np.arange(round(2 * fps)) / fps
    phase = np.clip((t - 0.8) / lasts, 0, 1)
    way = speed * lasts / 2 * (phase - np.sin(2 * np.pi * phase) / (2 * np.pi))
    return np.stack((way, np.zeros_like(t), np.full_like(t, 0.1)), axis=1)[:, None]


def leaps_of(path: np.ndarray, fps: float) -> np.ndarray:
    return (leap_speeds(path, fps) > LEAP).any(axis=1)


@pytest.mark.parametrize("fps", [12, 24, 30, 60, 120, 240, 1000])
def test_a_kick_is_no_leap_at_any_rate(fps):
    assert leap_speeds(kick(fps), fps).max() < 0.6 * LEAP


@pytest.mark.parametrize("fps", [24, 30, 60, 120, 240])
def test_a_knee_on_the_wrong_side_for_a_moment_leaps_at_any_rate(fps):
    path = kick(fps)
    wrong = slice(round(1.5 * fps), round(1.5 * fps) + max(round(0.03 * fps), 1))
    path[wrong, 0, 1] += 0.4
    frames = np.flatnonzero(leaps_of(path, fps))
    assert wrong.start - 1 in frames
    assert wrong.stop - 1 in frames
    assert (np.abs(frames / fps - 1.5) < 0.1).all()


def test_jitter_of_a_fast_camera_is_no_leap():
    path = kick(1000)
    noise = np.random.default_rng(0).normal(0, 0.002, path.shape)
    assert not leaps_of(path + noise, 1000).any()


@pytest.mark.parametrize("fps", [30, 120])
def test_lost_frames_are_left_out_whole_however_long_they_are(fps):
    t = np.arange(6 * fps) / fps
    path = np.stack((np.sin(t), np.cos(t), np.full_like(t, 0.9)), axis=1)[:, None]
    path[2 * fps : 5 * fps] = 0.0
    good = frames_to_use(path, fps, leaps_of(path, fps))
    assert not good[2 * fps - 1 : 5 * fps + 1].any()
    assert good[: round(1.8 * fps)].all()
    assert good[round(5.2 * fps) :].all()


def test_who_stands_still_without_leaps_is_used():
    path = np.zeros((120, 1, 3))
    assert frames_to_use(path, 60, leaps_of(path, 60)).all()
