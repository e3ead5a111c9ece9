"""Cells: who dances what, as a table with one mean segment in each, and what to put where nobody danced.

A cell is a person and a task (and a cycle, a tempo, … where more modes are asked for). Few archives have all: the
missing cells are filled by :func:`filled` before the table is decomposed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, frozen
from onbeat.errors import MetricError

SHRINKAGE = 0.1
"""As if so many cells of each person and of each task had nothing of their own."""
_MOST = 1 << 28  # numbers of a table: 2 GB


@dataclass(frozen=True, eq=False)
class Cells:
    """A table of mean values.

    Parameters
    ----------
    values : (D, n₁, n₂, …) the mean of each cell's vectors, 0 in cells that are not seen.
    counts : (n₁, n₂, …) how many vectors are in each cell.
    modes : the names of the modes after the first, such as ("person", "task").
    names : of each of them, its categories.
    """

    values: Array
    counts: Ints
    modes: tuple[str, ...]
    names: tuple[tuple[str, ...], ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values))
        object.__setattr__(self, "counts", frozen(self.counts, np.int64))

    @property
    def seen(self) -> Bools:
        """(n₁, n₂, …) true where there is at least one vector."""
        return np.asarray(self.counts > 0)


def cells_of(vectors: Array, factors: Mapping[str, Sequence[str]]) -> Cells:
    """The mean of the vectors (S, D) in each cell; ``factors`` says for each mode the category of each vector.

    Categories are in the order of their names, whatever the order of the vectors.

    Raises
    ------
    MetricError
        If there is no vector or no mode, a category is not known (""), or the table would be huge.

    Examples
    --------
    >>> table = cells_of(np.array([[1.0], [3.0], [9.0]]), {"person": "AAB", "task": "xxy"})
    >>> table.values[0].tolist(), table.seen.tolist(), table.names
    ([[2.0, 0.0], [0.0, 9.0]], [[True, False], [False, True]], (('A', 'B'), ('x', 'y')))
    """
    if not len(vectors) or not factors:
        raise MetricError(f"{len(vectors)} segments in a table of {len(factors)} modes; one of each is needed at least")
    for mode, given in factors.items():
        if len(given) != len(vectors):
            raise MetricError(f"{len(given)} names of mode {mode} for {len(vectors)} segments; one each is needed")
        if "" in (given := list(given)):
            raise MetricError(f"the {mode} of segment {given.index('')} is not known; leave it out of training")
    names = tuple(tuple(sorted(set(given))) for given in factors.values())
    shape = tuple(len(of) for of in names)
    if np.prod([float(n) for n in (vectors.shape[1], *shape)]) > _MOST:
        raise MetricError(f"a table of {' × '.join(map(str, shape))} cells is too large; train on fewer categories")
    places = [
        [{n: i for i, n in enumerate(of)}[g] for g in given] for of, given in zip(names, factors.values(), strict=True)
    ]
    cell = np.ravel_multi_index(np.array(places, np.int64), shape)
    counts = np.bincount(cell, minlength=int(np.prod(shape)))
    sums = np.zeros((len(counts), vectors.shape[1]))
    np.add.at(sums, cell, vectors)
    means = sums / np.maximum(counts, 1)[:, None]
    return Cells(means.T.reshape(-1, *shape), counts.reshape(shape), tuple(factors), names)


def filled(cells: Cells, shrinkage: float = SHRINKAGE) -> Array:
    """(D, n₁, n₂, …) the table with its missing cells filled; cells that are seen stay as they are.

    A missing cell is what is common plus what is the person's plus what is the task's (and so on for each mode), by
    least squares over the cells that are seen. Each effect is drawn towards 0 as if ``shrinkage`` more cells of it had
    none, so that a person with one cell, or one that shares no task with any other, does not lead astray. (Cutting the
    rank and filling in again and again came out worse: with few categories there are too many ways to fill.)

    Raises
    ------
    MetricError
        If the shrinkage is negative or not a number.

    Examples
    --------
    >>> table = cells_of(np.array([[1.0], [2.0], [5.0]]), {"person": "AAB", "task": "xyx"})
    >>> filled(table, shrinkage=0.0)[0].round(6).tolist()  # B is 4 more than A, y is 1 more than x
    [[1.0, 2.0], [5.0, 6.0]]
    """
    if not (np.isfinite(shrinkage) and shrinkage >= 0):
        raise MetricError(f"a shrinkage of {shrinkage} found; 0 or more is needed")
    return cells.values if cells.seen.all() else _added(cells, shrinkage)


def _added(cells: Cells, shrinkage: float) -> Array:
    shape, seen = cells.counts.shape, cells.seen.ravel()
    places = np.indices(shape).reshape(len(shape), -1)
    design = np.concatenate(
        [np.ones((1, len(seen))), *(np.eye(n)[at].T for n, at in zip(shape, places, strict=True))]
    ).T
    known = design[seen]
    # The common part is not drawn to 0; 1e-9 chooses one of the equally good answers.
    ridge = np.diag(np.concatenate([[1e-9], np.full(known.shape[1] - 1, shrinkage + 1e-9)]))
    values = cells.values.reshape(len(cells.values), -1)
    effects = np.linalg.solve(known.T @ known + ridge, known.T @ values[:, seen].T)
    return np.where(seen, values, (design @ effects).T).reshape(-1, *shape)
