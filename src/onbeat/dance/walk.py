"""A dance that does not listen: random joins, the control beside which every search has to be shown."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Ints
from onbeat.dance.lookahead import Roads
from onbeat.dance.optimal import Path, Problem, joins_from, score_path
from onbeat.moves.graph import GRID

EVERY = 1.5
"""Seconds from one join to the next on average, where the graph has joins enough."""


def random_walk(problem: Problem, rng: np.random.Generator) -> Path:
    """A random dance: it waits for a time drawn anew after each join, then takes one of the joins there, all alike.

    Raises
    ------
    PlanError
        If no dance over the joins is as long as the song.
    """
    roads = Roads.of(problem)
    total, hold = roads.frames, roads.hold
    frame = int(rng.choice(_beginnings(roads)))
    t, times, entries = 0, [0], [frame]
    while True:
        mean = max(EVERY * GRID - (hold if t else 0), 1.0)
        wish = int(rng.geometric(1.0 / mean)) - (1 if t else 0)  # a dance does not begin with a join
        wait, goals = _joins_after(problem, roads, t, frame, wish)
        if not len(goals):
            break
        t, frame = t + wait, int(rng.choice(goals))
        times.append(t)
        entries.append(frame)
        t, frame = t + hold, frame + hold
        if t >= total:
            break
    return Path(np.array(times), np.array(entries), score_path(problem, times, entries))


def _beginnings(roads: Roads) -> Ints:
    """Frames with which the dance can begin: they are shown, and what comes after is as long as the song."""
    if roads.reach is not None:
        begins = roads.ahead(0)[1][1:] & (roads.left[:-1] > 0) if roads.frames > 1 else roads.ahead(0)[0][:-1]
        return np.flatnonzero(begins)
    lasts = roads.left + 1 >= roads.frames
    lasts[:-1] |= (roads.left[:-1] > 0) & (roads.survival[1:] >= roads.frames - 1)
    return np.flatnonzero(lasts)


def _joins_after(problem: Problem, roads: Roads, t: int, frame: int, wish: int) -> tuple[int, Ints]:
    """The first wait of at least ``wish`` frames with joins from which the song can be ended, and where they lead.

    Where there is none the last before it is taken, unless the clip lasts to the song's end: then none.
    """
    total, left = roads.frames, int(roads.left[frame])
    free = roads.free(t, frame)
    lasts = min(left + 1, free) >= total - t
    longest = min(left, free, total - t - 1)
    later, sooner = range(wish, longest + 1), range(min(wish - 1, longest), -1 if t else 0, -1)
    for wait in (*later, *(() if lasts else sooner)):
        goals, _ = joins_from(problem, frame + wait, t + wait)
        if len(goals):
            goals = goals[roads.enterable(t + wait, goals)]
        if len(goals):
            return wait, goals
    return 0, np.zeros(0, np.int64)
