"""Close pairs of frames: local minima of the table of distances, found block by block.

The table of all pairs is never held. A block is the table of two groups of frames (see ``blocks``); what is found in it
is a pure function of these two groups, the same bytes on any machine, with any number of threads, in any order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from threadpoolctl import threadpool_limits

from onbeat._shapes import Float32, Ints
from onbeat.errors import LibraryError
from onbeat.moves.pairs.blocks import NEAR, Group, Pairs, Span, group_spans
from onbeat.moves.pairs.caps import capped, density_for
from onbeat.moves.pairs.coarse import APPROXIMATE, COARSE, cell_pairs
from onbeat.moves.pairs.exact import exact_pairs

Method = Literal["exact", "coarse", "approximate"]
SIZES: tuple[tuple[float, Method], ...] = ((150_000, "exact"), (700_000, "coarse"), (math.inf, "approximate"))
"""Graph frames up to which each method is chosen."""


@dataclass(frozen=True)
class Search:
    """How the pairs of a block are searched for.

    Parameters
    ----------
    method : "exact" looks at every pair of frames; "coarse" at every pair of cells of four frames, and into those that
        may hold a minimum, with some margin; "approximate" does so with less.
    density : pairs kept at most for each pair of frames of two clips, the smoothest first (see ``caps``).
    """

    method: Method = "exact"
    density: float = math.inf

    def __post_init__(self) -> None:
        known = [method for _, method in SIZES]
        if self.method not in known:
            raise LibraryError(f"a search {self.method!r} is not known; there are {', '.join(known)}")
        if not self.density > 0:
            raise LibraryError(f"{self.density} pairs are to be kept for each pair of frames; expected more than 0")


EXACT = Search()


def search_for(frames: int, method: Method | None = None) -> Search:
    """The search for a library of some graph frames; the method is chosen by the size unless it is told.

    Examples
    --------
    >>> search_for(20_000), search_for(1_000_000).method
    (Search(method='exact', density=inf), 'approximate')
    """
    return Search(method or next(method for size, method in SIZES if frames <= size), density_for(frames))


def block_pairs(a: Group, b: Group, limit: float, search: Search = EXACT, near: int = NEAR) -> Pairs:
    """Pairs of frames at a local minimum of their distance, of two groups or of one with itself (``b is a``).

    The pairs of two clips depend on nothing but these two: a frame nearer than ``near`` to an end of its clip, whose
    neighbours are not all known, is in no pair. Of a clip with itself the first frame is before the second. A minimum
    is one by sums in float64 in a fixed order, so the bytes are the same on any machine.

    Parameters
    ----------
    a, b : groups of whole clips, or pieces of long ones.
    limit : pairs are nearer than this (not squared).
    near : a minimum is the lowest among ``near`` frames on each side in both directions; of equals, the first.

    Returns
    -------
    In the groups' own frames.

    Raises
    ------
    LibraryError
        If the limit is negative or no number, or the poses of the groups are not equally long.

    Examples
    --------
    >>> x = Group(np.array([[9.0], [5.0], [1.0]], np.float32), np.zeros(3, np.int64))
    >>> y = Group(np.array([[7.0], [4.8], [2.0]], np.float32), np.ones(3, np.int64))
    >>> i, j, d = block_pairs(x, y, limit=1.0, near=1)
    >>> i.tolist(), j.tolist(), d.astype(float).round(2).tolist()
    ([1], [1], [0.2])
    """
    if not (0 <= limit < math.inf):
        raise LibraryError(f"pairs are to be at most {limit} apart; expected a number from 0")
    if a.poses.shape[1] != b.poses.shape[1]:
        raise LibraryError(f"poses of {a.poses.shape[1]} and {b.poses.shape[1]} numbers cannot be compared")
    if limit == 0 or len(a) <= 2 * near or len(b) <= 2 * near:
        return Pairs.none()
    if search.method == "exact":
        found = exact_pairs(a, b, limit, near)
    else:
        care = COARSE if search.method == "coarse" else APPROXIMATE
        found = cell_pairs(a, b, limit, care, search.density, near)
    return capped(found, a, b, search.density)


def clip_pairs(
    clips: Sequence[Float32],
    limit: float,
    search: Search | None = None,
    workers: int = 2,
    step: Callable[[float], None] | None = None,
) -> Pairs:
    """Pairs of frames of a list of clips, as :func:`block_pairs` finds them block by block.

    Parameters
    ----------
    clips : for each clip (n, D) pose vectors.
    limit : largest distance (not squared).
    search : chosen by the number of frames where none is given.
    workers : threads; the result does not depend on it.
    step : called with the share done, 0…1.

    Returns
    -------
    In frames of all clips in a row, in order.

    Examples
    --------
    >>> fast, slow = (np.cos(np.arange(60) * turn)[:, None].astype(np.float32) for turn in (0.1, 0.09))
    >>> first, second, distance = clip_pairs([fast, slow], limit=0.01)
    >>> bool((second > first).all() and (distance < 0.01).all())
    True
    """
    lengths = [len(clip) for clip in clips]
    search = search_for(sum(lengths)) if search is None else search
    spans = group_spans(lengths)
    groups = _groups(clips, spans)
    blocks = [(a, b) for a in range(len(groups)) for b in range(a, len(groups))]

    def found(block: tuple[int, int]) -> Pairs:
        a, b = block
        pairs = block_pairs(groups[a], groups[b], limit, search)
        return pairs.moved(spans[a].start, spans[b].start)

    parts: list[Pairs] = []
    pool = ThreadPoolExecutor(max(workers, 1))
    with threadpool_limits(1, "blas"):
        try:
            for done, pairs in enumerate(pool.map(found, blocks), 1):
                parts.append(pairs)
                if step is not None:
                    step(done / len(blocks))
        finally:  # a user who stops it does not wait for all that was planned
            pool.shutdown(cancel_futures=True)
    return Pairs.joined(parts)


def _groups(clips: Sequence[Float32], spans: Sequence[Span]) -> list[Group]:
    if not spans:
        return []
    clip_of: Ints = np.repeat(np.arange(len(clips)), [len(clip) for clip in clips])
    poses = np.concatenate([np.asarray(clip, np.float32) for clip in clips])
    return [Group(poses[span.start : span.stop], clip_of[span.start : span.stop]) for span in spans]
