"""The rotation that best turns one set of directions into another, and rotations over time where some are unknown."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.motion import rotations as rot


def is_seen(positions: Positions) -> Bools:
    """(...) whether each of the positions (..., 3) is a place at all."""
    return np.asarray(np.isfinite(positions).all(axis=-1))


def best_turns(local: Positions, world: Positions, weights: Array) -> tuple[Rotations, Bools]:
    """Rotations that take vectors ``local`` to ``world`` with the least squared distance (Wahba 1965, Kabsch 1976).

    ``max tr(R Σ w l mᵀ)`` by the singular values of ``B = Σ w m lᵀ``: ``R = U diag(1, 1, ±1) Vᵀ``.

    Parameters
    ----------
    local : (K, 3) or (F, K, 3).
    world : (F, K, 3); those that are NaN do not count.
    weights : (F, K) or (K,).

    Returns
    -------
    (F, 4) rotations wxyz and (F,) whether there are two directions to tell the rotation by.

    Examples
    --------
    >>> turned, good = best_turns(np.eye(3), np.eye(3)[None, [1, 0, 2]] * [[[1], [-1], [1]]], np.ones(3))
    >>> (rot.log(turned) / np.pi * 180).round(6).tolist(), good.tolist()
    ([[0.0, 0.0, 90.0]], [True])
    """
    known = is_seen(world)
    weights = np.where(known, weights, 0.0)
    vectors = np.where(known[..., None], world, 0.0) * weights[..., None]
    spread = np.swapaxes(vectors, -1, -2) @ np.broadcast_to(local, vectors.shape)
    u, s, vt = np.linalg.svd(spread)
    sign = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    u[..., 2] *= np.where(sign == 0, 1.0, sign)[..., None]
    good = s[..., 1] > 1e-3 * np.maximum(s[..., 0], 1e-12)
    return rot.from_matrix(u @ vt), good


def between_times(known: Array, rotations: Rotations, times: Array) -> Rotations:
    """Rotations (T, ..., 4) at ``times`` from those (K, ..., 4) at the times ``known``, held beyond the ends."""
    position = np.interp(times, known, np.arange(len(known), dtype=float))
    low = np.minimum(position.astype(np.int64), max(len(known) - 2, 0))
    high = np.minimum(low + 1, len(known) - 1)
    part = (position - low).reshape(-1, *[1] * (rotations.ndim - 2))
    return rot.slerp(rotations[low], rotations[high], part)


def bridge(rotations: Rotations, good: Bools) -> Rotations:
    """Rotations (F, 4) with those that are not good taken from the nearest good ones; the identity where none is."""
    frames = np.flatnonzero(good)
    if not len(frames):
        return np.tile(rot.IDENTITY, (len(rotations), 1))
    if len(frames) == len(rotations):
        return rotations
    return between_times(frames.astype(float), rotations[frames], np.arange(len(rotations), dtype=float))


def bridge_places(places: Positions, good: Bools) -> Positions:
    """Positions (F, 3) with those that are not good linear between the nearest good ones; zero where none is."""
    frames = np.flatnonzero(good)
    if not len(frames):
        return np.zeros_like(places)
    every = np.arange(len(places))
    return np.stack([np.interp(every, frames, places[frames, axis]) for axis in range(3)], axis=1)
