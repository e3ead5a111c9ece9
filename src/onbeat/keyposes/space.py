"""The space that keyposes span (keyposes 2009, Eqs. 4–9), and the uniform sampling it is compared with (Eqs. 10–11).

Principal components of some poses: their mean and the axes along which they differ most. Any pose is written by K′
coordinates in it and rebuilt from them. Which poses span it makes the difference: keyposes, or as many poses at equal
distances in time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import MetricError

_ALIKE = 1e-9  # of the largest singular value: what is smaller is rounding


@dataclass(frozen=True, eq=False)
class KeyposeSpace:
    """The principal components of K poses of D numbers, R of them: no more than K − 1 or D.

    Parameters
    ----------
    mean : (D,) ϖ₀, the mean pose.
    axes : (R, D) Υ, unit vectors square to each other, that of the largest variance first.
    variances : (R,) λ, the variance along each axis.
    """

    mean: Array
    axes: Array
    variances: Array

    def __post_init__(self) -> None:
        for name in ("mean", "axes", "variances"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @classmethod
    def of(cls, vectors: Array) -> KeyposeSpace:
        """The space of poses (K, D): Eqs. 4 and 5 by singular value decomposition of the poses less their mean.

        An axis points to where its largest number is positive, so that every machine gives the same.

        Raises
        ------
        MetricError
            If there are fewer than two poses, one is not finite, or all are alike.

        Examples
        --------
        >>> space = KeyposeSpace.of(np.array([[0.0, 0, 1], [2, 0, 1], [4, 0, 1], [2, 1, 1], [2, -1, 1]]))
        >>> space.axes.round(6).tolist(), space.cumulative.round(3).tolist()
        ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [0.8, 1.0])
        """
        vectors = np.asarray(vectors, np.float64)
        if vectors.ndim != 2 or len(vectors) < 2:
            raise MetricError(f"poses of shape {vectors.shape} span no space; two poses (2, 3N) at least are needed")
        if not np.isfinite(vectors).all():
            pose = int(np.argmin(np.isfinite(vectors).all(axis=1)))
            raise MetricError(f"pose {pose} of {len(vectors)} is not finite; fill the gaps of its markers first")
        mean = vectors.mean(axis=0)
        _, singular, axes = np.linalg.svd(vectors - mean, full_matrices=False)
        kept = singular > max(_ALIKE * float(singular[0]), 1e-12)
        if not kept.any():
            raise MetricError(f"all {len(vectors)} poses are alike and span no space; take poses of a moving body")
        axes = axes[kept]
        signs = np.sign(axes[np.arange(len(axes)), np.abs(axes).argmax(axis=1)])
        return cls(mean, axes * signs[:, None], singular[kept] ** 2 / len(vectors))

    def __len__(self) -> int:
        """R, how many dimensions there are."""
        return len(self.axes)

    @property
    def cumulative(self) -> Array:
        """(R,) Eq. 9: ρ, the share of the variance in the first 1, 2, … R dimensions."""
        total = np.cumsum(self.variances)
        return total / total[-1]

    def dims_for(self, rho: float) -> int:
        """The fewest dimensions K′ that hold the share ``rho`` of the variance.

        Raises
        ------
        MetricError
            If ``rho`` is not above 0 and at most 1.
        """
        if not 0.0 < rho <= 1.0:
            raise MetricError(f"a share of {rho:g} of the variance cannot be; give one above 0 and at most 1")
        return min(int(np.searchsorted(self.cumulative, rho - 1e-12)) + 1, len(self))

    def project(self, vectors: Array, dims: int) -> Array:
        """(..., K′) Eqs. 5, 7 and 10: the coordinates of poses (..., D); K′ is ``dims``, or R where that is less."""
        return (np.asarray(vectors, np.float64) - self.mean) @ self._first(dims).T

    def rebuild(self, coordinates: Array) -> Array:
        """(..., D) Eqs. 6, 8 and 11: the poses of coordinates (..., K′)."""
        return self.mean + coordinates @ self._first(coordinates.shape[-1])

    def reduced(self, vectors: Array, dims: int) -> Array:
        """(..., D) poses as they are in ``dims`` dimensions: projected and rebuilt."""
        return self.rebuild(self.project(vectors, dims))

    def _first(self, dims: int) -> Array:
        if dims < 1:
            raise MetricError(f"{dims} dimensions hold no motion; give 1 to {len(self)}")
        return self.axes[:dims]


def uniform_times(start: float, end: float, count: int, phase: float = 0.0) -> Times:
    """(count,) seconds at equal distances in a cycle from ``start`` to ``end``, which is the next cycle's start.

    ``phase`` is how far, 0…1 of their distance, the first is after the start. Any one phase may by chance hit or miss
    the keyposes; a fair comparison takes several.

    Raises
    ------
    MetricError
        If the cycle has no length, or the count is not positive.

    Examples
    --------
    >>> uniform_times(1.0, 3.0, 4).tolist(), uniform_times(1.0, 3.0, 4, 0.5).tolist()
    ([1.0, 1.5, 2.0, 2.5], [1.25, 1.75, 2.25, 2.75])
    """
    if count < 1 or not (np.isfinite(start) and np.isfinite(end) and end > start):
        raise MetricError(f"{count} poses from {start:g} to {end:g} s cannot be; give a cycle with a length")
    return start + (np.arange(count) + phase) / count * (end - start)
