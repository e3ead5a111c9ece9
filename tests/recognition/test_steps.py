"""Stretches are cut at their keyposes, and pieces are known by their beat."""

from __future__ import annotations

import numpy as np

from made_segments import danced
from onbeat.keyposes.extract import Keyposes, find_keyposes
from onbeat.recognition.steps import steps, usual


def found() -> Keyposes:
    clip = danced()[0]
    return find_keyposes(clip.motion, clip.beats)


def test_pieces_lie_inside_their_stretch_and_run_from_keypose_to_keypose():
    keyposes = found()
    start, end = float(keyposes.times[1]), float(keyposes.times[-2])
    cut = steps(keyposes, start, end, 2)
    assert cut[0].start == start
    assert cut[-1].end == end
    assert len(cut) == len(keyposes) - 2 - 2
    assert {one.start for one in cut} <= set(keyposes.times.tolist())
    assert steps(keyposes, 0.0, start - 0.01, 1) == []


def test_every_other_keypose_begins_a_piece_where_none_overlap():
    cut = steps(found(), 0.0, np.inf, 2, every=False)
    assert [a.end for a in cut[:-1]] == [b.start for b in cut[1:]]


def test_a_missed_keypose_shifts_no_name_after_it():
    keyposes = found()
    kept = np.delete(np.arange(len(keyposes)), 2)
    fewer = Keyposes(
        keyposes.times[kept],
        keyposes.beats[kept],
        tuple(keyposes.sources[i] for i in kept),
        keyposes.song_beats,
        keyposes.candidates,
        keyposes.energy,
        keyposes.thresholds,
        keyposes.method,
        keyposes.fps,
    )
    whole = {one.start: one.number for one in steps(keyposes, 0.0, np.inf, 1)}
    for one in steps(fewer, 0.0, np.inf, 1):
        assert one.number == whole[one.start]


def test_the_same_beat_of_each_cycle_has_one_number():
    cut = steps(found(), 0.0, np.inf, 1, cycle=4)
    assert {one.number for one in cut} <= {1, 2, 3, 4}
    assert max(one.repetition for one in cut) >= 1
    assert len({(one.number, one.repetition) for one in cut}) == len(cut)


def test_pieces_that_last_otherwise_than_their_like_are_left_out():
    assert usual(["a", "a", "a", "b"], [1.0, 1.1, 1.6, 9.0]) == [0, 1, 3]
    assert usual([], []) == []
