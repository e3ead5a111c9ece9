"""The dance found by looking a few seconds ahead, again and again, on the same objective as ``optimal``."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Float32
from onbeat.dance.lookahead import Branches, Roads
from onbeat.dance.optimal import Path, Problem, rewards, score_path
from onbeat.moves.graph import GRID

HORIZON = 3.0
"""T: seconds looked ahead."""
PART = 1.0
"""Seconds danced of a best path without a join before it is looked ahead again."""


def greedy_path(problem: Problem, horizon_s: float = HORIZON) -> Path:
    """The dance whose every first branch is that of the best path over the next ``horizon_s`` seconds.

    Raises
    ------
    PlanError
        If no dance over the joins is as long as the song.
    """
    roads = Roads.of(problem)
    ahead = max(round(horizon_s * GRID), 1)
    table = reward_table(problem, 0, ahead)
    frame = int(np.argmax(roads.values(0, table)[0]))
    t, times, entries = 0, [0], [frame]
    while t < roads.frames:
        table = reward_table(problem, t, ahead)
        found = roads.branches(t, frame, table, roads.values(t, table, roads.hold))
        t, frame = follow(roads, found, int(np.argmax(found.value)), t, frame, times, entries)
    return Path(np.array(times), np.array(entries), score_path(problem, times, entries))


def reward_table(problem: Problem, t: int, ahead: int) -> Float32:
    """(H, M) worth of each frame at song frames t, t + 1, … for ``ahead`` frames or to the song's end."""
    table = np.empty((min(ahead, problem.music.frames - t), len(problem.frames)), np.float32)
    for k, row in enumerate(table):
        rewards(t + k, row, *problem.worth)
    return table


def follow(
    roads: Roads, found: Branches, chosen: int, t: int, frame: int, times: list[int], entries: list[int]
) -> tuple[int, int]:
    """Dance up to and over the chosen branch, or one ``PART`` where it has none; the song frame and frame reached."""
    entry = int(found.entry[chosen])
    if entry < 0:
        part = min(round(PART * GRID), int(found.wait[chosen]))
        end = t + int(found.wait[chosen])
        return (end, frame) if end == roads.frames else (t + part, frame + part)
    t += int(found.wait[chosen])
    times.append(t)
    entries.append(entry)
    return t + roads.hold, entry + roads.hold
