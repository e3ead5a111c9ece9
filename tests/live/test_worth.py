from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import Problem
from onbeat.dance.score import FINE, Music
from onbeat.errors import PlanError
from onbeat.live.choice.ground import PAD, Ground
from onbeat.live.choice.worth import Worth
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph, random_problem

NOTHING = Music(np.zeros(1, np.float32), np.zeros(0, np.float32), 0)


def chain(lengths: list[int], joins: list[tuple[int, int]], hold: int = 3) -> Problem:
    library = MoveLibrary(tuple(clip(n, [], source=k) for k, n in enumerate(lengths)), graph(lengths, joins))
    return Problem(
        library.graph, lay_frames(library, (1.0,)), NOTHING, np.full(len(joins), 0.1, np.float32), None, hold
    )


def by_brute_force(ground: Ground, problem: Problem, shown: Any, beats: Any, total: int) -> Any:
    """V(t, f) read off the definition, from the problem's own joins."""
    indptr, at, sign = problem.changes

    def stop(t: int, f: int) -> float:
        return float(ground.stop_worth[f]) * float(beats[(t + PAD) * FINE + ground.stop_shift[f]])

    def run(t: int, f: int, frames: int) -> float:
        return sum(float(shown[f + k]) + stop(t + k, f + k) for k in range(frames))

    @cache
    def best(t: int, f: int) -> float:
        if t == total:
            return 0.0 if ground.lasting[f] else -np.inf
        found = float(shown[f]) + stop(t, f) + best(t + 1, f + 1) if ground.left[f] > 0 else -np.inf
        for e in range(int(problem.graph.indptr[f]), int(problem.graph.indptr[f + 1])):
            g = int(problem.graph.targets[e])
            if ground.left[g] < ground.hold or not ground.lasting[g + ground.hold]:
                continue
            span = min(ground.hold, total - t)
            gain = sum(float(sign[k]) * float(beats[(t + PAD) * FINE + at[k]]) for k in range(indptr[e], indptr[e + 1]))
            after = best(t + span, g + span) if t + span < total else 0.0
            found = max(found, run(t, g, span) + after + gain - float(problem.join_costs[e]))
        return found

    return best


def test_the_worth_is_that_of_the_best_way() -> None:
    """Of all ways, by trying them, in random libraries small enough for that."""
    compared = 0
    for seed in range(16):
        rng = np.random.default_rng(seed)
        problem = random_problem(rng, rates=(1.0,), joins=60)
        try:
            ground = Ground.of(problem)
        except PlanError:
            continue
        total = int(rng.integers(6, 20))
        beats = rng.normal(0, 1, (total + 2 * PAD) * FINE).astype(np.float32)
        shown = rng.normal(0, 0.2, len(ground)).astype(np.float32)
        best = by_brute_force(ground, problem, shown, beats, total)
        worth = Worth(ground, shown, beats)
        for f in np.flatnonzero(ground.lasting).tolist():
            assert worth.now[f] == pytest.approx(best(0, f), abs=1e-3)
            assert worth.walk(f).worth == pytest.approx(best(0, f), abs=1e-3)
            span = min(ground.hold, total)
            if ground.left[f] >= span:
                held = Worth(ground, shown, beats, first=2 * ground.hold).walk(f, ground.hold).worth
                assert worth.entered()[f] == pytest.approx(held, abs=1e-3) or max(held, worth.entered()[f]) < -1e20
            compared += 1
    assert compared > 100


def test_a_way_that_ends_is_not_taken_however_far_its_end() -> None:
    """Two clips that lead to each other, and a third, dear to all, that leads nowhere."""
    problem = chain([20, 20, 500], [(15, 22), (35, 2), (15, 45)])
    ground = Ground.of(problem)
    assert np.flatnonzero(ground.lasting).max() == 35
    shown = np.where(np.arange(540) >= 40, 1.0, 0.0)
    steps = Worth(ground, shown, np.zeros((40 + 2 * PAD) * FINE, np.float32)).walk(5)
    assert steps.entries.tolist() == [22, 2, 22]


def test_a_library_of_dead_ends_is_told() -> None:
    with pytest.raises(PlanError, match="dead ends"):
        Ground.of(chain([20, 20], [(15, 22)]))


def test_of_many_joins_the_smoothest_are_kept_from_each_frame() -> None:
    problem = chain([40, 40], [(30, 42), (30, 44), (30, 46), (70, 2), (70, 4)])
    costs = np.array([0.3, 0.1, 0.2, 0.5, 0.4], np.float32)
    ground = Ground.of(Problem(problem.graph, problem.frames, NOTHING, costs, None, 3), most_joins=4)
    assert ground.targets.tolist() == [44, 46, 4, 2]
    assert Ground.of(Problem(problem.graph, problem.frames, NOTHING, costs, None, 3), 1).targets.tolist() == [44, 4]


def test_a_wait_holds_the_first_join_back() -> None:
    ground = Ground.of(chain([30, 30], [(k, 32) for k in range(8, 20)] + [(45, 2)]))
    shown = np.where(np.arange(60) < 30, -1.0, 0.0)
    beats = np.zeros((20 + 2 * PAD) * FINE, np.float32)
    assert Worth(ground, shown, beats).walk(8).times[0] == 0
    assert Worth(ground, shown, beats, first=7 + 3).walk(8, 7).times[0] == 7
