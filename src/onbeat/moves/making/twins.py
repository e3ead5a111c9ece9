"""Takes that are there twice, such as one in two formats: they would be seen twice in a dance.

Two files of one take share what a dancer cannot do again: how fast each link turns from moment to moment. Formats
round, cut a frame off, store another rate, or tell it on another skeleton; link by link the velocities then still
correlate by .99 and more (measured: 01_01 of CMU as BVH and as AMC, and eight takes at 12 to 60 frames a second).
Another take of the same task may be nearer in its poses, but gets .96 at most (the gestures of Bandai-Namco's set 2).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from onbeat._shapes import Array, Float32
from onbeat.moves.poses import DIRECTIONS, VELOCITIES

SAME_LENGTH = 2
"""Graph frames by which two files of one take may differ, and by which one may be shifted against the other."""
APART = 0.25
"""Pose distance of their outlines at most; another skeleton alone makes .12 of it."""
ALIKE = 0.985
"""Correlation of the velocities of half of the links that move, at least."""
MOVES = 0.0003
"""Root mean square of a link's velocity, in units of pose vectors, from which on it moves."""
PARTS, COARSE = 8, 32  # of an outline: parts of a clip, and numbers that are compared first
EDGE = 3  # frames at both ends that are not looked at: one pose more there changes the velocities of some
BLOCK = 64  # clips compared at a time with all others
OUTLINED = 0.8  # share of the time at which all outlines are there
FURTHEST = SAME_LENGTH + 1  # shift at which clips are compared: one more frame, for the vertex between frames


def find_twins(
    lengths: Sequence[int], poses: Callable[[int], Float32], step: Callable[[float], None] | None = None
) -> dict[int, int]:
    """For each clip that moves as an earlier one does, all along, which that is.

    Each clip is read once for its outline. Those as long as another and alike in outline are compared frame by frame.

    Parameters
    ----------
    lengths : graph frames of each clip.
    poses : gives the (n, D) pose vectors of a clip.
    step : called with the share that is done, 0…1.

    Examples
    --------
    >>> walk = np.random.default_rng(0).normal(0, 0.1, (90, 112)).astype(np.float32)
    >>> clips = [walk, walk[::-1], walk[:89] + 0.01]
    >>> find_twins([len(clip) for clip in clips], lambda n: clips[n])
    {2: 0}
    """
    step = step or (lambda share: None)
    if len(lengths) < 2:
        return {}
    outlines = np.empty((len(lengths), PARTS * (DIRECTIONS.stop - DIRECTIONS.start)), np.float32)
    for n in range(len(lengths)):
        outlines[n] = _outline(poses(n))
        step(OUTLINED * n / len(lengths))
    twins: dict[int, int] = {}
    pairs = sorted((later, earlier) for earlier, later in _suspects(np.array(lengths), outlines))
    for count, (later, earlier) in enumerate(pairs):
        if earlier not in twins and later not in twins and _are_one(poses(earlier), poses(later)):
            twins[later] = earlier
        step(OUTLINED + (1 - OUTLINED) * count / len(pairs))
    return twins


def _outline(poses: Float32) -> Array:
    """(PARTS · 51,) mean link directions of parts of a clip; their distance is at most that of the poses, r.m.s."""
    bounds = np.linspace(0, len(poses), PARTS + 1).astype(np.int64).tolist()
    parts = [poses[a:b, DIRECTIONS].mean(axis=0) for a, b in pairwise(bounds)]
    return np.concatenate(parts) / np.sqrt(PARTS)


def _suspects(lengths: np.ndarray, outlines: Float32) -> Iterator[tuple[int, int]]:
    """Pairs of clips, as long as each other and with outlines nearer than ``APART``; the earlier one first."""
    order = np.argsort(lengths, kind="stable")
    counts, outlines = lengths[order], outlines[order]
    coarse = _along_axes(outlines)
    for start in range(0, len(order), BLOCK):
        rows = np.arange(start, min(start + BLOCK, len(order)))
        end = int(np.searchsorted(counts, counts[rows[-1]] + SAME_LENGTH, "right"))
        near = _squares(coarse[rows], coarse[start:end]) < APART**2
        near &= counts[start:end] - counts[rows, None] <= SAME_LENGTH
        one, two = np.nonzero(np.triu(near, 1))
        one, two = rows[one], start + two
        close = np.square(outlines[one] - outlines[two]).sum(axis=1) < APART**2
        for pair in np.sort(order[np.stack([one, two], axis=1)[close]], axis=1).tolist():
            yield pair[0], pair[1]


def _along_axes(outlines: Float32) -> Float32:
    """Outlines seen along the axes in which they differ most: never farther from each other than they are."""
    centred = outlines - outlines.mean(axis=0)
    return centred @ np.linalg.eigh(centred.T @ centred)[1][:, -COARSE:]


def _squares(some: Float32, others: Float32) -> Float32:
    squares = np.square(some).sum(axis=1)[:, None] + np.square(others).sum(axis=1)
    return squares - 2 * some @ others.T


def _are_one(one: Float32, two: Float32) -> bool:
    """Whether half of the links that move turn as fast at every moment, at the shift at which they do best."""
    product, first, second = _products(one[:, VELOCITIES], two[:, VELOCITIES])
    moves = np.maximum(first, second.max(axis=0)) > MOVES**2
    if not moves.any():
        return False  # two that stand still are no take
    by_lag = (product / np.sqrt(np.maximum(first * second, 1e-30)))[:, moves]
    best = 1 + int(by_lag[1:-1].mean(axis=1).argmax())
    before, there, after = by_lag[best - 1 : best + 2]
    return bool(np.median(_vertex(before, there, after)) >= ALIKE)


def _products(one: Float32, two: Float32) -> tuple[Array, Array, Array]:
    """(lags, 17), (17,), (lags, 17) mean of ab, aa and bb for each link's velocities, the second clip moved on."""
    size = max(min(len(one), len(two)) - 2 * (EDGE + FURTHEST), 1)
    first = one[EDGE + FURTHEST :][:size]
    late = sliding_window_view(two[EDGE:], size, axis=0)[: 2 * FURTHEST + 1]
    sums = (
        np.einsum("fd,ldf->ld", first, late, dtype=np.float64),
        np.einsum("fd,fd->d", first, first, dtype=np.float64),
        np.einsum("ldf,ldf->ld", late, late, dtype=np.float64),
    )
    product, aa, bb = (s.reshape(*s.shape[:-1], -1, 3).sum(axis=-1) / size for s in sums)
    return product, aa, bb


def _vertex(before: Array, there: Array, after: Array) -> Array:
    """The top of the parabolas through three values, at the one place between frames where their mean is highest."""
    slope, bend = (after - before) / 2, before - 2 * there + after
    at = float(np.clip(-slope.mean() / min(float(bend.mean()), -1e-12), -0.5, 0.5))
    return there + at * slope + at * at / 2 * bend
