import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.moves.graph import FAN, GRID, LOOP, MARGIN, STRETCH, MotionGraph

MARGIN_FRAMES, STRETCH_FRAMES, LOOP_FRAMES = round(MARGIN * GRID), round(STRETCH * GRID), round(LOOP * GRID)


def graph_of(lengths, pairs):
    clip_of = np.repeat(np.arange(len(lengths)), lengths)
    first, second = (
        (np.array(column, np.int64) for column in zip(*pairs, strict=True)) if pairs else (np.zeros(0, np.int64),) * 2
    )
    return MotionGraph.of(clip_of, first, second, np.linspace(0.1, 0.4, len(pairs)).astype(np.float32))


def joins(graph):
    return set(zip(graph.sources.tolist(), graph.targets.tolist(), strict=True))


def test_a_pair_in_the_middle_joins_both_ways():
    graph = graph_of([100, 100], [(50, 150)])
    assert joins(graph) == {(50, 150), (150, 50)}
    assert graph.join_count == 2
    assert len(graph) == 200


def test_joins_leave_and_enter_only_where_there_is_room():
    last_out, first_in = 99 - MARGIN_FRAMES, MARGIN_FRAMES
    last_in = 99 - MARGIN_FRAMES - STRETCH_FRAMES
    assert joins(graph_of([100, 100], [(last_out, 150)])) == {(last_out, 150)}
    assert joins(graph_of([100, 100], [(last_out + 1, 150)])) == set()
    assert joins(graph_of([100, 100], [(first_in, 150)])) == {(first_in, 150), (150, first_in)}
    assert joins(graph_of([100, 100], [(first_in - 1, 150)])) == {(first_in - 1, 150)}
    assert (150, last_in) in joins(graph_of([100, 100], [(last_in, 150)]))
    assert (150, last_in + 1) not in joins(graph_of([100, 100], [(last_in + 1, 150)]))


def test_nearly_the_same_time_of_one_clip_is_no_join():
    near = (40, 40 + STRETCH_FRAMES - 1)
    far = (40, 40 + STRETCH_FRAMES)
    assert joins(graph_of([300], [near])) == set()
    assert joins(graph_of([300], [far])) == {far}


def test_a_join_does_not_go_straight_back():
    soon = (40, 40 + LOOP_FRAMES - 1)
    late = (40, 40 + LOOP_FRAMES)
    assert joins(graph_of([300], [soon])) == {soon}
    assert joins(graph_of([300], [late])) == {late, late[::-1]}


def test_the_nearest_are_kept():
    pairs = [(30, 100 + MARGIN_FRAMES + n) for n in range(FAN + 10)]
    graph = graph_of([100, 200], pairs)
    kept = [target for source, target in sorted(joins(graph)) if source == 30]
    assert kept == [second for _, second in pairs[:FAN]]
    costs = graph.costs[graph.indptr[30] : graph.indptr[31]]
    assert (np.diff(costs) >= 0).all()


def test_motion_goes_on_within_a_clip_only():
    assert graph_of([3, 2], []).goes_on.tolist() == [True, True, False, True, False]


def reachable(edges, start):
    seen, todo = {start}, [start]
    while todo:
        for target in edges.get(todo.pop(), ()):
            if target not in seen:
                seen.add(target)
                todo.append(target)
    return seen


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(10, 70), min_size=1, max_size=4), st.integers(0, 999))
def test_from_every_frame_of_the_core_every_other_is_reached_and_trimming_keeps_it(lengths, seed):
    frames = sum(lengths)
    rng = np.random.default_rng(seed)
    pairs = sorted({tuple(sorted(pair)) for pair in rng.integers(0, frames, (30, 2)).tolist() if pair[0] != pair[1]})
    graph = graph_of(lengths, pairs)
    edges = {frame: [frame + 1] for frame in np.flatnonzero(graph.goes_on).tolist()}
    for source, target in joins(graph):
        edges.setdefault(source, []).append(target)
    core = set(np.flatnonzero(graph.core).tolist())
    assert core
    reached = {frame: reachable(edges, frame) for frame in range(frames)}
    assert all(core <= reached[frame] for frame in core)
    biggest = max(sum(a in reached[b] for b in reached[a]) for a in range(frames))
    assert len(core) == biggest
    trimmed = graph.trimmed()
    assert joins(trimmed) == {(a, b) for a, b in joins(graph) if a in core and b in core}
    assert set(np.flatnonzero(trimmed.core).tolist()) == core or len(core) == 1
