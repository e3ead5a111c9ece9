"""Takes that are there twice, such as one in two formats: they would be seen twice in a dance."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from onbeat._shapes import Float32

# Two clips are one if they last as long to so many frames, their poses are so near and their changes so correlated.
SAME_LENGTH, SAME_POSES, ALIKE = 2, 0.25, 0.8
LOOKS = 32  # frames of a clip that are compared first
PART = 64  # clips compared at a time with all others


def find_twins(lengths: Sequence[int], poses: Callable[[int], Float32]) -> dict[int, int]:
    """For each clip that moves as an earlier one does, all along, which that is.

    All are compared in a few frames first, so that clips are read in full only where these agree.

    Parameters
    ----------
    lengths : graph frames of each clip.
    poses : gives the (n, D) pose vectors of a clip.

    Examples
    --------
    >>> walk = np.cumsum(np.random.default_rng(0).normal(size=(90, 5)), axis=0).astype(np.float32)
    >>> clips = [walk, walk[::-1], walk[:89] + 0.01]
    >>> find_twins([len(clip) for clip in clips], lambda n: clips[n])
    {2: 0}
    """
    twins: dict[int, int] = {}
    for earlier, later in _suspects(lengths, poses):
        if earlier not in twins and later not in twins and _are_one(poses(earlier), poses(later)):
            twins[later] = earlier
    return twins


def _suspects(lengths: Sequence[int], poses: Callable[[int], Float32]) -> Iterator[tuple[int, int]]:
    """Pairs of clips that agree in half of some frames, in order of the later one."""
    if not lengths:
        return
    counts = np.array(lengths)
    seen = np.stack([_looks(poses(n)) for n in range(len(counts))], axis=1)  # looks × clips × D
    for start in range(0, len(counts), PART):
        later = np.arange(start, min(start + PART, len(counts)))
        near = _near(seen[:, later], seen[:, : later[-1] + 1])
        alike = np.abs(counts[later, None] - counts[None, : later[-1] + 1]) <= SAME_LENGTH
        for row, column in np.argwhere(near & alike):
            if column < later[row]:
                yield int(column), int(later[row])


def _looks(poses: Float32) -> Float32:
    return poses[np.round(np.linspace(0, max(len(poses) - 1 - SAME_LENGTH, 0), LOOKS)).astype(np.int64)]


def _near(some: Float32, others: Float32) -> np.ndarray:
    """(some, others) true where half of the frames looked at are as near as those of one take, or almost."""
    squares = np.einsum("kid,kid->ki", some, some)[:, :, None] + np.einsum("kid,kid->ki", others, others)[:, None]
    apart = squares - 2 * some @ others.transpose(0, 2, 1)
    return (apart < (2 * SAME_POSES) ** 2).sum(axis=0) >= LOOKS // 2


def _are_one(one: Float32, two: Float32) -> bool:
    size = min(len(one), len(two))
    one, two = one[:size], two[:size]
    apart = float(np.median(np.linalg.norm(one - two, axis=1)))
    changes = [np.diff(poses, axis=0).ravel() for poses in (one, two)]
    if apart >= SAME_POSES or min(float(np.ptp(change)) for change in changes) == 0:
        return False  # one that stands still correlates with none
    return bool(np.corrcoef(changes[0], changes[1])[0, 1] > ALIKE)
