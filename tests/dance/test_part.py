"""Parts of a library: their frames and joins are those of the whole."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.dance.frames import RATES, lay_frames
from onbeat.dance.part import Part, cut_library
from onbeat.dance.seams import find_seams
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph


@pytest.fixture
def library() -> MoveLibrary:
    rng = np.random.default_rng(0)
    lengths = (60, 45, 80)
    clips = tuple(
        clip(n, np.arange(0.2, (n - 2) / GRID, 0.31).tolist(), rng.uniform(0, 2, n), source)
        for source, n in enumerate(lengths)
    )
    pairs = [(int(a), int(b)) for a, b in rng.integers(0, sum(lengths), (400, 2))]
    return MoveLibrary(clips, graph(list(lengths), pairs))


@pytest.fixture
def part(library: MoveLibrary) -> Part:
    kept = np.zeros(185, bool)
    kept[7:33] = kept[40:70] = kept[130:185] = True
    return Part.of(kept, library.graph.clip_of)


def test_stretches_end_where_clips_do(part: Part) -> None:
    assert list(part) == [(0, 7, 33), (0, 40, 60), (1, 60, 70), (2, 130, 185)]
    assert part.starts.tolist() == [0, 26, 46, 56, 111]
    assert part.frames.tolist() == [*range(7, 33), *range(40, 70), *range(130, 185)]


def test_the_joins_of_a_part_are_those_within_it(library: MoveLibrary, part: Part) -> None:
    inner, whole = part.joins(library.graph), library.graph
    inside = set(part.frames.tolist())
    wanted = {(int(i), int(j)) for i, j in zip(whole.sources, whole.targets, strict=True) if {int(i), int(j)} <= inside}
    found = zip(part.frames[inner.sources].tolist(), part.frames[inner.targets].tolist(), strict=True)
    assert set(found) == wanted
    assert inner.join_count == len(wanted) > 20


def test_frames_of_a_part_are_laid_as_those_of_the_whole(library: MoveLibrary, part: Part) -> None:
    whole, laid = lay_frames(library), lay_frames(library, RATES, part)
    key = {
        (int(library.graph.clip_of[b]), float(r), float(s)): v
        for v, (b, r, s) in enumerate(zip(whole.base, whole.rate, whole.second, strict=True))
    }
    clips = part.joins(library.graph).clip_of[laid.base]
    same = np.array([key[int(c), float(r), float(s)] for c, r, s in zip(clips, laid.rate, laid.second, strict=True)])
    assert len(laid) > 0.9 * len(part) * sum(1 / rate for rate in RATES)
    np.testing.assert_array_equal(part.frames[laid.base], whole.base[same])
    for name in ("stop_worth", "stop_shift", "intensity", "idle"):
        np.testing.assert_array_equal(getattr(laid, name), getattr(whole, name)[same])
    assert (laid.left <= whole.left[same]).all()
    goes_on = np.flatnonzero(laid.left > 0)
    np.testing.assert_array_equal(same[goes_on + 1], same[goes_on] + 1)
    for number in range(len(RATES)):
        entry = laid.entry[number]
        there = entry >= 0
        np.testing.assert_array_equal(same[entry[there]], whole.entry[number][part.frames[there]])
        assert there.mean() > 0.9


def test_a_part_of_all_is_the_whole(library: MoveLibrary) -> None:
    whole, laid = lay_frames(library), lay_frames(library, RATES, Part.of(np.ones(185, bool), library.graph.clip_of))
    for name, value in vars(whole).items():
        np.testing.assert_array_equal(getattr(laid, name), value)


def test_what_joins_do_to_stops_does_not_depend_on_the_part(troupe: MoveLibrary) -> None:
    few = MoveLibrary.of(troupe.clips[:3])
    chosen = np.arange(0, few.graph.join_count, 7)
    all_seams, some = find_seams(few), find_seams(few, (few.graph.sources[chosen], few.graph.targets[chosen]))
    for k, e in enumerate(chosen.tolist()):
        whole, own = slice(*all_seams.indptr[e : e + 2]), slice(*some.indptr[k : k + 2])
        np.testing.assert_array_equal(some.at[own], all_seams.at[whole])
        np.testing.assert_array_equal(some.sign[own], all_seams.sign[whole])


def test_stretches_become_clips(troupe: MoveLibrary) -> None:
    kept = np.zeros(len(troupe.graph), bool)
    kept[30:150] = kept[700:790] = True
    part = Part.of(kept, troupe.graph.clip_of)
    cut = cut_library(troupe, part)
    assert len(cut.graph) == sum(len(clip.poses) for clip in cut.clips) == kept.sum()
    for clip_, (which, first, end) in zip(cut.clips, part, strict=True):
        own, begin = troupe.clips[which], first - int(troupe.starts[which])
        np.testing.assert_array_equal(clip_.poses, own.poses[begin : begin + end - first])
        at = np.arange(end - first) / GRID
        moved, original = clip_.motion.at(at), own.motion.at(at + begin / GRID)
        np.testing.assert_allclose(moved.root_positions, original.root_positions, atol=1e-9)
        assert len(clip_.motion) == round((end - first) / GRID * own.fps)
        assert set((clip_.stops + begin / GRID).round(9)) <= set(own.stops.round(9))
