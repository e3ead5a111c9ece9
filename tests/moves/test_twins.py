"""One take that is there twice is found, whoever else looks like it."""

import numpy as np

from onbeat.moves.twins import find_twins


def takes(count, frames=120):
    rng = np.random.default_rng(0)
    return [np.cumsum(rng.normal(0, 0.05, (frames, 20)), axis=0).astype(np.float32) for _ in range(count)]


def twins_of(clips):
    return find_twins([len(clip) for clip in clips], lambda n: clips[n])


def test_the_later_of_two_is_told_with_the_earlier():
    clips = takes(100)
    clips[70] = clips[3][:119] + np.float32(0.01)
    clips[90] = clips[3]
    assert twins_of(clips) == {70: 3, 90: 3}


def test_another_length_another_order_and_standing_still_are_no_twins():
    walk, other = takes(2)
    still = np.zeros((120, 20), np.float32)
    noise = np.random.default_rng(1).normal(0, 0.001, (120, 20)).astype(np.float32)
    assert twins_of([walk, walk[:100], walk[::-1], other, still, still + noise]) == {}
    assert twins_of([]) == {}
