"""The motion graph as the page draws it: the clips a dance goes through, a sample of the others, and their joins.

A library may have thousands of clips and millions of joins: of each pair of clips that are drawn the smoothest join is
taken, and of these at most so many that lines can be told apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Ints
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.viewer.contract import ClipData, GraphData, JoinData

CLIPS, JOINS = 60, 400
"""Clips drawn at most where fewer are danced, and joins."""


def drawn_graph(library: MoveLibrary, danced: Sequence[str]) -> GraphData:
    """The part of a library's graph that is drawn for a dance through the clips named ``danced``.

    Those danced come first, in the order in which they are; the others are spread evenly over the library.

    Examples
    --------
    >>> from onbeat.moves.embedded import embedded_library
    >>> library = embedded_library()
    >>> graph = drawn_graph(library, [library.clips[3].name])
    >>> graph.clips[0].name == library.clips[3].name, len(graph.clips) <= CLIPS, len(graph.joins) <= JOINS
    (True, True, True)
    """
    shown = _shown(library, danced)
    clips = [ClipData(library.clips[k].name, round(library.clips[k].seconds, 3)) for k in shown]
    return GraphData(clips, _joins(library, np.array(shown, np.int64)), len(library.clips), library.graph.join_count)


def _shown(library: MoveLibrary, danced: Sequence[str]) -> list[int]:
    number = {clip.name: k for k, clip in enumerate(library.clips)}
    first = [number[name] for name in dict.fromkeys(danced) if name in number]
    others = np.setdiff1d(np.arange(len(library.clips)), first)
    room = min(max(CLIPS - len(first), 0), len(others))
    return first + others[np.arange(room) * len(others) // max(room, 1)].tolist()


def _joins(library: MoveLibrary, shown: Ints) -> list[JoinData]:
    """The smoothest join of each pair of clips, of these the smoothest; in the order of the clips."""
    graph = library.graph
    starts = np.searchsorted(graph.clip_of, shown, side="left")
    place = np.full(len(library.clips), -1)
    place[shown] = np.arange(len(shown))
    rows = [_leaving(library, int(clip), int(start), place) for clip, start in zip(shown, starts, strict=True)]
    table = np.concatenate([np.zeros((0, 5)), *rows])
    table = table[np.argsort(table[:, 4], kind="stable")[:JOINS]]
    table = table[np.lexsort((table[:, 2], table[:, 0]))]
    return [JoinData(int(a), round(out, 3), int(b), round(into, 3)) for a, out, b, into, _ in table.tolist()]


def _leaving(library: MoveLibrary, clip: int, start: int, place: Ints) -> np.ndarray:
    """(n, 5) place of the clip, second it is left, place of the next, second it is entered, distance: one for each."""
    graph = library.graph
    end = int(np.searchsorted(graph.clip_of, clip, side="right"))
    low, high = int(graph.indptr[start]), int(graph.indptr[end])
    source = np.repeat(np.arange(start, end), np.diff(graph.indptr[start : end + 1]))
    target, cost = np.asarray(graph.targets[low:high]), np.asarray(graph.costs[low:high])
    other = graph.clip_of[target]
    keep = (place[other] >= 0) & (other != clip)
    source, target, cost, other = source[keep], target[keep], cost[keep], other[keep]
    order = np.lexsort((cost, other))
    order = order[np.unique(other[order], return_index=True)[1]]
    into = (target - np.searchsorted(graph.clip_of, other))[order] / GRID
    columns = (np.full(len(order), place[clip]), (source[order] - start) / GRID, place[other[order]], into, cost[order])
    return np.column_stack(columns)
