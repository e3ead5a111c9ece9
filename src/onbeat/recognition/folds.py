"""How training segments are held out of training: by the other factor, so that what is chosen holds across it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Ints

MOST_FOLDS = 12
_ROUNDS = 3


def crossing(labels: Sequence[str], others: Sequence[str], cycle: Ints, rng: np.random.Generator) -> Ints:
    """(S,) the fold of each segment: one for each value of the other factor, several in one where there are many.

    Where there is only one, by cycles; where there is one of them, too, each class's segments in turn.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> crossing(["bow", "bow", "turn"], ["Aiko", "Emi", "Aiko"], np.zeros(3, int), rng).tolist()
    [0, 1, 0]
    >>> crossing(["bow", "bow", "turn"], ["Aiko"] * 3, np.zeros(3, int), rng).tolist()
    [0, 1, 0]
    """
    for values in (np.unique(np.asarray(others, str), return_inverse=True), np.unique(cycle, return_inverse=True)):
        if len(values[0]) > 1:
            return merged(np.asarray(values[1], np.int64), len(values[0]), rng)
    turns: dict[str, int] = {}
    folds: list[int] = []
    for label in labels:
        folds.append(turns.setdefault(label, 0) % _ROUNDS)
        turns[label] += 1
    return np.array(folds, np.int64)


def by_cell(labels: Sequence[str], others: Sequence[str], otherwise: Ints, rng: np.random.Generator) -> Ints:
    """(S,) the fold of each segment: one for each cell; as ``otherwise`` where a cell is all there is of a class.

    Examples
    --------
    >>> by_cell([*"aabb"], [*"AEAE"], np.zeros(4, int), np.random.default_rng(0)).tolist()
    [0, 1, 2, 3]
    """
    pairs = list(zip(labels, others, strict=True))
    numbers = {pair: number for number, pair in enumerate(sorted(set(pairs)))}
    if len(numbers) <= len(set(labels)):
        return otherwise
    return merged(np.array([numbers[pair] for pair in pairs], np.int64), len(numbers), rng)


def by_repetition(cells: Ints, cycle: Ints, otherwise: Ints) -> Ints:
    """(S,) the fold of each segment: cells are held out cycle by cycle; as ``otherwise`` where most have but one.

    Examples
    --------
    >>> by_repetition(np.array([0, 0, 1, 1]), np.array([3, 5, 3, 4]), np.zeros(4, int)).tolist()
    [0, 1, 0, 1]
    """
    folds, several = np.zeros(len(cells), np.int64), 0
    for cell in range(int(cells.max()) + 1):
        at = np.flatnonzero(cells == cell)
        found, place = np.unique(cycle[at], return_inverse=True)
        folds[at] = place % _ROUNDS
        several += len(at) if len(found) > 1 else 0
    return folds if 2 * several > len(cells) else otherwise


def merged(groups: Ints, count: int, rng: np.random.Generator, most: int = MOST_FOLDS) -> Ints:
    """Groups 0 … count − 1 put together at random until there are no more than ``most``."""
    if count <= most:
        return groups
    return (rng.permutation(count) % most)[groups]


def thinned(cells: Ints, most: int, rng: np.random.Generator) -> Ints:
    """Indices, in order, of at most ``most`` segments: as many of each cell (task by person) as can be.

    Examples
    --------
    >>> thinned(np.array([0, 0, 0, 0, 0, 1]), 2, np.random.default_rng(0)).tolist()[-1]
    5
    """
    if len(cells) <= most:
        return np.arange(len(cells))
    mixed = rng.permutation(len(cells))
    order = mixed[np.argsort(cells[mixed], kind="stable")]
    starts = np.searchsorted(cells[order], cells[order], "left")
    place = np.arange(len(cells)) - starts
    return np.sort(order[np.argsort(place, kind="stable")[:most]])
