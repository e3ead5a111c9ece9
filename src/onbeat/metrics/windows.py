"""Stretches of time: the windows around joins, inside which a dance is compared with itself elsewhere."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.errors import MetricError

WINDOW = 0.4
"""Seconds either side of a join that belong to its window."""


def validate_joins(joins: Times) -> None:
    """Raise a ``MetricError`` unless joins are one list of finite seconds."""
    if joins.ndim != 1 or not np.isfinite(joins).all():
        raise MetricError(f"joins have shape {joins.shape}; one list of finite seconds, (K,), is needed")


def near_joins(times: Times, joins: Times, window: float = WINDOW) -> Bools:
    """(N,) true at the times within ``window`` seconds of a join.

    Examples
    --------
    >>> near_joins(np.array([0.0, 1.0, 2.0]), np.array([1.2])).tolist()
    [False, True, False]
    """
    joins = np.asarray(joins, np.float64)
    validate_joins(joins)
    if not len(joins):
        return np.zeros(len(times), bool)
    return np.abs(times[:, None] - joins[None]).min(axis=1) <= window + 1e-9


def statistic(values: Array, which: str) -> float | None:
    """``median``, ``mean``, ``p95`` or ``max`` of the numbers among the values; None where there are none."""
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    if which == "p95":
        return float(np.percentile(values, 95))
    return float({"median": np.median, "mean": np.mean, "max": np.max}[which](values))


def ratio(value: float | None, to: float | None) -> float | None:
    """``value / to``; None where either is missing or ``to`` is nothing."""
    return None if value is None or to is None or to < 1e-9 else value / to
