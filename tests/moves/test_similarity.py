import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

from onbeat.errors import LibraryError
from onbeat.moves import similarity
from onbeat.moves.pairs import blocks, exact
from onbeat.moves.pairs.blocks import Group
from onbeat.moves.similarity import Search, block_pairs, clip_pairs, search_for


def walk(frames, seed, dims=3):
    """A smooth random path, near itself now and then."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.normal(size=(frames, dims)) * 0.3, axis=0).astype(np.float32)


def group(*clips, first=0):
    return Group(np.concatenate(clips), np.repeat(np.arange(len(clips)) + first, [len(clip) for clip in clips]))


def brute(a, b, limit, reach):
    """Every entry of the whole table that is the lowest of its window; ties as in a row-by-row search."""
    table = np.sqrt(((a[:, None].astype(np.float64) - b[None]) ** 2).sum(-1))
    found = []
    for i, j in np.argwhere(table < limit):
        window = table[max(i - reach, 0) : i + reach + 1, max(j - reach, 0) : j + reach + 1]
        if table[i, j] <= window.min():
            found.append((i, j, table[i, j]))
    return found


def test_blocks_tiles_and_threads_make_no_difference_to_a_byte(monkeypatch):
    clips = [walk(90, 1), walk(170, 2), walk(40, 3)]
    whole = clip_pairs(clips, 2.0)
    assert len(whole.first) > 20
    monkeypatch.setattr(exact, "TILE", 16)
    monkeypatch.setattr(similarity, "group_spans", lambda lengths: blocks.group_spans(lengths, 64))
    for workers in (1, 3):
        for mine, same in zip(clip_pairs(clips, 2.0, workers=workers), whole, strict=True):
            np.testing.assert_array_equal(mine, same)


def test_of_one_path_with_itself_the_upper_triangle_is_searched():
    t = np.arange(100) * 0.1
    path = np.stack((np.cos(t), np.sin(t)), axis=1).astype(np.float32)
    i, j, _ = clip_pairs([path], 0.1)
    assert len(i)
    assert (i < j).all()
    # the same place on the circle comes again after 2π s, 62.8 frames
    assert set((j - i).tolist()) <= {62, 63, 64}


def test_a_plateau_gives_its_first_entry():
    still, passing = np.zeros((9, 1), np.float32), np.array([[2], [2], [2], [0], [0], [2], [2], [2]], np.float32)
    # the first frame of the still clip that is no rim has equal neighbours before it on the rim
    i, j, _ = clip_pairs([still, passing], 0.5)
    assert (i.tolist(), j.tolist()) == ([], [])
    dip = np.array([[1], [1], [1], [0.2], [0.2], [1], [1], [1]], np.float32)
    i, j, d = clip_pairs([dip, passing], 0.5)
    assert (i.tolist(), j.tolist()) == ([3], [8 + 3])
    np.testing.assert_allclose(d, [0.2], atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.integers(1, 30), min_size=1, max_size=5), st.integers(0, 999))
def test_pairs_of_clips_are_those_of_each_two_away_from_their_ends(lengths, seed):
    reach, limit = 2, 1.5
    clips = [walk(n, seed + k) for k, n in enumerate(lengths)]
    starts = np.concatenate(([0], np.cumsum(lengths)))
    i, j, _ = clip_pairs(clips, limit)
    expected = [
        (p + starts[a], q + starts[b])
        for a in range(len(clips))
        for b in range(a, len(clips))
        for p, q, _ in brute(clips[a], clips[b], limit, reach)
        if reach <= p < lengths[a] - reach and reach <= q < lengths[b] - reach and (a < b or p < q)
    ]
    assert list(zip(i.tolist(), j.tolist(), strict=True)) == sorted(expected)


def test_what_two_clips_share_does_not_depend_on_the_clips_beside_them():
    clips = [walk(n, n) for n in (40, 55, 23, 31)]
    whole = block_pairs(group(*clips[:2]), group(*clips[2:]), 2.0)
    alone = block_pairs(group(clips[1]), group(clips[3]), 2.0)
    mine = (whole.first >= 40) & (whole.second >= 23)
    assert 0 < len(alone.first) < len(whole.first)
    for some, every, shift in zip(alone, whole, (40, 23, 0), strict=True):
        np.testing.assert_array_equal(some, every[mine] - np.asarray(shift, every.dtype))


def test_far_from_the_origin_and_with_any_threads_the_bytes_are_those_of_exact_sums():
    clips = [walk(200, 1, 40) * np.float32(0.2) + np.float32(50) for _ in range(2)]
    clips[1] = clips[1] + np.random.default_rng(0).normal(size=clips[1].shape).astype(np.float32) * np.float32(1e-3)
    found = []
    for threads in (1, 2):
        with threadpool_limits(threads, "blas"):
            found.append(block_pairs(group(clips[0]), group(clips[1], first=1), 1.0))
    assert len(found[0].first) > 20
    for one, two in zip(*found, strict=True):
        np.testing.assert_array_equal(one, two)
    difference = clips[0][found[0].first].astype(np.float64) - clips[1][found[0].second]
    np.testing.assert_array_equal(found[0].distance, np.sqrt((difference**2).sum(1)).astype(np.float32))


def test_progress_ends_at_one():
    shares: list[float] = []
    clip_pairs([walk(20, 1), walk(20, 2), walk(9, 3)], 1.0, step=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1)


def test_no_pair_is_an_empty_answer():
    for search in (None, Search("coarse"), Search("approximate", 0.01)):
        for clips in ([walk(30, 1), walk(30, 2) + 50], [walk(1, 3)], [walk(4, 3)], []):
            found = clip_pairs(clips, 1e-6, search)
            assert [len(column) for column in found] == [0, 0, 0]
            assert [column.dtype for column in found] == [np.int64, np.int64, np.float32]


def test_larger_libraries_are_searched_with_less_care_and_kept_sparse():
    found = [search_for(frames) for frames in (10_000, 108_000, 300_000, 1_080_000, 4_860_000)]
    ranks = [["exact", "coarse", "approximate"].index(search.method) for search in found]
    assert ranks == sorted(ranks)
    assert (ranks[0], ranks[-1]) == (0, 2)
    assert [search.density for search in found] == sorted((search.density for search in found), reverse=True)
    assert search_for(10_000, "coarse").method == "coarse"


@pytest.mark.parametrize("limit", [-1.0, math.nan, math.inf])
def test_a_limit_that_is_no_distance_is_refused(limit):
    with pytest.raises(LibraryError, match="a number from 0"):
        block_pairs(group(walk(9, 1)), group(walk(9, 2)), limit)


def test_poses_of_two_kinds_and_unknown_searches_are_refused():
    with pytest.raises(LibraryError, match="3 and 4"):
        block_pairs(group(walk(9, 1)), group(walk(9, 2, 4)), 1.0)
    with pytest.raises(LibraryError, match="exact, coarse, approximate"):
        Search("quick")  # pyright: ignore[reportArgumentType]
    with pytest.raises(LibraryError, match="more than 0"):
        Search("exact", 0.0)
