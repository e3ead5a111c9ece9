"""The motion graph: frames of all clips in a row, and joins from one to another.

Frames are sampled at ``GRID`` Hz. From each frame the dance goes on to the next of the same clip, or over a join to
another. A join from i to j leaves its clip before frame i is shown and shows frame j in its place.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from onbeat._shapes import Bools, Float32, Ints

GRID = 30.0
"""Hz, the rate of the graph's frames."""
MARGIN = 0.25
"""Seconds of its clip that a join needs on each side, for the blend."""
STRETCH = 0.8
"""Seconds that are danced at least between two joins."""
LOOP = 4.0
"""Seconds that a join may not go back within a clip: it would show again what was shown a moment ago."""
FAN = 48
"""Joins kept at most from one frame, the smoothest first."""


@dataclass(frozen=True)
class MotionGraph:
    """Frames and joins.

    Parameters
    ----------
    clip_of : (N,) the clip of each frame; clips lie one after the other.
    indptr, targets, costs : joins in compressed rows: those leaving frame i are ``indptr[i]:indptr[i + 1]``; the
        frames they enter, and their pose distances.
    """

    clip_of: Ints
    indptr: Ints
    targets: Ints
    costs: Float32

    @classmethod
    def of(cls, clip_of: Ints, first: Ints, second: Ints, distance: Float32) -> MotionGraph:
        """A graph from close pairs of frames, each used in both directions where there is room.

        A join leaves a frame that has ``MARGIN`` seconds of its clip after it, and enters one that has ``MARGIN``
        before it and ``STRETCH`` + ``MARGIN`` after it. Joins in one clip that go back less than ``LOOP`` seconds or
        forward less than ``STRETCH`` are left out, and all but the ``FAN`` nearest from each frame.
        """
        room = Room.of(clip_of)
        source, target = np.concatenate((first, second)), np.concatenate((second, first))
        source, target, cost = room.joins(source, target, np.concatenate((distance, distance)).astype(np.float32))
        frames = len(clip_of)
        indptr = np.concatenate(([0], np.cumsum(np.bincount(source, minlength=frames)))).astype(np.int64)
        return cls(np.asarray(clip_of, np.int64), indptr, target.astype(np.int64), cost)

    def __len__(self) -> int:
        return len(self.clip_of)

    @property
    def join_count(self) -> int:
        """How many joins there are."""
        return len(self.targets)

    @cached_property
    def sources(self) -> Ints:
        """The frame that each join leaves."""
        return np.repeat(np.arange(len(self)), np.diff(self.indptr))

    @cached_property
    def goes_on(self) -> Bools:
        """(N,) true where the next frame is of the same clip."""
        return np.append(self.clip_of[1:] == self.clip_of[:-1], False)

    @cached_property
    def core(self) -> Bools:
        """(N,) true for the largest strongly connected part: no dead ends, and every frame can be reached again."""
        frames = len(self)
        following = np.flatnonzero(self.goes_on)
        rows = np.concatenate((following, self.sources))
        columns = np.concatenate((following + 1, self.targets))
        table = csr_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(frames, frames))
        _, label = connected_components(table, directed=True, connection="strong")
        sizes = np.bincount(label)
        return label == np.argmax(sizes)

    def trimmed(self) -> MotionGraph:
        """Only the joins inside the core (for walks without end: a search over a whole song needs no trimming)."""
        inside = self.core[self.sources] & self.core[self.targets]
        sources = self.sources[inside]
        indptr = np.concatenate(([0], np.cumsum(np.bincount(sources, minlength=len(self))))).astype(np.int64)
        return MotionGraph(self.clip_of, indptr, self.targets[inside], self.costs[inside])


@dataclass(frozen=True)
class Room:
    """Where joins may leave and enter.

    Parameters
    ----------
    clip_of : (N,) the clip of each frame.
    after, before : (N,) frames of the same clip after and before each frame.
    """

    clip_of: Ints
    after: Ints
    before: Ints

    @classmethod
    def of(cls, clip_of: Ints) -> Room:
        """Counted in a row of clips."""
        index = np.arange(len(clip_of))
        starts = np.searchsorted(clip_of, clip_of, side="left")
        ends = np.searchsorted(clip_of, clip_of, side="right")
        return cls(clip_of, ends - 1 - index, index - starts)

    def joins(self, source: Ints, target: Ints, cost: Float32) -> tuple[Ints, Ints, Float32]:
        """Those of some joins that there is room for, at most ``FAN`` from a frame, in order of source and cost.

        All joins from one frame are to be given together.
        """
        margin, stretch = round(MARGIN * GRID), round(STRETCH * GRID)
        back, loop = source - target, round(LOOP * GRID)
        near = (self.clip_of[source] == self.clip_of[target]) & (back > -stretch) & (back < loop)
        room = (self.after[source] >= margin) & (self.before[target] >= margin)
        keep = room & (self.after[target] >= stretch + margin) & ~near
        source, target, cost = source[keep], target[keep], cost[keep]
        order = np.lexsort((target, cost, source))
        source, target, cost = source[order], target[order], cost[order]
        rank = np.arange(len(source)) - np.searchsorted(source, source)
        return source[rank < FAN], target[rank < FAN], cost[rank < FAN]
