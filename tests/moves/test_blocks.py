import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onbeat.errors import LibraryError
from onbeat.moves.pairs.blocks import NEAR, Group, Pairs, group_spans


@given(st.lists(st.integers(0, 300), max_size=8), st.integers(20, 120))
def test_groups_cover_each_frame_and_hold_each_inner_frame_of_a_clip_once(lengths, size):
    spans = group_spans(lengths, size)
    clip_of = np.repeat(np.arange(len(lengths)), lengths)
    seen = np.zeros(len(clip_of), int)
    whole = Group(np.zeros((len(clip_of), 1), np.float32), clip_of).inner()
    for span in spans:
        assert 0 < span.stop - span.start <= size
        inner = Group(np.zeros((span.stop - span.start, 1), np.float32), clip_of[span.start : span.stop]).inner()
        seen[span.start : span.stop] += inner
    np.testing.assert_array_equal(seen, whole)


def test_more_clips_at_the_end_change_the_last_group_alone():
    lengths = [30, 50, 500, 40, 60, 20, 90]
    for more in range(1, len(lengths)):
        before, after = group_spans(lengths[:more], 100), group_spans(lengths, 100)
        assert before[:-1] == after[: len(before) - 1]


def test_frames_near_the_ends_of_their_clips_are_no_inner_ones():
    group = Group(np.zeros((12, 1), np.float32), np.repeat([7, 9, 8], [6, 3, 3]))
    assert np.flatnonzero(group.inner()).tolist() == [NEAR, NEAR + 1]
    assert group.bounds.tolist() == [0, 6, 9, 12]


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e30])
def test_a_pose_that_is_no_number_is_told_by_clip_and_frame(bad):
    poses = np.zeros((9, 3), np.float32)
    poses[6, 1] = bad
    with pytest.raises(LibraryError, match="frame 2 of clip 5 "):
        Group(poses, np.repeat([3, 5], [4, 5]))


def test_shapes_that_disagree_are_refused():
    with pytest.raises(LibraryError, match=r"\(4, 3\)"):
        Group(np.zeros((4, 3), np.float32), np.zeros(5, np.int64))


def test_pairs_of_parts_are_in_order_whatever_order_the_parts_have():
    parts = [Pairs(np.array([5, 1]), np.array([6, 9]), np.ones(2, np.float32)) for _ in range(2)]
    parts[1] = parts[1].moved(-1, 3)
    one, two = Pairs.joined(parts), Pairs.joined(parts[::-1])
    assert one.first.tolist() == [0, 1, 4, 5]
    assert one.second.tolist() == two.second.tolist() == [12, 9, 9, 6]
