"""From clips to a graph: pairs block by block, then the joins of one group of clips after the other.

Neither all pairs nor all joins are ever held in memory.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Float32, Ints
from onbeat.errors import LibraryError
from onbeat.moves.disk.shards import DiskShards, Shards, Span
from onbeat.moves.engines.crew import Parts
from onbeat.moves.graph import Room
from onbeat.moves.library import REACH
from onbeat.moves.making.groups import Lot, Member, lots_of
from onbeat.moves.making.stock import PAIR, SHARDS, Row, Stock
from onbeat.moves.methods import joining_method
from onbeat.moves.pairs.blocks import Group
from onbeat.moves.similarity import Search, block_pairs

RUN = 8  # blocks of one task


class Poses(NamedTuple):
    """Where the poses of a group lie: for each piece the place of its rows; and how many floats a row holds."""

    spans: tuple[Span, ...]
    width: int


def load_group(shards: Path | Shards, poses: Poses) -> Group:
    """A group, read from a folder of shards or from memory."""
    source = DiskShards(shards, "clips") if isinstance(shards, Path) else shards
    parts = [source.read(span).view("<f4").reshape(-1, poses.width) for span in poses.spans]
    return Group(np.concatenate(parts), np.repeat(np.arange(len(parts)), [len(part) for part in parts]))


class Blocks(NamedTuple):
    """Blocks that one task searches: a group with some groups.

    Parameters
    ----------
    first, others : the groups; the first may be among the others.
    keys : of the blocks, in the order of the others.
    search : how.
    """

    first: Poses
    others: tuple[Poses, ...]
    keys: tuple[bytes, ...]
    search: Search

    def __str__(self) -> str:
        return f"blocks {self.keys[0].hex()[:8]} and {len(self.keys) - 1} more"

    @property
    def needs(self) -> tuple[Poses, ...]:
        """All groups, the first first."""
        return (self.first, *self.others)


def search_blocks(task: Blocks, first: Group, *others: Group) -> list[tuple[bytes, np.ndarray]]:
    """The pairs of each block of a task."""
    found: list[tuple[bytes, np.ndarray]] = []
    for key, poses, other in zip(task.keys, task.others, others, strict=True):
        same = poses == task.first
        one, two, distance = block_pairs(first, first if same else other, REACH, task.search)
        pairs = np.empty(len(one), PAIR)
        pairs["first"], pairs["second"], pairs["distance"] = one, two, distance
        found.append((key, pairs))
    return found


@dataclass(frozen=True)
class Join:
    """The pairs and the graph of clips that are in stock.

    Parameters
    ----------
    stock : of the library.
    rows : the clips, in order.
    search : how pairs are found.
    """

    stock: Stock
    rows: Sequence[Row]
    search: Search
    lots: list[Lot] = field(init=False)

    def __post_init__(self) -> None:
        members = [Member(n, row.content, row.digest, row.shape.poses) for n, row in enumerate(self.rows)]
        object.__setattr__(self, "lots", lots_of(members))

    @cached_property
    def starts(self) -> Ints:
        """(clips + 1,) the graph frame at which each clip begins."""
        return np.concatenate(([0], np.cumsum([row.shape.poses for row in self.rows]))).astype(np.int64)

    @property
    def clip_of(self) -> Ints:
        """(N,) the clip of each graph frame."""
        return np.repeat(np.arange(len(self.rows)), np.diff(self.starts))

    @cached_property
    def _method(self) -> bytes:
        return f"{joining_method()} {REACH} {self.search}".encode()

    @cached_property
    def _frames(self) -> list[Ints]:
        """For each group its graph frames."""
        return [
            np.concatenate([np.arange(p.start, p.stop) + self.starts[p.clip] for p in lot.pieces]) for lot in self.lots
        ]

    def block_count(self) -> int:
        """How many blocks there are."""
        return len(self.lots) * (len(self.lots) + 1) // 2

    def key(self, a: int, b: int) -> bytes:
        """The key of a block, by which its pairs are known again."""
        first, second = sorted((self.lots[a].key, self.lots[b].key))
        return hashlib.blake2b(self._method + first + second, digest_size=16).digest()

    def poses(self, lot: int) -> Poses:
        """Where the poses of a group lie."""
        spans: list[Span] = []
        for clip, start, stop in self.lots[lot].pieces:
            row = self.rows[clip]
            bytes_ = 4 * row.shape.width
            at = row.span.offset + row.shape.poses_at + start * bytes_
            spans.append(Span(row.span.shard, at, (stop - start) * bytes_))
        return Poses(tuple(spans), self.rows[0].shape.width)

    def missing(self) -> Iterator[Blocks]:
        """Tasks for the blocks that are not in stock."""
        for a in range(len(self.lots)):
            wanted = [b for b in range(a, len(self.lots)) if self.stock.block(self.key(a, b)) is None]
            for start in range(0, len(wanted), RUN):
                run = wanted[start : start + RUN]
                others, keys = (self.poses(b) for b in run), (self.key(a, b) for b in run)
                yield Blocks(self.poses(a), tuple(others), tuple(keys), self.search)

    def parts(self) -> Parts[Blocks]:
        """The groups that tasks need, and how workers get them."""
        folder = self.stock.folder
        shards = self.stock.clips if folder is None else folder.absolute() / SHARDS
        return Parts(attrgetter("needs"), partial(load_group, shards), shards if isinstance(shards, Path) else None)

    def joins(self) -> Iterator[tuple[int, Ints, Ints, Float32]]:
        """For each group: which it is, and source, target and cost of the joins that leave its frames."""
        room = Room.of(self.clip_of)
        for lot in range(len(self.lots)):
            parts = [part for other in range(len(self.lots)) for part in self._sides(lot, other)]
            source, target, cost = (np.concatenate(column) for column in zip(*parts, strict=True))
            yield lot, *room.joins(source, target, cost)

    def _sides(self, lot: int, other: int) -> Iterable[tuple[Ints, Ints, Float32]]:
        """The pairs of a block as joins that leave the frames of a group."""
        pairs = self.stock.block(self.key(lot, other))
        if pairs is None:
            raise LibraryError(f"pairs of the library in {self.stock.folder} are damaged; build the library again")
        mine, theirs = self._frames[lot], self._frames[other]
        here, there, distance = pairs["first"], pairs["second"], np.array(pairs["distance"])
        if lot <= other:
            yield mine[here], theirs[there], distance
        if lot >= other:
            yield mine[there], theirs[here], distance
