"""Higher-order singular value decomposition: a tensor as a core times one orthonormal matrix a mode (Eq. 12).

``P = Q ×₁ S₁ ×₂ S₂ … ×ₙ Sₙ``. The columns of S_m are the left singular vectors of the tensor's unfolding along mode m
(De Lathauwer, De Moor & Vandewalle 2000). At full rank the product gives the tensor back; with fewer columns it gives
nearly the nearest tensor of those ranks (within √n of the least error).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.errors import MetricError

_NOTHING = 1e-13  # of the strongest singular value


@dataclass(frozen=True, eq=False)
class Hosvd:
    """A tensor of n modes, decomposed.

    Parameters
    ----------
    core : (r₁, …, rₙ) Q, how the modes act on each other.
    factors : n matrices S_m (d_m, r_m) with orthonormal columns, the strongest first.
    """

    core: Array
    factors: tuple[Array, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "core", frozen(self.core))
        object.__setattr__(self, "factors", tuple(frozen(factor) for factor in self.factors))

    def tensor(self) -> Array:
        """(d₁, …, dₙ) the product of core and factors."""
        return self.product(self.factors)

    def product(self, factors: Sequence[Array]) -> Array:
        """The core times other matrices (·, r_m), one a mode: mode vectors that are swapped or mixed."""
        found = self.core
        for mode, factor in enumerate(factors):
            found = mode_product(found, factor, mode)
        return found


def unfold(tensor: Array, mode: int) -> Array:
    """(d_m, product of the others) the tensor's fibres along a mode, side by side."""
    return np.moveaxis(tensor, mode, 0).reshape(tensor.shape[mode], -1)


def mode_product(tensor: Array, matrix: Array, mode: int) -> Array:
    """``tensor ×_mode matrix``: every fibre along the mode is multiplied by the matrix (k, d_m).

    Examples
    --------
    >>> mode_product(np.arange(6.0).reshape(1, 2, 3), np.array([[1.0, 1.0]]), 1).tolist()
    [[[3.0, 5.0, 7.0]]]
    """
    return np.moveaxis(np.tensordot(matrix, tensor, axes=(1, mode)), 0, mode)


def hosvd(tensor: Array, ranks: Sequence[int | None] | None = None) -> Hosvd:
    """Decompose a tensor; of each mode ``ranks`` columns are kept, all where it is None or asks for more.

    Columns that the tensor does not use (singular values of nothing but rounding) are never kept: they are by chance.

    Raises
    ------
    MetricError
        If the tensor has no mode or no number in it, or one that is not finite, or a rank is below 1 or missing.

    Examples
    --------
    >>> tensor = np.random.default_rng(0).normal(size=(6, 3, 4))
    >>> bool(np.allclose(hosvd(tensor).tensor(), tensor)), hosvd(tensor, (2, None, 9)).core.shape
    (True, (2, 3, 4))
    """
    tensor = np.asarray(tensor, np.float64)
    if not tensor.ndim or not tensor.size or not np.isfinite(tensor).all():
        raise MetricError(f"a tensor of shape {tensor.shape} that is all numbers is needed; fill missing cells first")
    ranks = [None] * tensor.ndim if ranks is None else list(ranks)
    if len(ranks) != tensor.ndim or any(rank is not None and rank < 1 for rank in ranks):
        raise MetricError(f"ranks {tuple(ranks)} of a tensor of {tensor.ndim} modes; one each is needed, 1 or more")
    factors = [_columns(unfold(tensor, mode))[:, :rank] for mode, rank in enumerate(ranks)]
    core = tensor
    for mode, factor in enumerate(factors):
        core = mode_product(core, factor.T, mode)
    return Hosvd(core, tuple(factors))


def _columns(unfolding: Array) -> Array:
    """The left singular vectors, of each the largest number positive: the same whatever library computes them."""
    size = max(float(np.abs(unfolding).max()), 1e-300)
    columns, strengths, _ = np.linalg.svd(unfolding / size, full_matrices=False)
    columns = columns[:, : max(1, int(np.sum(strengths > _NOTHING * strengths[0])))]
    largest = np.take_along_axis(columns, np.abs(columns).argmax(axis=0)[None], axis=0)
    return columns * np.where(largest < 0, -1.0, 1.0)
