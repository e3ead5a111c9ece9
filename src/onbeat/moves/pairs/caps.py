"""Caps: of the pairs of two clips no more than their share, the smoothest first.

In hours of one dancer's steps each frame is near thousands of others, of which the graph keeps a few dozen. Each two
clips get a share of them by their lengths; so joins lead to many clips, and pairs grow with the frames, not with their
square. What is kept depends on the pairs of these two clips alone, in whatever order they were found; a tighter cap
keeps a part of what a wider one keeps.
"""

from __future__ import annotations

import math

import numpy as np

from onbeat._shapes import Ints
from onbeat.moves.pairs.blocks import Group, Pairs

PAIRS = 32
"""Joins that leave a frame at most, on average over a library: each pair of frames is a join both ways."""
SMALL = 30_000
"""Graph frames up to which all pairs are kept."""


def density_for(frames: int) -> float:
    """Pairs kept at most for each pair of frames, in a library of some graph frames.

    A power of two, so that it changes only where a library doubles.

    Examples
    --------
    >>> density_for(20_000), density_for(108_000) == 2**-12
    (inf, True)
    """
    return math.inf if frames <= SMALL else 2.0 ** math.floor(math.log2(PAIRS / frames))


def capped(pairs: Pairs, a: Group, b: Group, density: float) -> Pairs:
    """The smoothest pairs of each two clips of two groups, ``density`` times the pairs of their frames (at least one).

    Pairs in one clip are all kept: they are few.
    """
    if math.isinf(density) or len(pairs.first) == 0:
        return pairs
    one, two = _numbers(a), _numbers(b)
    k, m = one[pairs.first], two[pairs.second]
    frames = np.diff(a.bounds)[k].astype(np.float64) * np.diff(b.bounds)[m]
    quota = np.maximum(np.ceil(density * frames), 1.0)
    keep = _rank(k * len(b.bounds) + m, pairs) < quota
    if a is b:
        keep |= k == m
    return Pairs(pairs.first[keep], pairs.second[keep], pairs.distance[keep])


def _numbers(group: Group) -> Ints:
    """(n,) which clip of the group each frame is of: 0, 1, 2 …"""
    return np.repeat(np.arange(len(group.bounds) - 1), np.diff(group.bounds))


def _rank(kind: Ints, pairs: Pairs) -> Ints:
    """(P,) how many pairs of the same kind are smoother; of equal ones the earlier is."""
    order = np.lexsort((pairs.second, pairs.first, pairs.distance, kind))
    rank = np.empty(len(order), np.int64)
    sorted_kind = kind[order]
    rank[order] = np.arange(len(order)) - np.searchsorted(sorted_kind, sorted_kind)
    return rank
