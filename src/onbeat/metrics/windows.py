"""Stretches of time: the windows around joins, inside which a dance is compared with itself elsewhere."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools, Times
from onbeat.errors import MetricError

WINDOW = 0.4
"""Seconds either side of a join that belong to its window."""


def validate_joins(joins: Array) -> None:
    """Raise a ``MetricError`` unless joins are one list of finite seconds (K,), or windows (K, 2)."""
    shaped = joins.ndim == 1 or (joins.ndim == 2 and joins.shape[1] == 2)
    if not shaped or not np.isfinite(joins).all():
        raise MetricError(
            f"joins have shape {joins.shape}; finite seconds, one (K,) or a window (K, 2) each, are needed"
        )


def near_joins(times: Times, joins: Array, window: float = WINDOW) -> Bools:
    """(N,) true at the times within ``window`` seconds of a join (K,), or inside windows (K, 2) of their own.

    Examples
    --------
    >>> near_joins(np.array([0.0, 1.0, 2.0]), np.array([1.2])).tolist()
    [False, True, False]
    >>> near_joins(np.array([0.0, 1.0, 2.0]), np.array([[0.9, 2.1]])).tolist()
    [False, True, True]
    """
    joins = np.asarray(joins, np.float64)
    validate_joins(joins)
    spans = joins if joins.ndim == 2 else joins[:, None] + np.array([-window, window])
    inside = np.zeros(len(times), bool)
    for start, end in spans.tolist():
        inside |= (times >= start - 1e-9) & (times <= end + 1e-9)
    return inside


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
