"""The minima of a block, all of them: one matrix product a tile, scanned while it is in cache."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from onbeat._shapes import Bools, Float32
from onbeat.moves.pairs.blocks import Group, Pairs, Span
from onbeat.moves.pairs.minima import Found, table_minima

TILE = 512  # rows and columns of a tile: 1 MB of float32, which stays in the second cache


def exact_pairs(a: Group, b: Group, limit: float, near: int) -> Pairs:
    """Local minima under ``limit`` of the distances of two groups, or of one with itself above its diagonal."""
    product = Product(a, b)
    inner = a.inner(near), b.inner(near)
    parts: list[Found] = []
    for i in range(0, len(a), TILE):
        for j in range(i if a is b else 0, len(b), TILE):
            rows, columns = _with_rim(i, len(a), near), _with_rim(j, len(b), near)
            takes = _only(inner[0], i, rows), _only(inner[1], j, columns)
            if takes[0].any() and takes[1].any():
                table = product.table(rows, columns)
                limits = (limit * limit, product.rounding)
                places = (rows.start, takes[0]), (columns.start, takes[1])
                parts.append(table_minima(table, a.poses, b.poses, *places, limits, near, a is b))
    return pairs_of(parts)


class Product:
    """Squared distances of the frames of two groups as one product: ``[a, |a|², 1] · [−2b, 1, |b|²]``."""

    def __init__(self, a: Group, b: Group) -> None:
        middle, self.left = _left(a)
        self.right = _rows(b.poses, middle)
        norms, others = self.left[:, -2], self.right[:, -2].copy()
        self.right[:, :-2] *= -2
        self.right[:, -2], self.right[:, -1] = 1, others
        largest = max(float(norms.max(initial=0)), float(others.max(initial=0)))
        # a sum of K products errs by K roundings of the sum of their sizes at most (Higham 2002, 3.1): of (|a| + |b|)²
        self.rounding = (self.left.shape[1] + 16) * 2.0**-24 * 4 * largest
        self._room = np.empty(0, np.float32)

    def table(self, rows: Span, columns: Span) -> Float32:
        """Squared distances of some frames; it is overwritten by the next."""
        shape = rows.stop - rows.start, columns.stop - columns.start
        if self._room.size < shape[0] * shape[1]:
            self._room = np.empty(shape[0] * shape[1], np.float32)
        table = self._room[: shape[0] * shape[1]].reshape(shape)
        return np.dot(self.left[rows.start : rows.stop], self.right[columns.start : columns.stop].T, out=table)


def pairs_of(parts: list[Found]) -> Pairs:
    """Minima of tiles as pairs, their squared distances made distances."""
    return Pairs.joined([Pairs(i, j, np.sqrt(value).astype(np.float32)) for i, j, value in parts])


@lru_cache(maxsize=2)  # one group after the other is compared with all
def _left(group: Group) -> tuple[Float32, Float32]:
    middle = group.middle
    return middle, _rows(group.poses, middle)


def _rows(poses: Float32, middle: Float32) -> Float32:
    """Poses seen from the middle, their squares' sum, and one."""
    rows = np.empty((len(poses), poses.shape[1] + 2), np.float32)
    np.subtract(poses, middle, out=rows[:, :-2])
    rows[:, -2] = np.einsum("ij,ij->i", rows[:, :-2], rows[:, :-2])
    rows[:, -1] = 1
    return rows


def _with_rim(start: int, frames: int, near: int) -> Span:
    return Span(max(start - near, 0), min(start + TILE + near, frames))


def _only(inner: Bools, start: int, span: Span) -> Bools:
    """Which frames of a span may hold a minimum: those of the tile at ``start``, away from ends of clips."""
    takes = np.zeros(span.stop - span.start, np.bool_)
    takes[start - span.start : start - span.start + TILE] = inner[start : min(start + TILE, span.stop)]
    return takes
