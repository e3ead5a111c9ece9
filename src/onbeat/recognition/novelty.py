"""New or known: the threshold beyond which a probe is nobody's, and what a distance is worth as a probability.

Both are learned from scores that cross-validation inside the training segments gives (never from a probe): those of
segments whose own class was there ("known") and those of the same segments when all of their class was left out
("new"). The threshold is the quantile of the known ones at which, of both kinds, most are told right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints

QUANTILES = np.arange(0.80, 0.996, 0.005)
"""The shares of known segments that may lie within the threshold; 0.95 where training has nothing new to try."""
_USUAL = 0.95
MISSED = 0.05
"""The share of new segments that may be taken for known where it is not known how near the known ones are."""
_SHARPNESS = np.geomspace(0.25, 64.0, 33)


@dataclass(frozen=True)
class Novelty:
    """A score above ``threshold`` is new; ``slope`` turns the margin into log odds."""

    threshold: float
    slope: float

    @classmethod
    def of(cls, known: Array, new: Array, *, bound: bool = False) -> Novelty:
        """Learn from cross-validated scores (K,) of known and (N,) of new segments, lower nearer.

        Without known ones nothing can be called new: the threshold is infinite.

        Parameters
        ----------
        known, new : scores, of any number.
        bound : whether ``known`` is only a bound, for what will be asked about is nearer by an unknown amount. Then the
            threshold is set from the other side, where all but ``MISSED`` of the new ones lie beyond it, if that is
            lower; but never so low that half of ``known`` do.

        Examples
        --------
        >>> learned = Novelty.of(np.linspace(0, 1, 101), np.linspace(2, 3, 101))
        >>> 0.9 < learned.threshold < 1.0, learned.known(np.array([0.5, 2.5])).tolist()
        (True, [True, False])
        """
        known, new = known[np.isfinite(known)], new[np.isfinite(new)]
        if not len(known):
            return cls(float("inf"), 1.0)
        limits = np.quantile(known, QUANTILES)
        threshold = float(np.quantile(known, _USUAL))
        if len(new):
            right = (known[:, None] <= limits).mean(axis=0) + (new[:, None] > limits).mean(axis=0)
            best = np.flatnonzero(right >= right.max() - 1e-9)
            threshold = float(limits[best[-1]])
            if bound:
                threshold = min(threshold, max(float(np.quantile(new, MISSED)), float(np.median(known))))
        return cls(threshold, _slope(threshold - known, new - threshold))

    def margin(self, scores: Array) -> Array:
        """How far within the threshold: above 0 known, below 0 new."""
        return self.threshold - scores

    def known(self, scores: Array) -> Bools:
        """Whether each score is a known class's."""
        return self.margin(scores) >= 0

    def probability(self, scores: Array) -> Array:
        """That the class is a known one, 0.5 at the threshold."""
        return 1 / (1 + np.exp(-np.clip(self.slope * self.margin(scores), -50, 50)))


def one_more(scores: Array) -> Array:
    """(S,) the least of scores (S, C) as it would be among one class more.

    A segment whose class was left out has one class fewer to be near to than a new one will have. The least of n random
    distances falls as a power of n, so its logarithm, which scores are, falls with log n: by what one class more has
    brought (the second least less the least, in one of n draws), less than that for the next.

    >>> one_more(np.array([[0.0, 0.3, 1.0, np.inf]])).round(3).tolist()  # the infinite one is its own
    [-0.071]
    """
    ordered = np.sort(scores, axis=1)
    count = np.isfinite(ordered).sum(axis=1)
    several, found = count > 1, ordered[:, 0].copy()
    if several.any():
        n = count[several]
        step = ordered[several, 1] - ordered[several, 0]
        found[several] -= step / n * np.log1p(1 / n) / -np.log1p(-1 / n)
    return found


def _slope(known: Array, new: Array) -> float:
    """The slope under which the margins of both kinds, each kind counting half, are most likely."""
    kinds = [kind for kind in (known, new) if len(kind)]
    losses = [sum(np.logaddexp(0, -slope * kind).mean() for kind in kinds) for slope in _SHARPNESS]
    return float(_SHARPNESS[int(np.argmin(losses))])


def sharpness(scores: Array, own: Ints) -> float:
    """The factor k under which ``softmax(−k scores)`` makes the true classes most likely.

    Parameters
    ----------
    scores : (S, C) of each segment for each class, lower nearer; infinite where a class was not to be had.
    own : (S,) the true class.
    """
    if len(scores) == 0 or scores.shape[1] < 2:
        return 1.0
    losses = [
        -np.log(np.maximum(shares(scores, k)[np.arange(len(own)), own], 1e-12)).mean() for k in _SHARPNESS
    ]  # fmt: skip
    return float(_SHARPNESS[int(np.argmin(losses))])


def shares(scores: Array, factor: float) -> Array:
    """(S, C) ``softmax(−factor · scores)``: how the probability of being known at all is shared by the classes.

    >>> shares(np.array([[0.0, np.log(3.0), np.inf]]), 1.0).round(2).tolist()
    [[0.75, 0.25, 0.0]]
    """
    odds = np.exp(-factor * (scores - scores.min(axis=1, keepdims=True)))
    return odds / odds.sum(axis=1, keepdims=True)


def auroc(known: Array, new: Array) -> float:
    """The chance that a new one's score is above a known one's, ties a half; NaN where one kind is missing.

    >>> auroc(np.array([0.0, 1.0]), np.array([1.0, 2.0]))
    0.875
    """
    if not len(known) or not len(new):
        return float("nan")
    ordered = np.sort(known)
    below = np.searchsorted(ordered, new, "left") + np.searchsorted(ordered, new, "right")
    return float(below.mean() / (2 * len(known)))
