"""The joins of all groups, put in the order of the library's frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Ints
from onbeat.moves.disk.graph_files import Joins
from onbeat.moves.disk.shards import Shards, Span
from onbeat.moves.graph import MotionGraph
from onbeat.moves.making.joining import Join


@dataclass(frozen=True)
class Composed:
    """A graph whose joins lie in a spool, piece by piece.

    Parameters
    ----------
    clip_of : (N,) the clip of each frame.
    indptr : (N + 1,) rows, as of ``MotionGraph``.
    spool : where targets (int64) and costs (float32) of a piece lie, one after the other.
    spans : places of the pieces, in order.
    """

    clip_of: Ints
    indptr: Ints
    spool: Shards
    spans: tuple[Span, ...]

    @classmethod
    def of(cls, join: Join, spool: Shards) -> Composed:
        """Spool the joins of one group after the other."""
        counts = np.zeros(int(join.starts[-1]), np.int64)
        spans: dict[tuple[int, int], Span] = {}
        for lot, source, target, cost in join.joins():
            for piece in join.lots[lot].pieces:
                begin, end = (int(join.starts[piece.clip]) + frame for frame in (piece.start, piece.stop))
                part = slice(*np.searchsorted(source, (begin, end)).tolist())
                counts[begin:end] += np.bincount(source[part] - begin, minlength=end - begin)
                spans[piece.clip, piece.start] = spool.append([target[part], cost[part]])
        indptr = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
        return cls(join.clip_of, indptr, spool, tuple(spans[piece] for piece in sorted(spans)))

    def parts(self) -> Iterator[Joins]:
        """Targets and costs, piece by piece, in order."""
        for span in self.spans:
            data = self.spool.read(span)
            joins = len(data) // 12
            yield data[: 8 * joins].view("<i8"), data[8 * joins :].view("<f4")

    def graph(self) -> MotionGraph:
        """The graph, in memory."""
        targets, costs = zip(*self.parts(), strict=True)
        return MotionGraph(self.clip_of, self.indptr, np.concatenate(targets), np.concatenate(costs))
