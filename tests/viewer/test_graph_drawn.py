"""What is drawn of a motion graph: all that is danced, and as much of the rest as can be told apart."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.motion import Motion
from onbeat.moves.graph import GRID, MotionGraph
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.viewer.pages.graph_drawn import CLIPS, JOINS, drawn_graph

FRAMES = 120


@pytest.fixture(scope="module")
def great(swinger: Motion) -> MoveLibrary:
    """Three thousand clips, with three joins from each frame to others anywhere."""
    rng = np.random.default_rng(1)
    first = Clip.of(swinger, "first")
    clips = tuple(
        Clip(first.motion, f"clip {k}", k, False, first.stops, first.intensity, first.poses) for k in range(3000)
    )
    clip_of = np.repeat(np.arange(3000), FRAMES)
    targets = rng.integers(0, len(clip_of), 3 * len(clip_of))
    costs = rng.uniform(0.1, 0.5, len(targets)).astype(np.float32)
    return MoveLibrary(clips, MotionGraph(clip_of, np.arange(0, len(targets) + 1, 3), targets, costs))


def test_clips_that_are_danced_come_first_and_are_all_there(great: MoveLibrary) -> None:
    danced = [f"clip {k}" for k in (2900, 7, 2900, 1500, *range(100, 190))]
    graph = drawn_graph(great, danced)
    assert [clip.name for clip in graph.clips[:3]] == ["clip 2900", "clip 7", "clip 1500"]
    assert len(graph.clips) == len(set(danced))
    assert (graph.clip_count, graph.join_count) == (3000, great.graph.join_count)


def test_others_are_spread_over_the_library(great: MoveLibrary) -> None:
    graph = drawn_graph(great, ["clip 5", "no such clip"])
    numbers = [int(clip.name.split()[1]) for clip in graph.clips[1:]]
    assert len(graph.clips) == CLIPS
    assert np.diff(numbers).max() < 3000 / CLIPS * 1.5


def test_each_pair_of_clips_has_its_smoothest_join(great: MoveLibrary) -> None:
    graph = drawn_graph(great, [f"clip {k}" for k in range(300)])
    assert 0 < len(graph.joins) <= JOINS
    pairs = [(join.clip, join.next_clip) for join in graph.joins]
    assert len(set(pairs)) == len(pairs)
    join = graph.joins[0]
    leaves, enters = join.clip * FRAMES + round(join.from_s * GRID), join.next_clip * FRAMES + round(join.to_s * GRID)
    whole = great.graph
    here = (whole.sources // FRAMES == join.clip) & (whole.targets // FRAMES == join.next_clip)
    smoothest = np.flatnonzero(here)[whole.costs[here].argmin()]
    assert (whole.sources[smoothest], whole.targets[smoothest]) == (leaves, enters)
