"""The vote of the body's elements (keyposes 2009, Eqs. 13–14): each for the category that has it nearest.

The paper's "larger sum of minimum distances" cannot be meant literally: what it describes is that every element finds
the cluster with the least distance, and the cluster that most elements, weighted, have found wins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, frozen
from onbeat.errors import MetricError

_ALIKE = 1e-9  # of the mean distance: categories that are as near share the vote


@dataclass(frozen=True, eq=False)
class Matches:
    """How well probes match the categories of a mode.

    Parameters
    ----------
    mode : "person", "task" or another.
    names : C categories.
    scores : (N, C) 0 to 1, the share of the weighted votes that each category of each probe has.
    values : (N, C) squared body sizes, the weighted mean of the elements' least distances (the functional value).
    """

    mode: str
    names: tuple[str, ...]
    scores: Array
    values: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "scores", frozen(self.scores))
        object.__setattr__(self, "values", frozen(self.values))

    def __len__(self) -> int:
        return len(self.scores)

    @property
    def order(self) -> Ints:
        """(N, C) the categories from best to worst: most votes first, of as many the nearer."""
        rounded = np.round(self.scores, 9)  # sums of the same votes in another order are the same
        return np.lexsort((self.values, -rounded), axis=-1)

    @property
    def best(self) -> tuple[str, ...]:
        """The name of each probe's best category."""
        return tuple(self.names[i] for i in self.order[:, 0].tolist())

    @property
    def nearest(self) -> tuple[str, ...]:
        """The name of the category with the least functional value, whatever the votes."""
        return tuple(self.names[i] for i in self.values.argmin(axis=-1).tolist())


def weights_by_links(links: Ints) -> Array:
    """(E,) the vote of each element, the number of its links from the body's centre; alike where all are the centre.

    Examples
    --------
    >>> weights_by_links(np.array([0, 1, 6])).tolist(), weights_by_links(np.array([0])).tolist()
    ([0.0, 1.0, 6.0], [1.0])
    """
    weights = np.asarray(links, np.float64)
    return weights if (weights > 0).any() else np.ones(len(weights))


def checked_weights(weights: Array, elements: int) -> Array:
    """The weights (E,) as shares of 1; a ``MetricError`` where one is negative or none counts."""
    weights = np.asarray(weights, np.float64)
    good = weights.shape == (elements,) and np.isfinite(weights).all() and (weights >= 0).all() and weights.any()
    if not good:
        raise MetricError(f"weights {weights.tolist()} found; {elements} numbers from 0, one above it, are needed")
    weights = weights / weights.max()
    return weights / weights.sum()


@dataclass(frozen=True, eq=False)
class Reference:
    """Cells made ready to be compared with; made by :func:`reference`.

    Parameters
    ----------
    middle : (E, D) the mean of the cells: differences from it are small, and squares of them lose no digits.
    columns : (E, D, C) the cells less the middle.
    squares : (E, C) the squared lengths of the columns.
    """

    middle: Array
    columns: Array
    squares: Array


def reference(cells: Array) -> Reference:
    """Cells (C, E, D) made ready to be compared with."""
    middle = cells.mean(axis=0)
    columns = np.ascontiguousarray((cells - middle).transpose(1, 2, 0))
    return Reference(middle, columns, np.square(columns).sum(axis=1))


def distances(probes: Array, cells: Reference) -> Array:
    """(N, E, C) squared distances of each element of probes (N, E, D) and cells, by one matrix product.

    Examples
    --------
    >>> cells = reference(np.array([[[4.0, 0.0]], [[0.0, 3.0]]]))
    >>> distances(np.array([[[0.0, 3.0]]]), cells).tolist()
    [[[25.0, 0.0]]]
    """
    rows = (probes - cells.middle).transpose(1, 0, 2)
    squares = np.square(rows).sum(axis=2)[:, :, None] + cells.squares[:, None, :] - 2.0 * (rows @ cells.columns)
    return np.maximum(squares, 0.0).transpose(1, 0, 2)


def votes(least: Array, weights: Array) -> Array:
    """(N, C) shares of the votes of elements with least distances (N, E, C); categories as near share a vote.

    Examples
    --------
    >>> votes(np.array([[[1.0, 2.0], [3.0, 0.0], [5.0, 5.0]]]), np.array([0.25, 0.5, 0.25])).tolist()
    [[0.375, 0.625]]
    """
    near = least <= least.min(axis=2, keepdims=True) + _ALIKE * least.mean(axis=2, keepdims=True)
    return np.einsum("e,nec->nc", weights, near / near.sum(axis=2, keepdims=True))
