"""Choosing by cross-validation inside the training segments: by which views, how much shrunk, a factor is recognised.

Nothing here ever sees a probe. Each view, with each shrinkage, judges the training segments four times, held out by the
*other* factor (a task's segments by a person of whom nothing was learned, a person's in a task that was left out), by
cell (this task by this person, both known from others), by repetition (another cycle of the same cell is there), and
with all of their own class, as if they were new. The view that recognises best across the other factor and best tells
new from known is taken, then the next that makes it better, and so on. The same scores teach the threshold.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.recognition.alignment import elastic_distances
from onbeat.recognition.features import ELASTIC, FLAT, VIEWS, views_of
from onbeat.recognition.novelty import Novelty, auroc, shares, sharpness
from onbeat.recognition.segments import Segments
from onbeat.recognition.subspace import Basis, Subspace

SHRINKAGES = (0.003, 0.01, 0.03, 0.1, 0.3)
MOST_VIEWS = 3
FLOOR = 0.05
"""Of a view's usual distance: below, nearer is no longer better, lest one perfect match outweigh all other views."""
_GAIN = 1e-3  # what a further view has to add


class Option(NamedTuple):
    """A view and, for those compared in a subspace, its shrinkage."""

    view: str
    shrinkage: float = 0.0


OPTIONS = (*(Option(v, s) for v in FLAT for s in SHRINKAGES), *(Option(v) for v in ELASTIC))
USUAL = {"task": (Option("elastic course"), Option("outline", 0.03)), "person": (Option("outline", 0.03),)}
"""What is taken where the training segments leave nothing to choose by: one class, or each held by one alone."""


@dataclass(frozen=True, eq=False)
class Compared:
    """Training segments made ready for all folds: coordinates (S, K) of the flat views, distances (S, S) of others."""

    flat: dict[str, Array]
    elastic: dict[str, Array]

    @classmethod
    def of(cls, segments: Segments) -> Compared:
        """All views; the basis is a rotation learned without any label."""
        views = views_of(segments, VIEWS)
        flat = {name: Basis.of(views[name]).coordinates(views[name])[0] for name in FLAT}
        return cls(flat, {name: elastic_distances(views[name], views[name]) for name in ELASTIC})

    def distances(self, option: Option, learned: Ints, judged: Ints, classes: Ints, count: int) -> Array:
        """(P, C) of the segments ``judged`` from each class, from the segments ``learned`` alone."""
        if option.view in self.flat:
            places = self.flat[option.view]
            subspace = Subspace.of(places[learned], classes[learned], count, option.shrinkage)
            return subspace.distances(places[judged], np.zeros(len(judged)))
        return nearest(self.elastic[option.view][np.ix_(judged, learned)], classes[learned], count)


def nearest(distances: Array, classes: Ints, count: int) -> Array:
    """(P, C) the distance from each class's nearest member, from (P, R) those from all; infinite without one."""
    found = np.full((count, len(distances)), np.inf)
    np.minimum.at(found, classes, distances.T)
    return found.T


class Folds(NamedTuple):
    """(S,) the folds in which training segments are held out: by the other factor, by cell, by repetition, by class."""

    crossed: Ints
    cell: Ints
    repeated: Ints
    own: Ints


class Judged(NamedTuple):
    """Distances (S, C) that one option gives in these folds; infinite from classes of which nothing was learned."""

    crossed: Array
    cell: Array
    repeated: Array
    own: Array


class Choice(NamedTuple):
    """What was chosen and what cross-validation said of it.

    Parameters
    ----------
    options : the views taken.
    scales : of each, its usual distance from the own class.
    novelty : threshold, learned from the same scores.
    sharpness : makes shares of the scores.
    accuracy, auroc : cross-validated; NaN where there was nothing to choose by.
    """

    options: tuple[Option, ...]
    scales: tuple[float, ...]
    novelty: Novelty
    sharpness: float
    accuracy: float
    auroc: float


def combined(distances: Sequence[Array], scales: Sequence[float]) -> Array:
    """(P, C) scores of several views' distances: the mean of their logarithms, 0 where all are as usual."""
    parts = [np.log(d / scale + FLOOR) for d, scale in zip(distances, scales, strict=True)]
    return np.asarray(sum(parts) / len(parts))


def choose(compared: Compared, factor: str, classes: Ints, count: int, folds: Folds) -> Choice:
    """Choose for a factor of C = ``count`` classes, (S,) ``classes`` of the segments."""
    judged = {option: _judge(compared, option, classes, count, folds) for option in OPTIONS}
    own = np.arange(len(classes)), classes
    tried = np.isfinite(judged[OPTIONS[0]].crossed[own]) & np.isfinite(judged[OPTIONS[0]].repeated[own])
    if count < 2 or not tried.any():
        return _unchosen(judged, USUAL[factor], classes)
    scales = {o: _usual(j.repeated[own][tried]) for o, j in judged.items()}
    logs = {o: Judged(*(combined([d], [scales[o]]) for d in j)) for o, j in judged.items()}
    taken: list[Option] = []
    best = -np.inf
    while len(taken) < MOST_VIEWS:
        left = [o for o in OPTIONS if o.view not in {t.view for t in taken}]
        values = [_worth(_mean([logs[t] for t in (*taken, o)]), classes, tried) for o in left]
        if max(values) < best + _GAIN:
            break
        best = max(values)
        taken.append(left[int(np.argmax(values))])
    return _learned(_mean([logs[t] for t in taken]), tuple(taken), [scales[t] for t in taken], classes, tried)


def _judge(compared: Compared, option: Option, classes: Ints, count: int, folds: Folds) -> Judged:
    tables: list[Array] = []
    for parts in folds:
        table = np.full((len(classes), count), np.inf)
        for part in np.unique(parts).tolist():
            judged, learned = np.flatnonzero(parts == part), np.flatnonzero(parts != part)
            if len(learned):
                table[judged] = compared.distances(option, learned, judged, classes, count)
        tables.append(table)
    return Judged(*tables)


def _usual(distances: Array) -> float:
    return max(float(np.median(distances)), 1e-9)


def _mean(parts: Sequence[Judged]) -> Judged:
    return Judged(*(np.asarray(sum(tables) / len(parts)) for tables in zip(*parts, strict=True)))


def _worth(scores: Judged, classes: Ints, tried: Bools) -> float:
    """The share recognised, and how well new is told from known; how surely only where both are as good."""
    crossed, own = scores.crossed[tried], classes[tried]
    right = float((crossed.argmin(axis=1) == own).mean())
    found = auroc(scores.cell[tried].min(axis=1), scores.own.min(axis=1))
    likely = np.maximum(shares(crossed, sharpness(crossed, own))[np.arange(len(own)), own], 1e-4)
    return right + found + 0.1 * float(np.log(likely).mean())


def _learned(
    scores: Judged, options: tuple[Option, ...], scales: Sequence[float], classes: Ints, tried: Bools
) -> Choice:
    crossed, own = scores.crossed[tried], classes[tried]
    # Both are farther than a known probe will be, the one learned from fewer takes, the other without the cell.
    nearest_known = np.minimum(scores.repeated[tried].min(axis=1), scores.cell[tried].min(axis=1))
    nearest_new = scores.own.min(axis=1)
    novelty = Novelty.of(nearest_known, nearest_new)
    right = float((crossed.argmin(axis=1) == own).mean())
    return Choice(options, tuple(scales), novelty, sharpness(crossed, own), right, auroc(nearest_known, nearest_new))


def _unchosen(judged: dict[Option, Judged], options: tuple[Option, ...], classes: Ints) -> Choice:
    """The usual options; scales and threshold from what was held out, if anything was."""
    own = np.arange(len(classes)), classes
    known = [judged[o].crossed[own] for o in options]
    there = np.isfinite(known[0])
    if not there.any():
        return Choice(options, (1.0,) * len(options), Novelty(float("inf"), 1.0), 1.0, float("nan"), float("nan"))
    scales = tuple(_usual(distances[there]) for distances in known)
    novelty = Novelty.of(combined([d[there] for d in known], scales), np.zeros(0))
    return Choice(options, scales, novelty, 1.0, float("nan"), float("nan"))
