"""What is new: tasks and people that a model does not know ("alien", keyposes 2009, Eqs. 15–16).

Every category k has a functional value of its own, ``F_k``: the weighted distance (Eq. 13 under the weights of Eq. 14)
of its segments of one take to the model of the others. A probe's value ``F_Pr`` to the category is compared with it:
``δ_k = (F_Pr − F_k) / (F_Pr + F_k)``, between −1 and 1. With ε_k and ε_Pr the same share ε of both values, as the paper
has it, the probe is of category k where ``|δ_k| ≤ ε``, and new where it is of none. That ε (0.05 to find the new, 0.12
to tell the task) was set by hand; it also turns away what is nearer than usual. The learned way has one side,
``δ_k ≤ ε``, with ε a quantile of the held-out takes' own δ.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, frozen
from onbeat.errors import MetricError
from onbeat.recognition.segments import Segments
from onbeat.recognition.tensor import TensorModel
from onbeat.recognition.voting import Matches

NEW_EPSILON, KNOWN_EPSILON = 0.05, 0.12
"""The paper's ε: for new people and tasks, and to tell known tasks."""
QUANTILE = 0.95
"""The share of known segments that the learned threshold accepts."""


@dataclass(frozen=True, eq=False)
class Judgement:
    """What is new among N probes.

    Parameters
    ----------
    deviations : (N, C) δ of each probe to each category.
    novelty : (N,) the least of them: the higher, the newer.
    margins : (N,) ε less the novelty: negative of what is new, by how much it is.
    candidates : of each probe the names of the categories that it can be, the nearest first; none of what is new.
    """

    deviations: Array
    novelty: Array
    margins: Array
    candidates: tuple[tuple[str, ...], ...]

    def __post_init__(self) -> None:
        for name in ("deviations", "novelty", "margins"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def known(self) -> Bools:
        """(N,) true of probes that are of a category of the model."""
        return np.asarray(self.margins >= 0)


@dataclass(frozen=True, eq=False)
class OpenSet:
    """The functional values of a mode's categories and how far from them a probe may be; made by :func:`learn`.

    Parameters
    ----------
    mode : "task", "person" or another.
    names : C categories.
    values : (C,) squared body sizes, F_k.
    epsilon : how large a deviation δ may be.
    two_sided : whether what is much nearer than F_k is turned away, too.
    """

    mode: str
    names: tuple[str, ...]
    values: Array
    epsilon: float
    two_sided: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values))

    def deviations(self, matches: Matches) -> Array:
        """(N, C) δ of probes: 0 as far as the category's own segments are, −1 on the spot, 1 infinitely far."""
        if matches.names != self.names or matches.mode != self.mode:
            raise MetricError(
                f"matches of {matches.mode} with {', '.join(matches.names)} cannot be judged by the thresholds of "
                f"{self.mode} with {', '.join(self.names)}; learn them from the model's own segments"
            )
        return (matches.values - self.values) / np.maximum(matches.values + self.values, 1e-300)

    def judge(self, matches: Matches) -> Judgement:
        """Which probes are new, and what the others can be."""
        deviations = self.deviations(matches)
        far = np.abs(deviations) if self.two_sided else deviations
        novelty = far.min(axis=1)
        order = np.argsort(matches.values, axis=1, kind="stable").tolist()
        within = far <= self.epsilon
        candidates = (tuple(self.names[k] for k in ks if on[k]) for ks, on in zip(order, within, strict=True))
        return Judgement(deviations, novelty, self.epsilon - novelty, tuple(candidates))


def learn(
    segments: Segments,
    mode: str,
    fit: Callable[[Segments], TensorModel] = TensorModel.fit,
    *,
    epsilon: float | None = None,
    quantile: float = QUANTILE,
    takes: Sequence[int] | None = None,
) -> OpenSet:
    """The open set of a model of the segments, by leaving out one take (cycle) at a time.

    Parameters
    ----------
    segments : the segments that the model is fitted to; of two takes at least.
    mode : "task" or "person".
    fit : how the model is fitted; used on all takes but one.
    epsilon : the paper's way, two-sided, with this ε; None learns it from the takes left out.
    quantile : the share of the takes left out that a learned ε accepts.
    takes : which take each segment is of; None: its cycle.

    Raises
    ------
    MetricError
        If no category has segments of two takes, or epsilon or quantile is not between 0 and 1.

    Examples
    --------
    >>> lifts = np.zeros((4, 3, 1, 3))
    >>> lifts[:, :, 0, 2] = [[0, 1, 2], [0, 1, 2.2], [2, 1, 0], [2.2, 1, 0]]
    >>> names = (("up", "up", "down", "down"), "AAAA", [0, 1, 0, 1], ("left_wrist",), [6])
    >>> known = Segments(lifts, [1.0] * 4, *names)
    >>> still = Segments(np.ones((1, 3, 1, 3)), [1.0], ("",), ("",), [0], ("left_wrist",), [6])
    >>> open_set, model = learn(known, "task"), TensorModel.fit(known)
    >>> open_set.judge(model.match(known, "task")).known.tolist(), open_set.judge(model.match(still, "task")).candidates
    ([True, True, True, True], ((),))
    """
    share = quantile if epsilon is None else epsilon
    if not 0 < share < 1:
        raise MetricError(f"{'quantile' if epsilon is None else 'epsilon'} {share} found; between 0 and 1 is needed")
    names = fit(segments).categories(mode)
    at, takes_of, own = _held_out(segments, mode, fit, np.asarray(segments.cycle if takes is None else takes), names)
    sums, counts = (np.bincount(at, weights, len(names)) for weights in (own, None))
    # A category of one take has no value of its own: it takes the mean of the others'.
    values = np.where(counts > 0, sums / np.maximum(counts, 1), own.mean())
    if epsilon is not None:
        return OpenSet(mode, names, values, epsilon, two_sided=True)
    # A take's own value is no part of what it is measured against, where there are others.
    key = at * (int(takes_of.max()) + 1) + takes_of
    others = counts[at] - np.bincount(key)[key]
    rest = (sums[at] - np.bincount(key, own)[key]) / np.maximum(others, 1)
    usual = np.where(others > 0, rest, own.mean())
    deviations = (own - usual) / np.maximum(own + usual, 1e-300)
    return OpenSet(mode, names, values, float(np.quantile(deviations, quantile)))


def _held_out(
    segments: Segments, mode: str, fit: Callable[[Segments], TensorModel], takes: Ints, names: tuple[str, ...]
) -> tuple[Ints, Ints, Array]:
    """Of each segment whose category other takes have: the category, the take, and the value to the others' model."""
    if len(takes) != len(segments):
        raise MetricError(f"{len(takes)} takes of {len(segments)} segments; one each is needed")
    found: list[tuple[Ints, Ints, Array]] = []
    for number, take in enumerate(np.unique(takes)):
        rest, probes = segments[takes != take], segments[takes == take]
        if not len(rest):
            break
        matches = fit(rest).match(probes, mode)
        category = getattr(probes, mode) if mode in ("person", "task") else ()
        at = np.array([matches.names.index(name) if name in matches.names else -1 for name in category], np.int64)
        rows = np.flatnonzero(at >= 0)
        global_at = np.array([names.index(category[row]) for row in rows], np.int64)
        found.append((global_at, np.full(len(rows), number), matches.values[rows, at[rows]]))
    if not sum(len(at) for at, _, _ in found):
        raise MetricError(
            f"no {mode} has segments of two takes; how far a {mode} is from itself takes two cycles of it at least"
        )
    at, numbers, values = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return at, numbers, values
