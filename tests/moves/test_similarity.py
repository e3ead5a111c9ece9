import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.moves import similarity
from onbeat.moves.similarity import clip_pairs


def walk(frames, seed, dims=3):
    """A smooth random path, near itself now and then."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.normal(size=(frames, dims)) * 0.3, axis=0).astype(np.float32)


def brute(a, b, limit, reach):
    """Every entry of the whole table that is the lowest of its window; ties as in a row-by-row search."""
    table = np.sqrt(((a[:, None].astype(np.float64) - b[None]) ** 2).sum(-1))
    found = []
    for i, j in np.argwhere(table < limit):
        window = table[max(i - reach, 0) : i + reach + 1, max(j - reach, 0) : j + reach + 1]
        if table[i, j] <= window.min():
            found.append((i, j, table[i, j]))
    return found


def test_blocks_and_threads_make_no_difference(monkeypatch):
    clips = [walk(90, 1), walk(70, 2)]
    whole = clip_pairs(clips, 2.0)
    assert len(whole[0]) > 5
    monkeypatch.setattr(similarity, "BLOCK", 16)
    for workers in (1, 3):
        parts = clip_pairs(clips, 2.0, workers=workers)
        np.testing.assert_array_equal(parts[0], whole[0])
        np.testing.assert_array_equal(parts[1], whole[1])
        np.testing.assert_allclose(parts[2], whole[2], atol=1e-3)


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
    i, j, _ = clip_pairs(clips, limit, reach=reach)
    expected = [
        (p + starts[a], q + starts[b])
        for a in range(len(clips))
        for b in range(a, len(clips))
        for p, q, _ in brute(clips[a], clips[b], limit, reach)
        if reach <= p < lengths[a] - reach and reach <= q < lengths[b] - reach and (a < b or p < q)
    ]
    assert list(zip(i.tolist(), j.tolist(), strict=True)) == sorted(expected)


def test_only_wanted_clips_are_searched_with_the_same_bytes():
    clips = [walk(n, n) for n in (40, 55, 23, 31)]
    whole = clip_pairs(clips, 2.0)
    wanted = clip_pairs(clips, 2.0, lambda a, b: 2 in (a, b))
    bounds = np.cumsum([40, 55, 23])
    of_two = (np.searchsorted(bounds, whole[0], "right") == 2) | (np.searchsorted(bounds, whole[1], "right") == 2)
    assert 0 < of_two.sum() < len(of_two)
    for some, every in zip(wanted, whole, strict=True):
        np.testing.assert_array_equal(some, every[of_two])


def test_progress_ends_at_one():
    shares: list[float] = []
    clip_pairs([walk(20, 1), walk(20, 2), walk(9, 3)], 1.0, step=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1)


def test_no_pair_is_an_empty_answer():
    for clips in ([walk(30, 1), walk(30, 2) + 50], [walk(1, 3)], [walk(4, 3)]):
        found = clip_pairs(clips, 1e-6)
        assert [len(column) for column in found] == [0, 0, 0]
        assert [column.dtype for column in found] == [np.int64, np.int64, np.float32]
