"""Choosing by cross-validation inside the training segments: by which views, how much shrunk, a factor is recognised.

Nothing here ever sees a probe. Each view, with each shrinkage, judges the training segments four times, held out by the
*other* factor (a task's segments by a person of whom nothing was learned, a person's in a task that was left out), by
cell (this task by this person, both known from others), by repetition (another cycle of the same cell is there), and
with all of their own class, as if they were new. The view that recognises best across the other factor and again, and
best tells new from known, is taken, then the next that makes it better, and so on. The same scores teach the threshold
and how sure an answer is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Ints
from onbeat.recognition.alignment import elastic_distances
from onbeat.recognition.features import ELASTIC, FLAT, VIEWS, views_of
from onbeat.recognition.novelty import Novelty, auroc, one_more, shares, sharpness
from onbeat.recognition.segments import Segments
from onbeat.recognition.subspace import Basis, Subspace

SHRINKAGES = (0.003, 0.01, 0.03, 0.1, 0.3)
MOST_VIEWS = 3
ONCE, SURE, LEAST = ("outline", "elastic course"), 0.8, 0.01
"""Where persons danced everything once and less than SURE of them are known across tasks, the views they are taken by:
only what is compared with the very cell can tell them then, and folds without repetitions cannot try that. What varies
from day to day was not seen, so shrinkage is not less than LEAST."""
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

    def distances(self, view: str, learned: Ints, judged: Ints, classes: Ints, count: int) -> list[Array]:
        """(P, C) of segments ``judged`` from each class, from those ``learned`` alone, for each option of a view."""
        if view in self.flat:
            places = self.flat[view]
            rest = np.zeros(len(judged))
            return [
                subspace.distances(places[judged], rest)
                for subspace in Subspace.each(places[learned], classes[learned], count, SHRINKAGES)
            ]
        return [nearest(self.elastic[view][np.ix_(judged, learned)], classes[learned], count)]


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


def choose(compared: Compared, factor: str, classes: Ints, count: int, folds: Folds, *, repeats: bool = True) -> Choice:
    """Choose for a factor of C = ``count`` classes, (S,) ``classes`` of the segments.

    Parameters
    ----------
    repeats : whether the folds by repetition show how near a known probe will be. Where they do not, for everything was
        danced once, persons who are not known across tasks either are taken by ``ONCE``, and the threshold is set by
        what is new.
    """
    judged: dict[Option, Judged] = {}
    for view in VIEWS:
        judged |= _judge(compared, view, classes, count, folds)
    own = np.arange(len(classes)), classes
    tried = np.isfinite(judged[OPTIONS[0]].crossed[own]) & np.isfinite(judged[OPTIONS[0]].repeated[own])
    if count < 2 or not tried.any():
        return _unchosen(judged, USUAL[factor], classes)
    scales = {o: _usual(j.repeated[own][tried]) for o, j in judged.items()}
    trial = _Trial({o: Judged(*(combined([d], [scales[o]]) for d in j)) for o, j in judged.items()}, classes, tried)
    taken = _greedy(trial)
    if factor == "person" and not repeats and trial.accuracy(taken) < SURE:
        taken = _once(trial)
    return _learned(trial, taken, [scales[t] for t in taken], repeats)


@dataclass(frozen=True, eq=False)
class _Trial:
    """Scores of all options in the folds, the classes, and which segments have both kinds of known score."""

    logs: dict[Option, Judged]
    classes: Ints
    tried: Bools

    def scores(self, options: Sequence[Option]) -> Judged:
        parts = [self.logs[option] for option in options]
        return Judged(*(np.asarray(sum(tables) / len(parts)) for tables in zip(*parts, strict=True)))

    def accuracy(self, options: Sequence[Option]) -> float:
        """Recognised across the other factor."""
        return _right(self.scores(options).crossed[self.tried], self.classes[self.tried])

    def worth(self, options: Sequence[Option]) -> float:
        """The shares recognised across and again, and how well new is told from known; how surely where all is even."""
        scores, own = self.scores(options), self.classes[self.tried]
        crossed, repeated = scores.crossed[self.tried], scores.repeated[self.tried]
        found = auroc(scores.cell[self.tried].min(axis=1), scores.own.min(axis=1))
        likely = np.maximum(shares(crossed, sharpness(crossed, own))[np.arange(len(own)), own], 1e-4)
        return _right(crossed, own) + _right(repeated, own) + found + 0.1 * float(np.log(likely).mean())


def _right(scores: Array, own: Ints) -> float:
    return float((scores.argmin(axis=1) == own).mean())


def _best(trial: _Trial, taken: Sequence[Option], left: Sequence[Option]) -> tuple[float, Option]:
    values = [trial.worth((*taken, option)) for option in left]
    at = int(np.argmax(values))
    return values[at], left[at]


def _greedy(trial: _Trial) -> tuple[Option, ...]:
    """The best view, then the next that makes it better, and so on."""
    taken: list[Option] = []
    best = -np.inf
    while len(taken) < MOST_VIEWS:
        value, option = _best(trial, taken, [o for o in OPTIONS if o.view not in {t.view for t in taken}])
        if value < best + _GAIN:
            break
        best = value
        taken.append(option)
    return tuple(taken)


def _once(trial: _Trial) -> tuple[Option, ...]:
    """``ONCE``, shrunk as is best of what is not less than ``LEAST``."""
    taken: list[Option] = []
    for view in ONCE:
        left = [o for o in OPTIONS if o.view == view and (o.view in ELASTIC or o.shrinkage >= LEAST)]
        taken.append(_best(trial, taken, left)[1])
    return tuple(taken)


def _judge(compared: Compared, view: str, classes: Ints, count: int, folds: Folds) -> dict[Option, Judged]:
    """What each option of a view gives in all folds."""
    options = [option for option in OPTIONS if option.view == view]
    tables = np.full((len(options), len(folds), len(classes), count), np.inf)
    for kind, parts in enumerate(folds):
        for part in np.unique(parts).tolist():
            judged, learned = np.flatnonzero(parts == part), np.flatnonzero(parts != part)
            if len(learned):
                tables[:, kind, judged] = compared.distances(view, learned, judged, classes, count)
    return {option: Judged(*of) for option, of in zip(options, tables, strict=True)}


def _usual(distances: Array) -> float:
    return max(float(np.median(distances)), 1e-9)


def _learned(trial: _Trial, options: tuple[Option, ...], scales: Sequence[float], repeats: bool) -> Choice:
    scores, tried = trial.scores(options), trial.tried
    crossed, own = scores.crossed[tried], trial.classes[tried]
    # Both are farther than a known probe will be, the one learned from fewer takes, the other without the cell.
    nearest_known = np.minimum(scores.repeated[tried].min(axis=1), scores.cell[tried].min(axis=1))
    # What other classes are as near without the segment's own, as seen in the same folds by the same measure: left out
    # with all of its class, it would be measured by fewer segments than a new one will be, and look farther.
    others = scores.cell.copy()
    others[np.arange(len(others)), trial.classes] = np.inf
    nearest_new = one_more(others)
    novelty = Novelty.of(nearest_known, nearest_new, bound=not repeats)
    told = auroc(nearest_known, nearest_new)
    # Shared as surely as a probe's will be told: known from another take, or across where that is what is known.
    sure = sharpness(scores.repeated[tried], own)
    return Choice(options, tuple(scales), novelty, sure, _right(crossed, own), told)


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
