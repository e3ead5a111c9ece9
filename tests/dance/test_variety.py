from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import Problem, ValueToGo, best_path
from onbeat.dance.score import FINE, Music
from onbeat.dance.variety import REPEAT, beam_path
from onbeat.moves.library import MoveLibrary
from walkable import blocks_shown, clip, graph, random_problem


def looping() -> Problem:
    """A lively clip that can be looped, and a dull one that goes on without end."""
    library = MoveLibrary(
        (clip(40, [], np.full(40, 2.0)), clip(60, [], np.full(60, 1.0), source=1)),
        graph([40, 60], [(16, 1), (30, 42), (31, 43), (32, 44), (33, 45)]),
    )
    frames = 60
    music = Music(np.zeros((frames + 2 * Music.PAD) * FINE, np.float32), np.full(frames, 0.1, np.float32), frames)
    costs = np.full(library.graph.join_count, 0.01, np.float32)
    return Problem(library.graph, lay_frames(library, (1.0,)), music, costs, hold=10)


def repeats(problem: Problem, path: object) -> int:
    shown = blocks_shown(problem, path)  # type: ignore[arg-type]
    return len(shown) - len(set(shown))


def test_the_optimum_loops_and_the_beam_does_not() -> None:
    problem = looping()
    value = ValueToGo(problem)
    looped, varied = best_path(value), beam_path(problem, value)
    assert repeats(problem, looped) > 0
    assert repeats(problem, varied) == 0
    assert varied.score < looped.score


def test_no_price_no_variety() -> None:
    problem = looping()
    value = ValueToGo(problem)
    assert beam_path(problem, value, repeat=0.0).score == pytest.approx(best_path(value).score, abs=1e-3)


def test_dances_that_are_all_alike_do_not_empty_the_beam() -> None:
    """Equal scores everywhere: a histogram of them has one bin, which must be kept though it is too full."""
    problem = looping()
    silent = replace(problem.music, intensity=np.zeros(problem.music.frames, np.float32))
    even = replace(problem, music=silent, join_costs=np.zeros_like(problem.join_costs))
    for beam in (1, 2, 5):
        path = beam_path(even, ValueToGo(even), beam=beam)
        assert path.score == pytest.approx(0.0)


def test_a_wider_beam_is_hardly_ever_worse() -> None:
    rng, narrow, wide = np.random.default_rng(3), [], []
    while len(wide) < 25:
        problem = random_problem(rng, frames=20)
        if not np.any(problem.frames.left >= 20):
            continue
        value = ValueToGo(problem)
        for earned, beam in ((narrow, 2), (wide, 200)):
            path = beam_path(problem, value, beam=beam)
            earned.append(path.score - REPEAT * repeats(problem, path))
    assert np.mean(wide) >= np.mean(narrow)


def test_the_same_problem_gives_the_same_path() -> None:
    problem = looping()
    value = ValueToGo(problem)
    one, other = beam_path(problem, value), beam_path(problem, value)
    assert one.times.tobytes() == other.times.tobytes()
    assert one.entries.tobytes() == other.entries.tobytes()


def test_a_given_start_is_danced_first() -> None:
    problem = looping()
    path = beam_path(problem, ValueToGo(problem), start=5)
    assert path.entries[0] == 5
    assert path.times[1] >= problem.hold
