"""Levels that gain does not change."""

from __future__ import annotations

import numpy as np

from onbeat.music.levels import FORGIVING, QUIETEST, loud_level, loud_level_so_far, relative, with_rises


def test_the_loud_passages_are_forgotten_slowly() -> None:
    tops = np.full(500, -6.0, np.float32)
    tops[200] = -1.0
    so_far, around = loud_level_so_far(tops, 100.0), loud_level(tops, 100.0)
    np.testing.assert_allclose(so_far[[199, 200, 300]], [-6.0, -1.0, -1.0 - FORGIVING], atol=1e-4)
    np.testing.assert_allclose(around[[100, 300]], -1.0 - FORGIVING, atol=1e-4)


def test_the_level_goes_on_over_blocks() -> None:
    tops = np.random.default_rng(0).normal(-4.0, 1.0, 300).astype(np.float32)
    whole = loud_level_so_far(tops, 100.0)
    first = loud_level_so_far(tops[:120], 100.0)
    np.testing.assert_allclose(loud_level_so_far(tops[120:], 100.0, float(first[-1])), whole[120:], atol=1e-5)


def test_silence_has_no_level_and_no_rise() -> None:
    silent = np.full((10, 8), -10.0, np.float32)
    level = loud_level(silent.max(axis=1), 100.0)
    assert (level <= QUIETEST).all()
    features = with_rises(relative(silent, level), np.zeros((2, 8), np.float32))
    assert np.ptp(features[3:-3, 0]) < 1e-2
    assert features[2:, 1].max() == 0.0


def test_a_glide_into_the_next_band_is_no_rise() -> None:
    levels = np.zeros((40, 16), np.float32)
    for frame in range(40):
        levels[frame, 2 + frame // 4] = 2.0
    assert with_rises(levels, np.zeros((2, 16), np.float32))[4:, 1].max() == 0.0
