"""The recogniser: what is danced and who dances it, or that it is something or somebody new.

Each factor has its own :class:`Expert`: the views that cross-validation chose for it (:mod:`.choice`), each as a
distance from every known class, together as one score; and the threshold beyond which the nearest class is not it. How
far known may be is a question of its own: another repetition by somebody known is near, the same task by somebody new
is farther, often as far as a new task. So what is nobody's repetition is looked at again by :class:`Across`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from onbeat._shapes import Array, Ints, frozen
from onbeat.errors import MetricError
from onbeat.recognition.alignment import elastic_distances
from onbeat.recognition.choice import Choice, Compared, Folds, Option, choose, combined, nearest
from onbeat.recognition.features import FLAT, views_of
from onbeat.recognition.folds import by_cell, by_repetition, crossing, merged, thinned
from onbeat.recognition.novelty import shares
from onbeat.recognition.segments import Segments
from onbeat.recognition.subspace import Basis, Subspace

CHOOSING, REFERENCES = 512, 1024
"""Most training segments that choices are made by, and that probes are aligned with; as many of each cell as can be."""
FEWEST, NAMED, TELLING = 3, 0.6, 0.55
"""With which :class:`Across` is kept: how many classes (of two each is the other's only stranger, and a third may lie
anywhere between), the share named right across the other factor, and the AUROC of new against known there, both
cross-validated. Dancers who cannot be told in a task of which nothing was learned have an AUROC of 0.5: everybody would
perhaps be somebody."""


class Match(NamedTuple):
    """A class, the probability that the probe is it, and whether it lies within the threshold by itself."""

    name: str
    probability: float
    within: bool


class Prediction(NamedTuple):
    """What a probe is taken for.

    Parameters
    ----------
    task, person : the nearest known ones, whether or not the probe is taken for new; "" where none were learned.
    task_scores, person_scores : all known ones, likeliest first; the probabilities and that of being new are 1.
    task_known, person_known : False for something, somebody new.
    margins : of task and person, how far within the threshold (above 0) or beyond it, in factors of e of distance.
    task_across, person_across : as the scores, were it danced by somebody new, or in a task that is new; () where that
        was not learned.
    """

    task: str
    person: str
    task_scores: tuple[Match, ...]
    person_scores: tuple[Match, ...]
    task_known: bool
    person_known: bool
    margins: tuple[float, float]
    task_across: tuple[Match, ...] = ()
    person_across: tuple[Match, ...] = ()

    @property
    def perhaps(self) -> Literal["task", "person"] | None:
        """Where both are new: whether it is a known "task" by somebody new, or a known "person" in a new task.

        The likelier of both that are near enough. It is a guess: what is new in both is often as near.
        """
        if self.task_known or self.person_known:
            return None
        task, person = (
            many[0].probability if many and many[0].within else 0.0 for many in (self.task_across, self.person_across)
        )
        return None if not max(task, person) else "task" if task >= person else "person"

    def said(self, factor: Literal["task", "person"]) -> str:
        """The name that a factor is taken for, that of a guess (:attr:`perhaps`), too; "" for new."""
        if self.task_known if factor == "task" else self.person_known:
            return self.task if factor == "task" else self.person
        return (self.task_across if factor == "task" else self.person_across)[0].name if self.perhaps == factor else ""


@dataclass(frozen=True, eq=False)
class Learned:
    """One view of a factor: a subspace of ``Basis``, or ``references`` (R, T, D) and their ``classes`` (R,)."""

    basis: Basis | None = None
    subspace: Subspace | None = None
    references: Array | None = None
    classes: Ints | None = None

    def distances(self, view: Array, count: int) -> Array:
        """(P, C) of probes from each class."""
        if self.basis is not None and self.subspace is not None:
            return self.subspace.distances(*self.basis.coordinates(view))
        if self.references is None or self.classes is None:
            raise MetricError("a view that has learned nothing; train it again")
        return nearest(elastic_distances(view, self.references), self.classes, count)


@dataclass(frozen=True, eq=False)
class Expert:
    """What was learned of a factor: its classes' names, the choice, and each chosen view."""

    names: tuple[str, ...]
    choice: Choice
    learned: tuple[Learned, ...]

    def scores(self, views: Mapping[str, Array]) -> Array:
        """(P, C) of probes, lower nearer."""
        found = [
            one.distances(views[option.view], len(self.names))
            for option, one in zip(self.choice.options, self.learned, strict=True)
        ]
        return combined(found, self.choice.scales)


class Across(NamedTuple):
    """Experts for tasks by somebody new and for persons in a new task; None where training could not try, or failed."""

    task: Expert | None = None
    person: Expert | None = None


NEAR_ONLY = Across()
"""Nothing was learned of tasks by new persons and of persons in new tasks."""


@dataclass(frozen=True, eq=False)
class Recogniser:
    """Recognises tasks and persons, each with its own expert; a factor without labels has none.

    Examples
    --------
    >>> from onbeat.recognition.features import NEEDED
    >>> rng = np.random.default_rng(0)
    >>> moves, people = rng.normal(size=(3, 1, 8, 7, 3)), rng.normal(size=(1, 4, 1, 7, 3))
    >>> places = (moves + people + [[0, 0, 0], *[[1, 0, 0], [1, 0, 9]] * 3]).reshape(12, 8, 7, 3)
    >>> places += rng.normal(size=places.shape) * 0.05
    >>> some = Segments(places, np.ones(12), [t for t in "abc" for _ in range(4)], [*"ABCD"] * 3, [0] * 12,
    ...                 (*NEEDED, "left_wrist", "right_wrist"), [0] * 7)
    >>> predictions = Recogniser.train(some, rng).predict(some)
    >>> "".join(one.task for one in predictions), "".join(one.person for one in predictions)
    ('aaaabbbbcccc', 'ABCDABCDABCD')
    """

    elements: tuple[str, ...]
    moments: int
    task: Expert | None
    person: Expert | None
    across: Across = NEAR_ONLY

    @classmethod
    def train(
        cls, segments: Segments, rng: np.random.Generator, *, across: bool = False, newcomers: bool = False
    ) -> Recogniser:
        """Learn from segments whose tasks, persons or both are known.

        All choices and thresholds come from cross-validation inside ``segments``: for tasks by leaving out persons,
        for persons by leaving out tasks, and for what is new by leaving out classes.

        Parameters
        ----------
        segments : training segments; "" where a task or a person is not known.
        rng : thins many segments and groups many folds; the same generator gives the same recogniser.
        across : how far known may be from what was learned. False: as far as another repetition by a known person
            (as another person's or task's, where nothing is repeated). True: as far as a known task by a new person,
            and a known person in a new task.
        newcomers : whether to learn how far that is as well, beside the nearer threshold: what is beyond the one and
            within the other is then a guess, :attr:`Prediction.perhaps`. All else stays as it is. Of no meaning where
            ``across`` is the threshold already.

        Raises
        ------
        MetricError
            If there is no segment, or none has a label; if an element that tells where the body faces is missing.
        """
        labelled = segments[np.array([bool(t or p) for t, p in zip(segments.task, segments.person, strict=True)], bool)]
        if not len(labelled):
            raise MetricError(f"{len(segments)} segments, none of a known task or person; label some to learn from")
        few = labelled[thinned(_cells(labelled), CHOOSING, rng)]
        with threadpool_limits(1):  # thousands of small products: threads would only wait for each other
            compared = Compared.of(few)
            same = deepcopy(rng)  # so that what is learned besides changes no draw of the others'
            task, person = (_expert(labelled, few, compared, name, across, rng) for name in ("task", "person"))
            far = NEAR_ONLY
            if newcomers and not across:
                far = Across(*(_far(labelled, few, compared, name, same) for name in Across._fields))
        return cls(segments.elements, segments.positions.shape[1], task, person, far)

    def predict(self, segments: Segments) -> list[Prediction]:
        """What each segment is taken for.

        Raises
        ------
        MetricError
            If the segments lack elements that were learned, or were read at another number of moments.
        """
        probes = self._matched(segments)
        if not len(probes):
            return []
        experts = (self.task, self.person, *self.across)
        views = views_of(probes, sorted({option.view for one in experts if one for option in one.choice.options}))
        with threadpool_limits(1):
            tables = [_answers(expert, views, len(probes)) for expert in experts]
        return [
            Prediction(
                t.name, p.name, t.matches, p.matches, t.known, p.known, (t.margin, p.margin), far.matches, away.matches
            )
            for t, p, far, away in zip(*tables, strict=True)
        ]

    def _matched(self, segments: Segments) -> Segments:
        """The segments with the elements in the order in which they were learned."""
        missing = [name for name in self.elements if name not in segments.elements]
        if missing:
            raise MetricError(
                f"the segments have no {', '.join(missing)}, by which was learned; train again on segments of the "
                f"elements that all have: {', '.join(n for n in self.elements if n in segments.elements) or 'none'}"
            )
        if segments.positions.shape[1] != self.moments:
            raise MetricError(
                f"the segments were read at {segments.positions.shape[1]} moments, those learned from at "
                f"{self.moments}; read them at as many"
            )
        at = [segments.elements.index(name) for name in self.elements]
        return Segments(
            segments.positions[:, :, at], segments.durations, segments.task, segments.person, segments.cycle,
            self.elements, segments.links[at], segments.sizes,
        )  # fmt: skip


class _Answer(NamedTuple):
    name: str
    matches: tuple[Match, ...]
    known: bool
    margin: float


def _answers(expert: Expert | None, views: Mapping[str, Array], count: int) -> list[_Answer]:
    if expert is None:
        return [_Answer("", (), False, float("nan"))] * count
    scores, novelty = expert.scores(views), expert.choice.novelty
    margins, order = novelty.margin(scores), np.argsort(scores, axis=1, kind="stable")
    chances = shares(scores, expert.choice.sharpness) * novelty.probability(scores.min(axis=1))[:, None]
    answers: list[_Answer] = []
    for row, chance, ranked in zip(margins.tolist(), chances.tolist(), order.tolist(), strict=True):
        matches = tuple(Match(expert.names[c], chance[c], row[c] >= 0) for c in ranked)
        answers.append(_Answer(matches[0].name, matches, matches[0].within, row[ranked[0]]))
    return answers


def _cells(segments: Segments) -> Ints:
    """(S,) a number for each combination of task and person."""
    pairs = list(zip(segments.task, segments.person, strict=True))
    numbers = {pair: number for number, pair in enumerate(sorted(set(pairs)))}
    return np.array([numbers[pair] for pair in pairs], np.int64)


def _labels(segments: Segments, factor: str) -> tuple[Sequence[str], Sequence[str]]:
    return (segments.task, segments.person) if factor == "task" else (segments.person, segments.task)


def _expert(
    segments: Segments, few: Segments, compared: Compared, factor: str, across: bool, rng: np.random.Generator
) -> Expert | None:
    """Learn a factor: choose by ``few``, then learn the chosen views from all that have a label."""
    labels = _labels(segments, factor)[0]
    names = tuple(sorted({label for label in labels if label}))
    if not names:
        return None
    own, others = _labels(few, factor)
    kept_few = [index for index, label in enumerate(own) if label]
    at = np.array(kept_few, np.int64)
    inner, outer = [own[i] for i in kept_few], [others[i] for i in kept_few]
    numbers, crossed = _numbers(inner, names), crossing(inner, outer, few.cycle[at], rng)
    left_out = merged(np.arange(len(names)), len(names), rng)[numbers]
    cell = crossed if across else by_cell(inner, outer, crossed, rng)
    repeated = crossed if across else by_repetition(_cells(few)[at], few.cycle[at], cell)
    folds = Folds(crossed, cell, repeated, left_out)
    choice = choose(_part(compared, at), factor, numbers, len(names), folds, repeats=across or repeated is not cell)
    kept = segments[np.array([bool(label) for label in labels], bool)]
    classes = _numbers([label for label in labels if label], names)
    return Expert(names, choice, _learn(kept, classes, len(names), choice.options, rng))


def _far(segments: Segments, few: Segments, compared: Compared, factor: str, rng: np.random.Generator) -> Expert | None:
    """A factor across the other: None where that cannot be tried, or fails."""
    pairs = [(own, other) for own, other in zip(*_labels(few, factor), strict=True) if own and other]
    if len({own for own, _ in pairs}) < FEWEST or len({other for _, other in pairs}) < 2:
        return None
    expert = _expert(segments, few, compared, factor, True, rng)
    return expert if expert and expert.choice.accuracy >= NAMED and expert.choice.auroc >= TELLING else None


def _part(compared: Compared, at: Ints) -> Compared:
    flat = {name: places[at] for name, places in compared.flat.items()}
    return Compared(flat, {name: table[np.ix_(at, at)] for name, table in compared.elastic.items()})


def _numbers(labels: Sequence[str], names: Sequence[str]) -> Ints:
    numbers = {name: number for number, name in enumerate(names)}
    return np.array([numbers[label] for label in labels], np.int64)


def _learn(
    segments: Segments, classes: Ints, count: int, options: Sequence[Option], rng: np.random.Generator
) -> tuple[Learned, ...]:
    views = views_of(segments, [option.view for option in options])
    references = thinned(_cells(segments), REFERENCES, rng)
    made: list[Learned] = []
    for option in options:
        view = views[option.view]
        if option.view in FLAT:
            basis = Basis.of(view[references])
            places, _ = basis.coordinates(view)
            made.append(Learned(basis, Subspace.of(places, classes, count, option.shrinkage)))
        else:
            made.append(Learned(references=frozen(view[references]), classes=frozen(classes[references], np.int64)))
    return tuple(made)
