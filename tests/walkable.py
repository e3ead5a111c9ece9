"""Small random searches, and their answers by brute force, that the tests of the searches share."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import Path, Problem
from onbeat.dance.score import FINE, Music
from onbeat.dance.seams import Seams
from onbeat.moves.graph import GRID, MotionGraph
from onbeat.moves.library import Clip, MoveLibrary


def clip(frames: int, stops: list[float], intensity: Any = None, source: int = 0, *, mirrored: bool = False) -> Clip:
    """A clip of which only what the search reads is there: stops, intensity and its length in graph frames."""
    intensity = np.ones(frames) if intensity is None else np.asarray(intensity, float)
    nothing: Any = None
    poses = np.zeros((frames, 1), np.float32)
    return Clip(nothing, "", source, mirrored, np.array(stops, float), intensity, poses)


def graph(lengths: list[int], joins: list[tuple[int, int]]) -> MotionGraph:
    """A motion graph of clips with these lengths and joins (leave, enter)."""
    clip_of = np.repeat(np.arange(len(lengths)), lengths)
    ordered = sorted(set(joins))
    leave = np.array([join[0] for join in ordered], np.int64)
    indptr = np.concatenate(([0], np.cumsum(np.bincount(leave, minlength=len(clip_of))))).astype(np.int64)
    enter = np.array([join[1] for join in ordered], np.int64)
    return MotionGraph(clip_of, indptr, enter, np.zeros(len(ordered), np.float32))


def random_problem(
    rng: np.random.Generator, frames: int = 0, rates: tuple[float, ...] = (1.0, 0.8, 1.25), joins: int = 25
) -> Problem:
    """A random problem of two to four clips of 8 to 22 frames, and of a song of 10 to 24 frames unless told."""
    lengths = rng.integers(8, 23, rng.integers(2, 5)).tolist()
    hold = int(rng.integers(1, 5))
    clips = [
        clip(n, np.sort(rng.uniform(0, (n - 1) / GRID, rng.integers(0, 4))).tolist(), rng.uniform(0, 2, n), source)
        for source, n in enumerate(lengths)
    ]
    total = sum(lengths)
    pairs = [(int(a), int(b)) for a, b in rng.integers(0, total, (int(rng.integers(joins // 2, joins + 1)), 2))]
    library = MoveLibrary(tuple(clips), graph(lengths, pairs))
    count = library.graph.join_count
    frames = frames or int(rng.integers(10, 25))
    worth = rng.normal(0, 1, (frames + 2 * Music.PAD) * FINE).astype(np.float32)
    music = Music(worth, rng.normal(0, 0.3, frames).astype(np.float32), frames)
    laid = lay_frames(library, rates[: int(rng.integers(1, len(rates) + 1))])
    costs = rng.uniform(0.05, 1.0, count).astype(np.float32)
    return Problem(library.graph, laid, music, costs, random_seams(rng, count), hold)


def random_seams(rng: np.random.Generator, joins: int) -> Seams:
    """Up to two stops made or unmade by each join, within 0.3 s of it."""
    many = rng.integers(0, 3, joins)
    indptr = np.concatenate(([0], np.cumsum(many))).astype(np.int32)
    at = rng.integers(-9 * FINE, 9 * FINE, indptr[-1]).astype(np.int32)
    return Seams(indptr, at, rng.choice(np.array([-1, 1], np.float32), indptr[-1]))


def shown_worth(problem: Problem, t: int, f: int) -> float:
    """What it is worth to show virtual frame f at song frame t, read off the definition."""
    laid, music = problem.frames, problem.music
    beat = music.beat_worth[(t + Music.PAD) * FINE + laid.stop_shift[f]]
    moved = float(laid.intensity[f]) * float(music.intensity[t]) - float(laid.idle[f])
    return float(laid.stop_worth[f]) * float(beat) + moved


def ways_on(problem: Problem, t: int, f: int) -> Iterator[tuple[int, float]]:
    """Virtual frames that joins at song frame t lead to from f, and what each way costs, read off the definition."""
    laid, music, node = problem.frames, problem.music, int(problem.frames.base[f])
    for join in range(int(problem.graph.indptr[node]), int(problem.graph.indptr[node + 1])):
        cost = float(problem.join_costs[join])
        if problem.seams is not None:
            for k in range(int(problem.seams.indptr[join]), int(problem.seams.indptr[join + 1])):
                instant = (t + Music.PAD) * FINE + int(problem.seams.at[k])
                cost -= float(problem.seams.sign[k]) * float(
                    music.beat_worth[min(max(instant, 0), len(music.beat_worth) - 1)]
                )
        for rate in range(len(laid.entry)):
            entry = int(laid.entry[rate, problem.graph.targets[join]])
            if laid.left[entry] > problem.hold:
                yield entry, cost


def brute_force(problem: Problem) -> float:
    """The best score, by trying all ways: a state is (song frame, virtual frame, frames that are still held)."""
    total, left = problem.music.frames, problem.frames.left

    @cache
    def best(t: int, f: int, held: int) -> float:
        if t == total:
            return 0.0
        found = -np.inf
        if left[f] > 0 or t + 1 == total:
            found = shown_worth(problem, t, f) + best(t + 1, f + 1, max(held - 1, 0))
        if held == 0 and t > 0:
            for entry, cost in ways_on(problem, t, f):
                found = max(found, best(t, entry, problem.hold) - cost)
        return found

    return max(best(0, f, 0) for f in range(len(problem.frames)))


def blocks_shown(problem: Problem, path: Path) -> list[int]:
    """The stretches of source that a path shows, in order; two moves in a row that show the same one count twice."""
    shown: list[int] = []
    ends = [*path.times[1:].tolist(), problem.music.frames]
    for t, f, end in zip(path.times.tolist(), path.entries.tolist(), ends, strict=True):
        run = problem.frames.block[f : f + end - t]
        shown += run[np.flatnonzero(np.diff(run, prepend=-1))].tolist()
    return shown


def brute_force_without_repeats(problem: Problem) -> float:
    """The best score of all paths that show no stretch of source twice; −∞ if there is none."""
    total, laid = problem.music.frames, problem.frames

    def best(t: int, f: int, held: int, shown: frozenset[int], fresh: bool) -> float:
        if t == total:
            return 0.0
        found, block = -np.inf, int(laid.block[f])
        entered = fresh or block != int(laid.block[f - 1])
        if (laid.left[f] > 0 or t + 1 == total) and not (entered and block in shown):
            on = best(t + 1, f + 1, max(held - 1, 0), shown | {block}, False)
            found = shown_worth(problem, t, f) + on
        if held == 0 and t > 0:
            for entry, cost in ways_on(problem, t, f):
                found = max(found, best(t, entry, problem.hold, shown, True) - cost)
        return found

    return max(best(0, f, 0, frozenset(), True) for f in range(len(laid)))


def check_path(problem: Problem, path: Path) -> None:
    """Assert that a path is one of the problem's: it begins at 0, moves on, and holds after joins."""
    assert path.times[0] == 0
    assert len(path.times) == len(path.entries)
    assert np.all(np.diff(path.times[1:]) >= problem.hold)
    assert np.all(np.diff(path.times) > 0)
    assert path.times[-1] < problem.music.frames
