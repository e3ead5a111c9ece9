"""Left and right steps, told apart or joined."""

from __future__ import annotations

import numpy as np

from made_segments import cycles_of, danced
from onbeat.motion.mirror import mirrored as mirrored_motion
from onbeat.recognition.mirroring import joined, leads_left, mirrored
from onbeat.recognition.segments import Segments, segments_of


def test_mirroring_twice_gives_the_segments_back():
    found = cycles_of(danced()[:3])
    assert np.array_equal(mirrored(mirrored(found)).positions, found.positions)
    assert not np.allclose(mirrored(found).positions, found.positions)


def test_the_mirror_image_is_that_of_the_mirrored_motion():
    motion = danced()[0].motion
    for frame in ("start", "body"):
        both = segments_of([motion, mirrored_motion(motion)], [(1, 2.5)] * 2, ["", ""], ["", ""], [0, 0], frame=frame)
        assert np.allclose(mirrored(both[[0]]).positions, both[[1]].positions, atol=1e-6)


def test_who_moves_more_leads_and_of_as_much_who_moves_first():
    wrists = np.zeros((3, 8, 2, 3))
    wrists[0, 4:, 0, 2] = wrists[0, 6:, 1, 2] = 1.0  # left, then right
    wrists[1, 2:, 1, 2] = wrists[1, 6:, 0, 2] = 1.0  # right, then left
    wrists[2, 7:, 0, 2] = 1.0  # left alone, at the end
    names = ("left_wrist", "right_wrist")
    found = Segments(wrists, np.ones(3), [""] * 3, [""] * 3, np.zeros(3), names, [6, 6])
    assert leads_left(found).tolist() == [True, False, True]


def test_left_and_right_are_different_until_they_are_joined():
    found = cycles_of(danced())
    other = mirrored(found)
    assert np.array_equal(leads_left(found), ~leads_left(other))
    assert np.array_equal(joined(found).positions, joined(other).positions)
    assert not leads_left(joined(found)).any()
