"""Calibration: of what is said with a probability of 0.8, are eight in ten right?"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.errors import MetricError

EDGES = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0)


class Bin(NamedTuple):
    """Answers with a probability from ``low`` to ``high``: how many, what they say on average, how many are right."""

    low: float
    high: float
    answers: int
    said: float
    right: float


def reliability(said: Array, right: Bools, edges: Sequence[float] = EDGES) -> list[Bin]:
    """What was said beside what was right, in bins.

    Parameters
    ----------
    said : (N,) probabilities of the answers given.
    right : (N,) whether each is right.
    edges : of the bins, rising from 0 to 1; a bin has its upper edge, the first one its lower edge, too.

    Raises
    ------
    MetricError
        If a probability is not between the first and the last edge, or lengths differ.

    Examples
    --------
    >>> [tuple(one) for one in reliability(np.array([0.2, 0.9, 1.0]), np.array([False, True, False]), (0, 0.5, 1))]
    [(0, 0.5, 1, 0.2, 0.0), (0.5, 1, 2, 0.95, 0.5)]
    """
    if len(said) != len(right):
        raise MetricError(f"{len(said)} probabilities of {len(right)} answers; one each is needed")
    if not ((said >= edges[0]) & (said <= edges[-1])).all():
        raise MetricError(f"a probability that is not between {edges[0]:g} and {edges[-1]:g}")
    at = np.maximum(np.searchsorted(edges, said, "left") - 1, 0)
    found: list[Bin] = []
    for number, (low, high) in enumerate(pairwise(edges)):
        inside = at == number
        values = (float(part[inside].mean()) if inside.any() else float("nan") for part in (said, right))
        found.append(Bin(low, high, int(inside.sum()), *values))
    return found


def calibration_error(said: Array, right: Bools, edges: Sequence[float] = EDGES) -> float:
    """The mean distance of what is said from what is right over the bins, each by its count; 0 is honest.

    Examples
    --------
    >>> calibration_error(np.array([0.6, 0.6]), np.array([True, False]))
    0.1
    """
    bins = [one for one in reliability(said, right, edges) if one.answers]
    if not bins:
        return float("nan")
    return round(sum(one.answers * abs(one.said - one.right) for one in bins) / len(said), 12)
