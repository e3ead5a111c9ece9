"""A part of a library: stretches of its clips, with the joins from one to another.

The search of a great library is done on the part that is worth it. Frames of a part are shown exactly as those of the
whole library are, at the same phases of the playback rates, so that a dance out of a part is one out of the whole, with
the same score.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Bools, Ints, frozen
from onbeat.motion.motion import Motion
from onbeat.moves.graph import GRID, MotionGraph
from onbeat.moves.lazy import Maker
from onbeat.moves.library import Clip, MoveLibrary


@dataclass(frozen=True, eq=False)
class Part:
    """Stretches of the clips of a library.

    Parameters
    ----------
    clip : (P,) the clip of each stretch, rising.
    first, end : (P,) graph frames of the library, from ``first`` up to ``end``.

    Examples
    --------
    >>> part = Part.of(np.array([0, 1, 1, 0, 1, 1], bool), np.array([0, 0, 0, 1, 1, 1]))
    >>> part.clip.tolist(), part.first.tolist(), part.end.tolist(), len(part)
    ([0, 1], [1, 4], [3, 6], 4)
    """

    clip: Ints
    first: Ints
    end: Ints

    def __post_init__(self) -> None:
        for name in ("clip", "first", "end"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))

    @classmethod
    def whole(cls, library: MoveLibrary) -> Part:
        """All clips, each in one stretch."""
        return cls(np.arange(len(library.clips)), library.starts[:-1], library.starts[1:])

    @classmethod
    def of(cls, kept: Bools, clip_of: Ints) -> Part:
        """The stretches of frames that are ``kept`` (N,), cut where one clip ends and the next begins."""
        before = np.concatenate(([False], kept[:-1] & (clip_of[1:] == clip_of[:-1])))
        first = np.flatnonzero(kept & ~before)
        after = np.concatenate((before[1:] & kept[1:], [False]))
        return cls(np.asarray(clip_of[first]), first, np.flatnonzero(kept & ~after) + 1)

    def __len__(self) -> int:
        return int((self.end - self.first).sum())

    def __iter__(self) -> Iterator[tuple[int, int, int]]:
        return zip(self.clip.tolist(), self.first.tolist(), self.end.tolist(), strict=True)

    @cached_property
    def starts(self) -> Ints:
        """(P + 1,) where each stretch begins when all lie in a row, and the number of frames."""
        return np.concatenate(([0], np.cumsum(self.end - self.first)))

    @cached_property
    def frames(self) -> Ints:
        """(n,) the library's graph frames in it."""
        return np.concatenate([np.arange(first, end) for _, first, end in self] or [np.zeros(0, np.int64)])

    def joins(self, graph: MotionGraph) -> MotionGraph:
        """The graph of the part: its frames in a row, ``clip_of`` the library's clips, and the joins inside it."""
        lengths = np.diff(graph.indptr)[self.frames]
        rows = np.repeat(graph.indptr[self.frames] - (np.cumsum(lengths) - lengths), lengths)
        edges = rows + np.arange(len(rows))
        place = np.full(len(graph), -1, np.int64)
        place[self.frames] = np.arange(len(self))
        targets = place[graph.targets[edges]]
        inside = targets >= 0
        sources = np.repeat(np.arange(len(self)), lengths)[inside]
        indptr = np.concatenate(([0], np.cumsum(np.bincount(sources, minlength=len(self))))).astype(np.int64)
        clips = np.asarray(graph.clip_of[self.frames])
        return MotionGraph(clips, indptr, targets[inside], np.asarray(graph.costs[edges[inside]]))


def cut_library(library: MoveLibrary, part: Part) -> MoveLibrary:
    """The stretches of a part as clips of a library of their own, in the part's order.

    Clip k of it begins at the graph frame ``part.first[k]`` of the library.
    """
    clips = [_cut(library.clips[clip], first - int(library.starts[clip]), end - first) for clip, first, end in part]
    graph = part.joins(library.graph)
    clip_of = np.repeat(np.arange(len(clips)), np.diff(part.starts))
    return MoveLibrary(tuple(clips), MotionGraph(clip_of, graph.indptr, graph.targets, graph.costs))


def _cut(clip: Clip, first: int, count: int) -> Clip:
    """``count`` graph frames of a clip from ``first`` on; the motion is read when it is asked for."""
    if first == 0 and count == len(clip.poses):
        return clip
    begin, end = first / GRID, (first + count - 1) / GRID
    steps = slice(first, first + count)
    stops = clip.stops[(clip.stops >= begin) & (clip.stops <= end)] - begin
    keyposes = clip.keyposes[(clip.keyposes >= begin) & (clip.keyposes <= end)] - begin
    frames = max(1, min(round(count / GRID * clip.fps), int(np.ceil((clip.seconds - begin) * clip.fps - 1e-6))))
    return Clip(
        Maker(lambda: _moment(clip.motion, begin, frames)), clip.name, clip.source, clip.mirrored,
        stops, clip.intensity[steps], clip.poses[steps], keyposes, (frames, clip.fps),
    )  # fmt: skip


def _moment(motion: Motion, begin: float, frames: int) -> Motion:
    """``frames`` of a motion from second ``begin`` on: its own where it has one there."""
    start = begin * motion.fps
    if abs(start - round(start)) < 1e-6:
        return motion[round(start) : round(start) + frames]
    return motion.at(begin + np.arange(frames) / motion.fps)
