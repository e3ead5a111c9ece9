"""How fast takes of one dance are, from the tempo of their beats."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array

ALIKE = 1.05
"""Tempi that are less than this factor above the slowest of a group are of its speed."""


def speeds_from(tempi: Array) -> Array:
    """Speeds (N,) of takes by their tempi (N,), 1 for the slowest; tempi that are alike are one speed.

    Examples
    --------
    >>> speeds_from(np.array([104.2, 124.0, 103.8, 125.1])).tolist()
    [1.0, 1.2, 1.0, 1.2]
    """
    order = np.argsort(tempi, kind="stable")
    groups: list[list[int]] = []
    for take in order.tolist():
        if not groups or tempi[take] > ALIKE * tempi[groups[-1][0]]:
            groups.append([])
        groups[-1].append(take)
    out = np.ones(len(tempi))
    for group in groups:
        out[group] = round(float(np.median(tempi[group]) / np.median(tempi[groups[0]])), 2)
    return out
