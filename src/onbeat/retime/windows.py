"""Where a trajectory has to be changed: stretches about its violations, wide enough to make way for them."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Bools


def windows(violated: Bools, margin: int) -> list[tuple[int, int]]:
    """Half-open stretches of places (N,): all within ``margin`` of a violated one; touching ones become one.

    Examples
    --------
    >>> windows(np.isin(np.arange(20), [3, 5, 15]), 2)
    [(1, 8), (13, 18)]
    """
    marked = np.flatnonzero(violated)
    if not len(marked):
        return []
    starts, ends = np.maximum(marked - margin, 0), np.minimum(marked + margin + 1, len(violated))
    new = np.concatenate(([True], starts[1:] > ends[:-1]))
    last = np.concatenate((new[1:], [True]))
    return list(zip(starts[new].tolist(), ends[last].tolist(), strict=True))


def widened(spans: list[tuple[int, int]], which: int, by: int, count: int) -> list[tuple[int, int]]:
    """The stretches with one of them wider by so much on either side, joined with what it now meets.

    Examples
    --------
    >>> widened([(1, 8), (13, 18)], 0, 6, 20)
    [(0, 18)]
    """
    start, end = max(spans[which][0] - by, 0), min(spans[which][1] + by, count)
    apart = [span for k, span in enumerate(spans) if k != which and (span[1] < start or span[0] > end)]
    met = [span for k, span in enumerate(spans) if k == which or not (span[1] < start or span[0] > end)]
    joined = (min(start, *(s for s, _ in met)), max(end, *(e for _, e in met)))
    return sorted([*apart, joined])
