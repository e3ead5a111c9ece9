"""One take that is there twice is found, however it was stored; another take of the same moves is kept."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from onbeat.formats import read_motion
from onbeat.moves.library import GRID
from onbeat.moves.making.twins import find_twins
from onbeat.moves.poses import DIRECTIONS, VELOCITIES, pose_vectors

SECONDS = np.arange(120) / GRID


def moves(seed, seconds=SECONDS, turned=0.0, shake=0.0):
    """Pose vectors of links that turn to and fro, at given seconds; the shake is another one at each call."""
    rng = np.random.default_rng(seed)
    hertz, phase, size = rng.uniform(0.2, 3, (51, 6)), rng.uniform(0, 7, (51, 6)), rng.normal(0, 0.03, (51, 6))
    size[:9] = 0  # three links that never move

    def at(times):
        angles = times[:, None, None] * hertz * 2 * np.pi + phase
        return (np.sin(angles) * size).sum(axis=2)

    poses = np.zeros((len(seconds), 112), np.float32)
    poses[:, DIRECTIONS] = at(seconds) + turned
    poses[:, VELOCITIES] = 0.1 * (at(seconds + 0.01) - at(seconds - 0.01)) / 0.02
    poses[:, VELOCITIES] += rng.normal(0, shake + 1e-5, (len(seconds), 51))
    return poses


def twins_of(clips, **named):
    return find_twins([len(clip) for clip in clips], lambda n: clips[n], **named)


def test_the_later_of_two_is_told_with_the_earlier_and_progress_never_goes_back():
    clips, shares = [moves(n) for n in range(40)], []
    clips[20] = moves(3, SECONDS[:119], turned=0.01)
    clips[30] = clips[3]
    assert twins_of(clips, step=shares.append) == {20: 3, 30: 3}
    assert len(shares) > 40
    assert shares == sorted(shares)
    assert 0 <= min(shares) < max(shares) <= 1


@pytest.mark.parametrize("late", [-1.5, 0.5, 2])
def test_a_frame_cut_off_other_moments_of_the_frames_and_a_turned_skeleton_are_the_same_take(late):
    assert twins_of([moves(0), moves(0, SECONDS + late / GRID, turned=0.02)]) == {1: 0}


def test_a_second_take_is_kept_though_its_poses_are_as_near():
    first = moves(0)
    later = moves(0, SECONDS + 0.02 * np.sin(2 * SECONDS))  # 20 ms early and late
    other = moves(0)
    other[:, VELOCITIES] *= np.random.default_rng(0).normal(1, 0.4, (120, 51))  # as fast, but not at each moment
    assert np.linalg.norm((first - later)[:, DIRECTIONS], axis=1).mean() < 0.1
    assert twins_of([first, later, other]) == {}


def test_another_length_another_order_and_standing_still_are_no_twins():
    walk, still = moves(0), np.zeros((120, 112), np.float32)
    noise = np.random.default_rng(1).normal(0, 0.0001, (120, 112)).astype(np.float32)
    assert twins_of([walk, walk[:100], walk[::-1], moves(1), still, still + noise]) == {}
    assert twins_of([]) == twins_of([walk]) == {}


def test_a_captured_take_in_two_formats_is_one_and_takes_of_one_task_are_not(data: Path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        files = [data / "cmu" / name for name in ("05_18.amc", "05_19.amc", "05_20.amc", "01_01.amc", "01_01.bvh")]
        clips = [pose_vectors(read_motion(file).resampled(GRID)) for file in files]
    assert twins_of(clips) == {4: 3}
