"""Laws of the searches, held on hundreds of small random graphs: the optimum is what trying all ways finds."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from onbeat.dance import search, shiratori2006
from onbeat.dance.greedy import greedy_path
from onbeat.dance.lookahead import Roads
from onbeat.dance.optimal import Problem, ValueToGo, best_path, score_path
from onbeat.dance.shiratori2006 import Components, shiratori2006_path
from onbeat.dance.variety import beam_path
from onbeat.dance.walk import random_walk
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from walkable import (
    blocks_shown,
    brute_force,
    brute_force_without_repeats,
    check_path,
    random_problem,
)

TOLERANCE = 1e-3  # values are float32 and a best path may stay 1e-4 longer in its clip than is best


def can_be_danced(problem: Problem) -> bool:
    """Whether any dance is as long as the song."""
    return brute_force(problem) > -np.inf


def problems(count: int, seed: int, **options: Any) -> list[Problem]:
    """``count`` random problems with a solution."""
    rng = np.random.default_rng(seed)
    found: list[Problem] = []
    while len(found) < count:
        problem = random_problem(rng, **options)
        if can_be_danced(problem):
            found.append(problem)
    return found


@pytest.fixture(scope="module")
def small() -> list[Problem]:
    return problems(120, seed=1)


def test_optimum_is_what_trying_all_ways_finds(small: list[Problem]) -> None:
    for problem in small:
        assert ValueToGo(problem).optimum == pytest.approx(brute_force(problem), abs=TOLERANCE)


def test_best_path_has_the_optimum(small: list[Problem]) -> None:
    for problem in small:
        value = ValueToGo(problem)
        path = best_path(value)
        check_path(problem, path)
        assert path.score == pytest.approx(value.optimum, abs=TOLERANCE)
        assert path.score == pytest.approx(score_path(problem, path.times, path.entries))


def test_segments_give_the_same_as_one_stretch(small: list[Problem]) -> None:
    for problem in small[:60]:
        whole, parts = ValueToGo(problem), ValueToGo(problem, rows=problem.hold + 1)
        assert parts.optimum == pytest.approx(whole.optimum, abs=1e-5)
        for t in reversed(range(problem.music.frames)):
            begin, _, rows = parts.stretch(t)
            here = rows[t - begin].copy()
            begin, _, rows = whole.stretch(t)
            np.testing.assert_allclose(here, rows[t - begin], atol=1e-4)
        assert best_path(parts).score == pytest.approx(best_path(whole).score, abs=TOLERANCE)
        assert beam_path(problem, parts).score == pytest.approx(beam_path(problem, whole).score, abs=TOLERANCE)


def test_wide_beam_without_a_price_finds_the_optimum(small: list[Problem]) -> None:
    for problem in small:
        value = ValueToGo(problem)
        path = beam_path(problem, value, beam=2000, repeat=0.0)
        check_path(problem, path)
        assert path.score == pytest.approx(value.optimum, abs=TOLERANCE)


def test_beam_is_a_path_and_no_better_than_the_optimum(small: list[Problem]) -> None:
    for problem in small:
        value = ValueToGo(problem)
        for beam in (1, 4, 100):
            path = beam_path(problem, value, beam=beam)
            check_path(problem, path)
            assert path.score <= value.optimum + TOLERANCE


def test_beam_with_a_prohibitive_price_does_not_repeat() -> None:
    exact, gaps, possible = 0, [], 0
    for problem in problems(60, seed=2, frames=13, joins=12):
        value = ValueToGo(problem)
        path = beam_path(problem, value, beam=2000, repeat=1000.0)
        best = brute_force_without_repeats(problem)
        if best == -np.inf:
            continue
        possible += 1
        shown = blocks_shown(problem, path)
        assert len(shown) == len(set(shown))
        assert path.score <= best + TOLERANCE
        exact += path.score >= best - TOLERANCE
        gaps.append(best - path.score)
    assert possible > 30
    assert exact >= 0.9 * possible


@pytest.mark.parametrize("horizon_s", [0.1, 0.3])
def test_greedy_is_a_path_and_no_better_than_the_optimum(small: list[Problem], horizon_s: float) -> None:
    for problem in small:
        path = greedy_path(problem, horizon_s)
        check_path(problem, path)
        assert path.score <= ValueToGo(problem).optimum + TOLERANCE


def test_greedy_that_sees_the_whole_song_finds_the_optimum(small: list[Problem]) -> None:
    for problem in small:
        assert greedy_path(problem, 10.0).score == pytest.approx(ValueToGo(problem).optimum, abs=TOLERANCE)


def random_components(problem: Problem, rng: np.random.Generator) -> Components:
    """Components as real ones are: no less than 0, and beats here and there."""
    nodes, frames = len(problem.graph), problem.music.frames
    beat = rng.uniform(0, 1, frames) * (rng.uniform(0, 1, frames) < 0.3)
    return Components(rng.uniform(0, 1, nodes), rng.uniform(0, 2, nodes), beat, rng.uniform(0, 1, frames))


@pytest.mark.parametrize("rhythm_only", [False, True])
@pytest.mark.parametrize("horizon_s", [0.1, 0.3])
def test_search_of_2006_is_a_path_and_no_better_than_the_optimum(
    small: list[Problem], monkeypatch: pytest.MonkeyPatch, horizon_s: float, rhythm_only: bool
) -> None:
    rng, nothing, danced = np.random.default_rng(5), cast(Any, None), 0
    for problem in small:
        parts = random_components(problem, rng)
        monkeypatch.setattr(shiratori2006, "components", lambda *_, parts=parts: parts)
        try:
            path = shiratori2006_path(problem, nothing, nothing, rhythm_only=rhythm_only, horizon_s=horizon_s)
        except PlanError:
            continue  # slowed down the clips last as long as the song, at their own rate they do not
        check_path(problem, path)
        assert set(problem.frames.rate[path.entries].tolist()) == {1.0}
        assert path.score <= ValueToGo(problem).optimum + TOLERANCE
        danced += 1
    assert danced > 0.8 * len(small)


def test_search_of_2006_that_sees_the_whole_song_finds_the_best_of_eq_11(monkeypatch: pytest.MonkeyPatch) -> None:
    rng, nothing = np.random.default_rng(6), cast(Any, None)
    for drawn in problems(60, seed=6, rates=(1.0,)):
        parts = random_components(drawn, rng)
        eq_11 = replace(
            drawn,
            frames=replace(
                drawn.frames,
                stop_worth=np.zeros_like(drawn.frames.stop_worth),
                intensity=parts.stop.astype(np.float32),
                idle=np.zeros_like(drawn.frames.idle),
            ),
            music=replace(drawn.music, intensity=parts.beat.astype(np.float32)),
            join_costs=np.zeros_like(drawn.join_costs),
            seams=None,
        )
        monkeypatch.setattr(shiratori2006, "components", lambda *_, parts=parts: parts)
        path = shiratori2006_path(eq_11, nothing, nothing, rhythm_only=True, horizon_s=10.0)
        assert path.score == pytest.approx(brute_force(eq_11), abs=TOLERANCE)


def test_walk_is_a_path_and_no_better_than_the_optimum(small: list[Problem]) -> None:
    rng = np.random.default_rng(3)
    for problem in small:
        path = random_walk(problem, rng)
        check_path(problem, path)
        assert path.score <= ValueToGo(problem).optimum + TOLERANCE


def test_chapters_of_a_long_song_make_one_path(small: list[Problem], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "CHAPTER", 6 / GRID)
    monkeypatch.setattr(search, "AHEAD", 4 / GRID)
    for problem in small:
        for variety in (False, True):
            path, _ = search.optimal(problem, variety=variety)
            check_path(problem, path)
            assert path.score <= ValueToGo(problem).optimum + TOLERANCE


def test_survival_is_how_long_one_can_dance(small: list[Problem]) -> None:
    """A dance of n frames from f exists if and only if f survives n frames."""
    for problem in small[:20]:
        survival = Roads.of(problem).survival
        for frames in (1, problem.hold + 1, problem.music.frames):
            part = replace(problem, music=problem.music.part(0, frames))
            possible = ValueToGo(part).stretch(0)[2][0] > -1e29
            np.testing.assert_array_equal(possible, survival >= frames)


def test_what_cannot_be_danced_is_refused() -> None:
    rng = np.random.default_rng(4)
    refused = 0
    while refused < 5:
        problem = random_problem(rng, frames=60, joins=2)
        if can_be_danced(problem):
            continue
        refused += 1
        with pytest.raises(PlanError, match="the longest dance over the joins of this library lasts"):
            greedy_path(problem)
        with pytest.raises(PlanError, match="the longest dance over the joins"):
            random_walk(problem, rng)
        with pytest.raises(PlanError, match="the longest dance over the joins"):
            ValueToGo(problem)
