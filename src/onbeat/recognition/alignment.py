"""Elastic alignment: how far two segments are apart when each may hurry and linger (dynamic time warping in a band).

The band keeps the warp honest: a moment pairs only with moments that are near by, so that a raised hand is not warped
onto a wave. Segments are of one length already; what is left to align is early and late within them.
"""

from __future__ import annotations

import numba
import numpy as np

from onbeat._shapes import Array, Float32
from onbeat.errors import MetricError

BAND = 0.1
"""How far a moment may be moved, as a share of the segment."""


def elastic_distances(probes: Array, references: Array, band: float = BAND) -> Array:
    """(P, R) the length of the cheapest alignment of each probe with each reference.

    It is the root of the summed squared distances of all pairs of moments on the cheapest way, by steps of one moment
    on either side or both (Sakoe & Chiba 1978); with ``band`` 0 it is the Euclidean distance.

    Parameters
    ----------
    probes : (P, T, D) segments at T moments.
    references : (R, T, D) the same.
    band : share of T by which a moment may be moved, 0…1.

    Raises
    ------
    MetricError
        If the shapes do not go together.

    Examples
    --------
    >>> early = np.array([0, 1, 1, 1, 1, 1, 0.0])[None, :, None]
    >>> late = np.array([0, 0, 1, 1, 1, 1, 0.0])[None, :, None]
    >>> [round(float(elastic_distances(early, late, band)[0, 0]), 3) for band in (0.0, 0.2)]
    [1.0, 0.0]
    """
    if probes.ndim != 3 or references.ndim != 3 or probes.shape[1:] != references.shape[1:]:
        raise MetricError(f"segments of shape {probes.shape} and {references.shape} do not align; (…, T, D) is needed")
    reach = int(np.ceil(band * probes.shape[1])) if band > 0 else 0
    a, b = (np.ascontiguousarray(values, np.float32) for values in (probes, references))
    return _all_pairs(a, b, reach)


@numba.njit(cache=True, nogil=True)
def _all_pairs(probes: Float32, references: Float32, reach: int) -> Array:
    count, moments, _ = probes.shape
    found = np.empty((count, len(references)))
    before, now = np.empty(moments + 1), np.empty(moments + 1)
    for p in range(count):
        for r in range(len(references)):
            found[p, r] = _one_pair(probes[p], references[r], reach, before, now)
    return found


@numba.njit(cache=True, nogil=True, fastmath=True)
def _gap(a: Float32, b: Float32) -> float:
    total = np.float32(0.0)
    for k in range(a.shape[0]):
        step = a[k] - b[k]
        total += step * step
    return float(total)


@numba.njit(cache=True, nogil=True)
def _one_pair(a: Float32, b: Float32, reach: int, before: Array, now: Array) -> float:
    moments = a.shape[0]
    before[:] = np.inf
    before[0] = 0.0
    for i in range(moments):
        now[:] = np.inf
        for j in range(max(0, i - reach), min(moments, i + reach + 1)):
            now[j + 1] = _gap(a[i], b[j]) + min(before[j + 1], before[j], now[j])
        before[:] = now
    return float(np.sqrt(before[moments]))
