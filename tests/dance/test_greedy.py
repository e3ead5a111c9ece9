from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance.frames import lay_frames
from onbeat.dance.greedy import greedy_path, reward_table
from onbeat.dance.lookahead import Roads
from onbeat.dance.optimal import Problem, ValueToGo, best_path, reward_along
from onbeat.dance.score import FINE, Music
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph, random_problem


def lured(frames: int = 60) -> Problem:
    """A way that pays at once and then leads to a dull clip, beside one that pays much more, but later."""
    clips = (
        clip(30, [], np.concatenate((np.full(20, 3.0), np.zeros(10)))),
        clip(70, [], np.zeros(70), source=1),
        clip(70, [], np.concatenate((np.full(30, 1.0), np.full(40, 9.0))), source=2),
    )
    library = MoveLibrary(clips, graph([30, 70, 70], [(15, 35), (15, 105)]))
    laid = lay_frames(library, (1.0,))
    laid = replace(laid, intensity=library.intensity.astype(np.float32), idle=np.zeros_like(laid.idle))
    music = Music(np.zeros((frames + 2 * Music.PAD) * FINE, np.float32), np.ones(frames, np.float32), frames)
    return Problem(library.graph, laid, music, np.array([0.1, 0.2], np.float32), hold=5)


def test_a_short_sight_is_lured_away() -> None:
    problem = lured()
    near, far = greedy_path(problem, 0.2), greedy_path(problem, 5.0)
    assert near.score < far.score
    assert far.score == pytest.approx(best_path(ValueToGo(problem)).score, abs=1e-2)


def test_it_never_walks_into_a_dead_end() -> None:
    """The lively clip ends before the song does; what comes after is dull, but there is something after."""
    problem = lured(frames=75)
    path = greedy_path(problem, 0.3)
    assert path.times.tolist() != [0]
    assert Roads.of(problem).survival[path.entries[0]] >= 75


def test_table_holds_what_the_score_counts() -> None:
    problem = random_problem(np.random.default_rng(2), frames=20)
    table = reward_table(problem, 5, 90)
    assert table.shape == (15, len(problem.frames))
    for k in (0, 7, 14):
        expected = reward_along(problem, 5 + k, np.arange(len(problem.frames)), 1)
        np.testing.assert_allclose(table[k], expected, atol=1e-5)


def test_the_same_problem_gives_the_same_path() -> None:
    one, other = greedy_path(lured(), 10 / GRID), greedy_path(lured(), 10 / GRID)
    assert one.times.tobytes() == other.times.tobytes()
    assert one.entries.tobytes() == other.entries.tobytes()
