"""From frames to times."""

from __future__ import annotations

import numpy as np

from onbeat.music.timing import centred, refine, sounding_stretch


def test_beats_move_to_the_attack_nearby_and_no_further() -> None:
    attacks = np.zeros(400, np.float32)
    attacks[[103, 210]] = 1.0
    times = refine(np.array([0.5, 1.0, 1.5]), attacks, 200.0)
    np.testing.assert_allclose(times, [0.515, 1.0, 1.5])


def test_an_attack_between_frames_is_found_between_them() -> None:
    attacks = np.zeros(400, np.float32)
    attacks[[100, 101]] = 1.0
    assert 0.5 < refine(np.array([0.5]), attacks, 200.0)[0] < 0.505


def test_beats_stay_in_order() -> None:
    attacks = np.zeros(400, np.float32)
    attacks[101] = 1.0
    assert (np.diff(refine(np.array([0.49, 0.5, 0.52]), attacks, 200.0)) >= 0.0).all()


def test_sound_begins_and_ends_where_it_is_heard() -> None:
    loudness = np.full(100, 1e-9, np.float32)
    loudness[20:60] = 1.0
    assert sounding_stretch(loudness, 20.0) == (0.95, 3.0)


def test_the_centre_stays_near_its_frame_and_on_it_where_nothing_is_heard() -> None:
    odds = np.random.default_rng(0).normal(-2.0, 3.0, 500)
    frames = np.array([0, 1, 250, 498, 499])
    assert np.abs(centred(frames, odds) - frames).max() <= 2.0
    np.testing.assert_allclose(centred(frames, np.full(500, -7.0)), frames, atol=1e-9)
    assert len(centred(np.zeros(0, np.int64), odds)) == 0
