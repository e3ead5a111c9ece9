"""Insight 1 of 2007 as numbers: how much of each layer is left at each speed.

The energy of a layer is its mean square over beats and joints. What repetitions do not share (the noise of capture,
movements that come early or late) is in it, too, so it is told apart: the product of *different* repetitions, averaged
over all pairs, holds what they share alone, without bias, and the rest is the noise.

A dance that is merely played faster has the same layers on musical time: ratios 1 and slopes 0. This holds for layers
as they are. What repetitions share falls even then, since who is late by the same time is late by more of a beat in
faster music: it says where a layer is no more than noise, not how much of it was left out.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, frozen
from onbeat.retime.takes import Repetitions

DRAWS = 1000
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Attenuation:
    """The layers of each speed.

    Parameters
    ----------
    speeds : (S,) slowest first.
    rms : (S, layers) radians, of repetitions as they are.
    shared : (S, layers) radians, of what the repetitions of a speed have in common; no number where there is one alone.
    base : place in ``speeds`` of the speed that ratios are to, the nearest to 1.
    slopes : (2, layers, 3) of ratios by speed, with the ends of their intervals; of ``rms``, of ``shared``. At -1,
        speed 1.2 has 20 % less of the layer than speed 1. No numbers where there is one speed alone, no interval where
        a speed has one repetition.
    drawn : what the intervals draw again, "takes" or "cycles".
    """

    speeds: Array
    rms: Array
    shared: Array
    base: int
    slopes: Array
    drawn: str

    def __post_init__(self) -> None:
        for name in ("speeds", "rms", "shared", "slopes"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def noise(self) -> Array:
        """(S, layers) radians, of what repetitions of a speed do not share: the floor under ``rms``."""
        return np.sqrt(np.maximum(self.rms**2 - self.shared**2, 0.0))

    @property
    def ratios(self) -> Array:
        """(2, S, layers) ``rms`` and ``shared`` beside those at the base speed."""
        return np.stack([_ratios(values, self.base) for values in (self.rms, self.shared)])


def attenuation(repetitions: Repetitions, rng: np.random.Generator, draws: int = DRAWS) -> Attenuation:
    """The layers' energies at each speed, and their slopes with intervals by drawing takes again (bootstrap).

    Cycles of a take are drawn together where every speed has two takes or more, else each by itself.
    """
    speeds = np.unique(repetitions.speeds)
    base = int(np.abs(speeds - 1.0).argmin())
    groups = [np.flatnonzero(repetitions.speeds == speed) for speed in speeds]
    by_take = all(len(np.unique(repetitions.takes[group])) > 1 for group in groups)
    units = repetitions.takes if by_take else np.arange(len(repetitions), dtype=np.int64)
    grams = [_gram(repetitions.layers[group]) for group in groups]
    once = [np.ones((1, len(group))) for group in groups]
    again = [_drawn(units[group], rng, draws) for group in groups]
    rms, shared = _energies(grams, once)
    slopes = _slopes(speeds, base, (rms, shared), _energies(grams, again))
    if min(len(np.unique(units[group])) for group in groups) < 2:
        slopes[..., 1:] = np.nan  # what is drawn again is always the same
    return Attenuation(speeds, rms[0], shared[0], base, slopes, "takes" if by_take else "cycles")


def _gram(layers: Array) -> Array:
    """(layers, n, n) mean products of repetitions, per joint and point."""
    flat = np.moveaxis(layers, 1, 0).reshape(layers.shape[1], len(layers), -1)
    return flat @ flat.transpose(0, 2, 1) / (layers.shape[2] * layers.shape[3])


def _drawn(units: Ints, rng: np.random.Generator, draws: int) -> Array:
    """(draws, n) how often each repetition is in a draw; those of one unit come together."""
    names, which = np.unique(units, return_inverse=True)
    picked = rng.integers(0, len(names), (draws, len(names)))
    return (picked[:, :, None] == np.arange(len(names))).sum(axis=1)[:, which].astype(np.float64)


def _energies(grams: list[Array], counts: list[Array]) -> tuple[Array, Array]:
    """(draws, S, layers) rms and shared rms of repetitions that are counted so often."""
    rms, shared = list[Array](), list[Array]()
    for gram, count in zip(grams, counts, strict=True):
        own = np.einsum("lnn->ln", gram)
        rms.append(count @ own.T / count.sum(axis=1, keepdims=True))
        pairs = np.einsum("dn,lnm,dm->dl", count, gram, count) - count**2 @ own.T
        number = (count.sum(axis=1) ** 2 - (count**2).sum(axis=1))[:, None]
        # A draw of one take over and over has no pairs: it tells nothing.
        shared.append(np.where(number > 0, pairs / np.maximum(number, 1.0), np.nan))
    return np.sqrt(np.stack(rms, axis=1)), np.sqrt(np.maximum(np.stack(shared, axis=1), 0.0))


def _ratios(values: Array, base: int) -> Array:
    """Values (..., S, layers) by those at the base speed; no number where there is nothing."""
    to = values[..., base : base + 1, :]
    return np.where(to > 0, values / np.where(to > 0, to, 1.0), np.nan)


def _slopes(speeds: Array, base: int, once: tuple[Array, Array], again: tuple[Array, Array]) -> Array:
    """(2, layers, 3) slopes of the ratios over the speeds, and the ends of their intervals."""
    if len(speeds) < 2:
        return np.full((2, once[0].shape[-1], 3), np.nan)
    from_mean = speeds - speeds.mean()
    weights = from_mean / (from_mean @ from_mean)
    tails = [100 * (1 - CONFIDENCE) / 2, 100 * (1 + CONFIDENCE) / 2]
    out = list[Array]()
    for values, drawn in zip(once, again, strict=True):
        slope, draws = (np.einsum("s,dsl->dl", weights, _ratios(each, base)) for each in (values, drawn))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # all draws without a number: neither has the interval
            ends = np.nanpercentile(draws, tails, axis=0)
        out.append(np.column_stack((slope[0], ends.T)))
    return np.stack(out)
