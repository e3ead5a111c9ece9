"""How right found keyposes are: precision, recall and F within a tolerance, and what chance would give."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import MetricError

TOLERANCE = 0.05
"""Seconds."""


class Score(NamedTuple):
    """Shares of what was found that is true, of what is true that was found, and their harmonic mean."""

    precision: float
    recall: float
    f: float


def hits(found: Times, truth: Times, tolerance: float = TOLERANCE) -> int:
    """How many pairs of a found and a true time, each used once, are within ``tolerance`` seconds; as many as can be.

    Examples
    --------
    >>> hits(np.array([1.0, 1.04, 3.0]), np.array([1.02, 2.96]))
    2
    """
    found, truth = np.sort(found), np.sort(truth)
    count, at = 0, 0
    for time in truth:
        while at < len(found) and found[at] < time - tolerance - 1e-9:
            at += 1
        if at < len(found) and found[at] <= time + tolerance + 1e-9:
            count, at = count + 1, at + 1
    return count


def score(found: Times, truth: Times, tolerance: float = TOLERANCE) -> Score:
    """Precision, recall and F of found times.

    Raises
    ------
    MetricError
        If there is no true time, or the tolerance is not positive.

    Examples
    --------
    >>> score(np.array([1.0, 2.0]), np.array([1.01, 5.0]))
    Score(precision=0.5, recall=0.5, f=0.5)
    """
    if not len(truth) or not tolerance > 0:
        raise MetricError(f"{len(truth)} true keyposes, tolerance {tolerance} s: both have to be more than none")
    right = hits(found, truth, tolerance)
    return Score(right / len(found) if len(found) else 0.0, right / len(truth), 2.0 * right / (len(found) + len(truth)))


def chance(
    found: Times, truth: Times, span: tuple[float, float], rng: np.random.Generator, tolerance: float = TOLERANCE,
    draws: int = 200,
) -> tuple[float, float]:  # fmt: skip
    """Mean and deviation of F when what was found is shifted by a random phase, round in the span: chance."""
    start, length = span[0], max(span[1] - span[0], 1e-9)
    shifts = rng.uniform(0.0, length, draws)
    scores = [score(start + (found - start + shift) % length, truth, tolerance).f for shift in shifts]
    return float(np.mean(scores)), float(np.std(scores))
