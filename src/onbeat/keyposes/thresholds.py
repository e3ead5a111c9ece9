"""Learning T1 and T2 from dances whose keyposes are marked (keyposes 2009, Secs. 3.1 and 3.3, Figs. 4 and 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_cdt

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import MetricError
from onbeat.keyposes.candidates import Thresholds
from onbeat.keyposes.extract import Reading
from onbeat.keyposes.matching import TOLERANCE, Score, score

GRID = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
"""Values of either threshold that are tried, in units of the mean energy: the papers' range, finer where it matters."""
PLATEAU = 0.02
"""How far under the best F still counts as the plateau."""


@dataclass(frozen=True)
class Example:
    """A dance whose keyposes are known.

    Parameters
    ----------
    reading : of the motion with its beats.
    truth : (K,) seconds of its keyposes.
    name : for messages.
    """

    reading: Reading
    truth: Times
    name: str = ""


@dataclass(frozen=True)
class Sweep:
    """Scores over T1 and T2.

    Parameters
    ----------
    t1, t2 : (A,) and (B,) in units of the mean energy.
    scores : (E, A, B, 3) precision, recall and F of each example.
    """

    t1: Array
    t2: Array
    scores: Array

    def __post_init__(self) -> None:
        for name in ("t1", "t2", "scores"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def f(self) -> Array:
        """(A, B) mean F of the examples."""
        return self.scores[..., 2].mean(axis=0)

    def best(self) -> Thresholds:
        """The middle of the widest region with an F within ``PLATEAU`` of the highest, so that little depends on it."""
        good = self.f >= self.f.max() - PLATEAU
        inside = np.asarray(distance_transform_cdt(np.pad(good, 1), metric="chessboard"))[1:-1, 1:-1]
        deepest = inside == inside.max()
        a, b = np.unravel_index(int(np.where(deepest, self.f, -1.0).argmax()), self.f.shape)
        return Thresholds(float(self.t1[a]), float(self.t2[b]))

    def plateau(self, at: Thresholds | None = None) -> tuple[tuple[float, float], tuple[float, float]]:
        """From where to where T1 and T2 may go, the other one held, with an F within ``PLATEAU`` of the highest."""
        at = self.best() if at is None else at
        a, b = int(np.abs(self.t1 - at.t1).argmin()), int(np.abs(self.t2 - at.t2).argmin())
        good = self.f >= self.f.max() - PLATEAU
        return _stretch(self.t1, good[:, b], a), _stretch(self.t2, good[a], b)


def _stretch(values: Array, good: np.ndarray, at: int) -> tuple[float, float]:
    """The values around one, as far as they are good."""
    bad_before, bad_after = np.flatnonzero(~good[:at]), np.flatnonzero(~good[at:])
    first = int(bad_before[-1]) + 1 if len(bad_before) else 0
    last = at + (int(bad_after[0]) - 1 if len(bad_after) else len(values) - 1 - at)
    return float(values[first]), float(values[max(last, first)])


def sweep(
    examples: Sequence[Example],
    t1: Sequence[float] = GRID,
    t2: Sequence[float] = GRID,
    tolerance: float = TOLERANCE,
) -> Sweep:
    """Scores of every pair of thresholds on every example.

    Raises
    ------
    MetricError
        If there is no example, or one has no keypose.
    """
    if not examples:
        raise MetricError("no example to learn from: give motions with their keyposes marked")
    for example in examples:
        if not len(example.truth):
            raise MetricError(f"{example.name or 'an example'} has no keypose marked")
    values = [
        [[score(e.reading.keyposes(Thresholds(a, b)).times, e.truth, tolerance) for b in t2] for a in t1]
        for e in examples
    ]
    return Sweep(np.array(t1), np.array(t2), np.array(values, np.float64))


@dataclass(frozen=True)
class Learned:
    """Thresholds, and how well they do on dances that they were not learned from.

    Parameters
    ----------
    thresholds : learned from all examples.
    held_out : precision, recall and F, the mean over examples of thresholds learned from the others; of a single
        example, over its halves.
    plateau : from where to where T1 and T2 may go.
    """

    thresholds: Thresholds
    held_out: Score
    plateau: tuple[tuple[float, float], tuple[float, float]]


def learn(examples: Sequence[Example], tolerance: float = TOLERANCE) -> Learned:
    """Thresholds of the highest F, cross-validated by leaving out one example, or one half of the only one.

    Raises
    ------
    MetricError
        If there is no example, one has no keypose, or a single one has fewer than four.
    """
    whole = sweep(examples, tolerance=tolerance)
    parts = whole if len(examples) > 1 else _halves(examples[0], tolerance)
    held = []
    for out in range(len(parts.scores)):
        rest = np.delete(parts.scores, out, axis=0)
        chosen = Sweep(parts.t1, parts.t2, rest).best()
        a, b = int(np.flatnonzero(parts.t1 == chosen.t1)[0]), int(np.flatnonzero(parts.t2 == chosen.t2)[0])
        held.append(parts.scores[out, a, b])
    return Learned(whole.best(), Score(*(float(v) for v in np.mean(held, axis=0))), whole.plateau())


def _halves(example: Example, tolerance: float) -> Sweep:
    """The two halves of one example as two, each with as many keyposes."""
    if len(example.truth) < 4:
        raise MetricError(f"{example.name or 'the example'}: {len(example.truth)} keyposes; four are needed to learn")
    order = np.sort(example.truth)
    middle = float(order[len(order) // 2 - 1 : len(order) // 2 + 1].mean())
    rows = []
    for first, last in ((-np.inf, middle), (middle, np.inf)):
        truth = order[(order >= first) & (order < last)]
        cells = []
        for a in GRID:
            found = [example.reading.keyposes(Thresholds(a, b)).times for b in GRID]
            cells.append([score(one[(one >= first) & (one < last)], truth, tolerance) for one in found])
        rows.append(cells)
    return Sweep(np.array(GRID), np.array(GRID), np.array(rows, np.float64))
