"""Stretches of frames of which something is true."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Bools


def runs(mask: Bools) -> list[tuple[int, int]]:
    """First frame and frame after the last of each stretch of true frames.

    Examples
    --------
    >>> runs(np.array([True, False, True, True]))
    [(0, 1), (2, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
