"""One decision of the 2006 search, laid open (Sec. V, Fig. 5): the paths three seconds ahead, and the chosen one."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.dance.greedy import HORIZON
from onbeat.dance.lookahead import Roads
from onbeat.dance.make import Dance
from onbeat.dance.search import make_problem
from onbeat.dance.shiratori2006 import BEST_PATHS, NEAR, TIE, Components, components
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary


@dataclass(frozen=True, eq=False)
class Choice:
    """What the search knows when it decides how to go on.

    Parameters
    ----------
    second : of the dance.
    paths : (P, H) frame of the motion graph shown by each path at each song frame ahead, best by Eq. 11 first.
    rhythm : (P,) Eq. 11 of each path.
    intensity : (P,) Eq. 12 of each path, m/s times the music's intensity.
    best : how many of them are the BP of the paper: the best by Eq. 11, up to 16, all within 5 % of the first.
    chosen : which of these is danced: the one best by Eq. 12.
    parts : the components that were correlated.
    """

    second: float
    paths: Ints
    rhythm: Array
    intensity: Array
    best: int
    chosen: int
    parts: Components

    @property
    def begin(self) -> int:
        """The first song frame ahead."""
        return round(self.second * GRID)


def choice_before(dance: Dance, library: MoveLibrary, move: int) -> Choice:
    """The decision by which a dance of ``shiratori2006`` comes from one move to the next.

    Parameters
    ----------
    dance : by ``shiratori2006``, without a time warp.
    library : it dances with.
    move : the move that is danced when it is decided, not the last.
    """
    problem = make_problem(library, dance.song, rates=(1.0,))
    joins = problem.graph.join_count
    nothing = (
        np.zeros(joins + 1, np.int32),
        np.zeros(0, np.int32),
        np.zeros(0, np.float32),
        np.zeros(joins, np.float32),
    )
    roads = replace(Roads.of(problem), costs=np.zeros(joins), seams=nothing)  # in the paper joins cost nothing
    parts = components(library, dance.song, roads.frames)
    now = dance.plan.moves[move]
    t = round(now.at_s * GRID) + roads.hold
    frame = int(library.starts[now.clip]) + round(now.from_s * GRID) + roads.hold
    return _choice(roads, parts, t, frame)


def _choice(roads: Roads, parts: Components, t: int, frame: int) -> Choice:
    ahead = round(HORIZON * GRID)
    rhythm, intensity = parts.rhythm(t, ahead), parts.intensity(t, ahead)
    table = rhythm + TIE * intensity
    values = roads.values(t, table, roads.hold)
    branches = roads.branches(t, frame, table, values)
    order = np.argsort(-branches.value, kind="stable")
    best = min(int((branches.value >= NEAR * branches.value[order[0]]).sum()), BEST_PATHS)
    paths = np.array(
        [_path(roads, table, values, t, frame, int(branches.wait[k]), int(branches.entry[k])) for k in order]
    )
    rows = np.arange(len(table))
    sums = intensity[rows, paths].sum(axis=1)
    return Choice(t / GRID, paths, rhythm[rows, paths].sum(axis=1), sums, best, int(np.argmax(sums[:best])), parts)


def _path(roads: Roads, table: Array, values: Array, t: int, frame: int, wait: int, entry: int) -> Ints:
    """(H,) the frames of a branch and its best completion by Eq. 11."""
    shown: list[int] = []
    while True:
        shown += range(frame, frame + wait)
        if entry < 0 or len(shown) >= len(table):
            break
        shown += range(entry, entry + roads.hold)
        frame, k = entry + roads.hold, len(shown)
        if k >= len(table):
            break
        found = roads.branches(t + k, frame, table[k:], values[k:])
        following = int(np.argmax(found.value))
        wait, entry = int(found.wait[following]), int(found.entry[following])
    return np.array(shown[: len(table)], np.int64)
