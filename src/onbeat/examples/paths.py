"""Paths through keys: minimum-jerk moves from key to key, and the filters that give a dancer's touch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Ints, Times

CREEP = 0.12
"""The part of each move that goes on while its key is held."""


@dataclass(frozen=True)
class Keys:
    """Values (K, C) to be reached at ``times`` (K,); ``bulges`` (K, C) bend the way from a key to the next."""

    times: Times
    values: Array
    bulges: Array | None = None


def minimum_jerk(u: Array) -> Array:
    """The share of the way done at the share ``u`` of the time: ``10u³ − 15u⁴ + 6u⁵`` (Flash & Hogan 1985).

    Examples
    --------
    >>> minimum_jerk(np.array([0.0, 0.5, 1.0])).tolist()
    [0.0, 0.5, 1.0]
    """
    return u * u * u * (10.0 + u * (6.0 * u - 15.0))


def bump(u: Array) -> Array:
    """0 at both ends of 0…1 with no speed and no acceleration, 1 in the middle: ``64u³(1 − u)³``."""
    return (4.0 * u * (1.0 - u)) ** 3


def place_in(times: Times, keys: Times) -> tuple[Ints, Array]:
    """Which interval of ``keys`` each time is in, and which share 0…1 of it has passed."""
    index = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 2)
    start, end = keys[index], keys[index + 1]
    return index, np.clip((times - start) / (end - start), 0.0, 1.0)


def follow(times: Times, keys: Keys, hold: float = 0.0) -> Array:
    """The path (F, C) at ``times`` (F,): at rest at each key, minimum jerk between.

    ``hold`` is the time nearly at rest around each key, a share of the shortest interval, half of it before and half
    after, so that stops stay centred on their keys. ``CREEP`` of the way is done all the same: a body never freezes.
    """
    index, share = place_in(times, keys.times)
    spans = np.diff(keys.times)
    held = (hold * spans.min() / spans)[index]
    brisk = np.clip((share - held / 2) / (1.0 - held), 0.0, 1.0)
    values = keys.values
    done = (1.0 - CREEP) * minimum_jerk(brisk) + CREEP * minimum_jerk(share)
    path = values[index] + (values[index + 1] - values[index]) * done[:, None]
    if keys.bulges is not None:
        path += keys.bulges[index] * bump(brisk)[:, None]
    return path


def soften(path: Array, fps: float, seconds: float) -> Array:
    """The path smoothed by a Gaussian of ``seconds``: soft dancers flow through their poses."""
    return gaussian_filter1d(path, max(seconds * fps, 1e-3), axis=0, mode="nearest")


def exaggeration(path: Array, fps: float, seconds: float) -> Array:
    """What to add to a path for wind-up before and overshoot after each move: ``G½∗x − G∗x``.

    The cartoon animation filter (Wang et al. 2006) as a difference of Gaussians, G of ``seconds`` and G½ of half of
    it. It has no phase: where the path turns back at a key it is greatest on that key, so that stops stay there.
    """
    return soften(path, fps, seconds / 2) - soften(path, fps, seconds)


def follow_through(path: Array, fps: float, lag: float = 0.05) -> Array:
    """Speed of a path (F, C) as something dragged behind feels it: smoothed and ``lag`` seconds late."""
    velocity = soften(np.gradient(path, axis=0) * fps, fps, lag * 0.7)
    late = round(lag * fps)
    return np.concatenate((np.repeat(velocity[:1], late, axis=0), velocity))[: len(path)]
