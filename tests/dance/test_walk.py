from __future__ import annotations

import numpy as np

from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import Problem
from onbeat.dance.score import FINE, Music
from onbeat.dance.walk import EVERY, random_walk
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from walkable import clip, graph


def ring(seconds: float = 120.0) -> Problem:
    """Three clips of 10 s with joins from every frame of each to two frames of each."""
    joins = [(i, 300 * c + at) for i in range(900) for c in range(3) for at in (10, 20)]
    library = MoveLibrary(tuple(clip(300, [], source=n) for n in range(3)), graph([300] * 3, joins))
    frames = round(seconds * GRID)
    music = Music(np.zeros((frames + 2 * Music.PAD) * FINE, np.float32), np.zeros(frames, np.float32), frames)
    return Problem(library.graph, lay_frames(library), music, np.zeros(library.graph.join_count, np.float32))


def test_joins_come_as_often_as_they_should() -> None:
    problem = ring(600.0)
    gaps = np.diff(random_walk(problem, np.random.default_rng(0)).times) / GRID
    assert gaps[1:].min() >= problem.hold / GRID
    assert abs(gaps.mean() - EVERY) < 0.15


def test_all_joins_are_taken_alike() -> None:
    problem = ring(600.0)
    path = random_walk(problem, np.random.default_rng(1))
    _, counts = np.unique(path.entries[1:], return_counts=True)
    assert len(counts) == 3 * 2 * 3  # clips, places in each, rates
    assert counts.max() < 3 * counts.mean()


def test_the_seed_says_which_walk() -> None:
    problem = ring()
    one, same, other = (random_walk(problem, np.random.default_rng(seed)) for seed in (4, 4, 5))
    assert one.times.tobytes() == same.times.tobytes()
    assert one.entries.tobytes() == same.entries.tobytes()
    assert one.times.tobytes() != other.times.tobytes()
