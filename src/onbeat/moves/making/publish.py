"""From clips in stock to a library: pairs, graph, and the new generation in the place of the old one."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from onbeat.moves.disk.graph_files import write_graph
from onbeat.moves.disk.index import committed
from onbeat.moves.disk.shards import DiskShards, MemoryShards
from onbeat.moves.engine import Engine, run
from onbeat.moves.graph import MotionGraph
from onbeat.moves.making.compose import Composed
from onbeat.moves.making.generations import Entry, Generation, Options, put_generation
from onbeat.moves.making.joining import Blocks, Join, search_blocks
from onbeat.moves.making.stock import Row, Stock
from onbeat.moves.making.sweep import SPOOL, sweep
from onbeat.moves.similarity import search_for

Step = Callable[[str, float], None]
PAIRED = 0.9  # share of the time at which all pairs are found


def rising(step: Step) -> Step:
    """Progress that never goes back, by however little."""
    reached = 0.0

    def told(what: str, share: float) -> None:
        nonlocal reached
        reached = min(max(reached, share), 1.0)
        step(what, reached)

    return told


class Draft(NamedTuple):
    """All that a library will be besides its graph.

    Parameters
    ----------
    method, options, reading, stage, skeleton, entries : as of ``generations.Generation``.
    members : for each clip, in order, the number of its recording and its row.
    """

    method: str
    options: Options
    reading: str
    stage: str
    skeleton: str
    entries: Sequence[Entry]
    members: Sequence[tuple[int, Row]]

    @property
    def seal(self) -> str:
        """What a graph is the graph of: skeleton and clips, in order."""
        return seal_of(self.skeleton, [row for _, row in self.members])

    def content(self, graph: str) -> str:
        """A digest of all of it, its graph's name included."""
        told = repr((self.options.mirror, self.options.fps, self.seal, graph, [tuple(e) for e in self.entries]))
        return hashlib.sha256(told.encode(errors="replace")).hexdigest()


def seal_of(skeleton: str, rows: Sequence[Row]) -> str:
    """What a graph is the graph of, in words."""
    return " ".join([skeleton, *(row.digest for row in rows)])


def publish(stock: Stock, draft: Draft, engine: Engine, step: Step) -> MotionGraph | None:
    """Find the pairs that are not in stock, make the graph of all, and put the library in its place.

    Returns
    -------
    The graph, if the library is kept in memory.

    Raises
    ------
    StorageError
        If it cannot be written; the library that was there is still there.
    """
    rows = [row for _, row in draft.members]
    join = Join(stock, rows, search_for(sum(row.shape.poses for row in rows), draft.options.search))
    _find_pairs(join, engine, step)
    step("joining", PAIRED)
    composed, graph = _composed(join, draft.seal)
    new = Generation(
        draft.method,
        draft.options,
        draft.reading,
        draft.stage,
        draft.skeleton,
        graph,
        draft.content(graph),
        draft.entries,
        [(number, row.id) for number, row in draft.members],
    )
    with stock.storing():
        with committed(stock.index):
            put_generation(stock.index, new)
        sweep(stock, new, join)
    step("done", 1.0)
    return composed.graph() if stock.folder is None else None


def _find_pairs(join: Join, engine: Engine, step: Step) -> None:
    total, found = join.block_count(), 0

    def done(task: Blocks, blocks: Sequence[tuple[bytes, np.ndarray]]) -> None:
        nonlocal found
        found += len(blocks)
        join.stock.put_blocks(blocks)
        step("finding joins", PAIRED * found / total)

    step("finding joins", 0.0)
    run(join.missing(), search_blocks, done, engine, parts=join.parts())


def _composed(join: Join, seal: str) -> tuple[Composed, str]:
    folder = join.stock.folder
    if folder is None:
        return Composed.of(join, MemoryShards()), "in memory"
    with join.stock.storing():
        spool = DiskShards(folder / SPOOL, "joins")
        try:
            composed = Composed.of(join, spool)
        finally:
            spool.close()
        return composed, write_graph(folder, composed.indptr, composed.parts, seal)
