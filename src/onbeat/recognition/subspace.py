"""A learned subspace: distances in which what varies within a class weighs little, and what does not weighs much.

All elements and moments get their weights from the training segments: the covariance within classes, shrunk toward
equal variance in all directions so that directions of which few examples tell nothing are not trusted (Ledoit & Wolf
2004 for shrinkage; Friedman 1989 for its use in discriminants). The directions are those of a PCA, and what lies
outside of them counts as a direction in which nothing was ever seen to vary.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, frozen

DIMENSIONS = 96
"""Most directions that are kept."""


@dataclass(frozen=True, eq=False)
class Basis:
    """Directions in which segments differ: ``mean`` (D,) and orthonormal ``directions`` (D, K)."""

    mean: Array
    directions: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "mean", frozen(np.ascontiguousarray(self.mean)))
        object.__setattr__(self, "directions", frozen(np.ascontiguousarray(self.directions)))

    @classmethod
    def of(cls, values: Array, most: int = DIMENSIONS) -> Basis:
        """The directions of (S, D) vectors with most variance, all of them where there are few.

        Examples
        --------
        >>> Basis.of(np.array([[0.0, 0, 1], [0, 2, 1], [0, 4, 1]])).directions.round(6).ravel().tolist()
        [0.0, 1.0, 0.0]
        """
        mean = values.mean(axis=0)
        _, sizes, rows = np.linalg.svd(values - mean, full_matrices=False)
        kept = rows[:most][sizes[:most] > 1e-9 * max(float(sizes[0]), 1e-12)]
        signs = np.sign(kept[np.arange(len(kept)), np.abs(kept).argmax(axis=1)])
        return cls(mean, (kept * signs[:, None]).T)

    def coordinates(self, values: Array) -> tuple[Array, Array]:
        """(S, K) places in the basis, and (S,) the squared distance from it."""
        moved = values - self.mean
        inside = moved @ self.directions
        return inside, np.maximum((moved**2).sum(axis=1) - (inside**2).sum(axis=1), 0.0)


@dataclass(frozen=True, eq=False)
class Subspace:
    """Classes in a basis: ``centres`` (C, K) whitened, ``whitener`` (K, K), ``outside`` the weight of the rest."""

    centres: Array
    whitener: Array
    outside: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centres", frozen(np.ascontiguousarray(self.centres)))
        object.__setattr__(self, "whitener", frozen(np.ascontiguousarray(self.whitener)))

    @classmethod
    def of(cls, inside: Array, classes: Ints, count: int, shrinkage: float) -> Subspace:
        """Classes 0 … ``count`` − 1 of (S, K) coordinates; those without a member lie infinitely far away.

        The covariance is ``(1 − s) W + s t I``: W within the classes, t its mean variance.
        """
        return cls.each(inside, classes, count, (shrinkage,))[0]

    @classmethod
    def each(cls, inside: Array, classes: Ints, count: int, shrinkages: Sequence[float]) -> list[Subspace]:
        """The same for several shrinkages, which share their directions."""
        members = np.bincount(classes, minlength=count)
        sums = np.zeros((count, inside.shape[1]))
        np.add.at(sums, classes, inside)
        means = sums / np.maximum(members, 1)[:, None]
        free = len(inside) - int((members > 0).sum())
        within = inside - (means[classes] if free else inside.mean(axis=0))
        covariance = within.T @ within / max(free, 1)
        level = float(np.trace(covariance)) / max(inside.shape[1], 1) or 1.0
        variances, turn = np.linalg.eigh(covariance)
        turned, there = means @ turn, members[:, None] > 0
        found: list[Subspace] = []
        for share in shrinkages:
            wide = np.sqrt(np.maximum((1 - share) * variances, 0.0) + share * level)
            found.append(cls(np.where(there, turned / wide, np.inf), turn / wide, 1.0 / (share * level)))
        return found

    def distances(self, inside: Array, rest: Array) -> Array:
        """(P, C) from coordinates (P, K) and what lies outside (P,) to each class.

        Examples
        --------
        >>> seen = np.array([[0.0, 0], [0, 2], [4, 0], [4, 2]])
        >>> learned = Subspace.of(seen, np.array([0, 0, 1, 1]), 2, 0.1)
        >>> learned.distances(np.array([[0.0, 9]]), np.zeros(1)).round(1).tolist()  # 9 along what varies is little
        [[5.8, 13.9]]
        """
        there = np.isfinite(self.centres[:, :1]).all(axis=1)
        found = np.full((len(inside), len(self.centres)), np.inf)
        probes, centres = inside @ self.whitener, self.centres[there]
        squared = (probes**2).sum(axis=1)[:, None] + (centres**2).sum(axis=1) - 2 * probes @ centres.T
        found[:, there] = np.sqrt(np.maximum(squared, 0.0) + (rest * self.outside)[:, None])
        return found
