"""How a recogniser is measured: on other takes, across the factors, and on tasks and people it never saw.

Every protocol learns anew from its training segments alone and is asked about its probes once; a learner is any
function from segments to a function that answers probes, so that the same probes are put to all. Intervals are of a
bootstrap over cells (a task by a person), for takes of one cell are alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple, Protocol

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.errors import MetricError
from onbeat.recognition.novelty import auroc
from onbeat.recognition.segments import Segments

FACTORS = ("task", "person")
RESAMPLES = 1000


class Answer(Protocol):
    """What a protocol needs of a prediction; a :class:`~onbeat.recognition.recogniser.Prediction` is one."""

    @property
    def task(self) -> str:
        """The nearest known task."""
        ...

    @property
    def person(self) -> str:
        """The nearest known person."""
        ...

    @property
    def margins(self) -> tuple[float, float]:
        """How far within the thresholds of task and person the probe is; negative for new."""
        ...


Learner = Callable[[Segments, np.random.Generator], Callable[[Segments], Sequence[Answer]]]


class Score(NamedTuple):
    """``right`` of ``of`` probes; the share, and its 95 % interval."""

    right: int
    of: int
    share: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.share:.3f} ({self.low:.2f}–{self.high:.2f})"


class OpenScore(NamedTuple):
    """New told from known: the mean AUROC over what is left out; at the threshold, known and right, and new found."""

    auroc: float
    known_and_right: Score
    new_found: Score


@dataclass
class _Tally:
    """Right and wrong answers, with the cell of each."""

    right: list[Bools]
    cells: list[str]

    def add(self, right: Bools, probes: Segments) -> None:
        self.right.append(right)
        self.cells += [f"{task}\n{person}" for task, person in zip(probes.task, probes.person, strict=True)]

    def score(self) -> Score:
        return score(np.concatenate(self.right) if self.right else np.zeros(0, bool), self.cells)


def score(right: Bools, cells: Sequence[str]) -> Score:
    """The share of right answers, with a bootstrap over the cells they come from.

    Examples
    --------
    >>> print(score(np.array([True, True, True, False]), ["a", "a", "b", "b"]))
    0.750 (0.50–1.00)
    """
    if not len(right):
        return Score(0, 0, float("nan"), float("nan"), float("nan"))
    names, at = np.unique(np.asarray(cells, str), return_inverse=True)
    count, good = np.bincount(at), np.bincount(at, right)
    drawn = np.random.default_rng(0).integers(0, len(names), (RESAMPLES, len(names)))
    low, high = np.quantile(good[drawn].sum(axis=1) / count[drawn].sum(axis=1), [0.025, 0.975])
    return Score(int(right.sum()), len(right), float(right.mean()), float(low), float(high))


def known_set(
    segments: Segments, learner: Learner, rng: np.random.Generator, cycles: Sequence[int] = (0,)
) -> dict[str, Score]:
    """Task and person of other takes of known people's known tasks (Table 3): some cycles teach, the others probe."""
    teach = np.isin(segments.cycle, cycles)
    probes = _some(segments, ~teach)
    answers = learner(_some(segments, teach), rng)(probes)
    return {factor: score(_right(answers, probes, factor), _cells(probes)) for factor in FACTORS}


def crossed(segments: Segments, learner: Learner, factor: str, rng: np.random.Generator) -> Score:
    """A factor recognised across the other: tasks of a person never seen, people in a task never seen; each in turn."""
    others = labels(segments, FACTORS[factor == "task"])
    tally = _Tally([], [])
    for other in np.unique(others).tolist():
        probes = segments[others == other]
        tally.add(_right(learner(_some(segments, others != other), rng)(probes), probes, factor), probes)
    return tally.score()


def open_set(
    segments: Segments,
    learner: Learner,
    factor: str,
    rng: np.random.Generator,
    cycles: Sequence[int] = (0,),
    left_out: int = 2,
) -> OpenScore:
    """Tasks or people left out in every combination: is what is new found, and what is known still right?

    The cycles that do not teach probe: those of known classes and those of the ones left out.
    """
    own, probing = labels(segments, factor), ~np.isin(segments.cycle, cycles)
    found = _Open()
    for out in combinations(np.unique(own).tolist(), left_out):
        new = np.isin(own, out)
        answer = learner(_some(segments, ~new & ~probing), rng)
        found.add(answer, segments, new, probing, factor)
    return found.score()


def both_new(
    segments: Segments, learner: Learner, rng: np.random.Generator, cycles: Sequence[int] = (0,), left_out: int = 2
) -> dict[str, OpenScore]:
    """Tasks and people left out together, in every combination: alien probes, new in both, among known ones."""
    task, person = (labels(segments, factor) for factor in FACTORS)
    probing = ~np.isin(segments.cycle, cycles)
    found = {factor: _Open() for factor in FACTORS}
    for tasks in combinations(np.unique(task).tolist(), left_out):
        for people in combinations(np.unique(person).tolist(), left_out):
            new_task, new_person = np.isin(task, tasks), np.isin(person, people)
            answer = learner(_some(segments, ~new_task & ~new_person & ~probing), rng)
            for factor in FACTORS:
                found[factor].add(answer, segments, new_task, probing & (new_task == new_person), factor)
    return {factor: one.score() for factor, one in found.items()}


class _Open:
    """What comes together over the combinations of an open set."""

    def __init__(self) -> None:
        self.aurocs: list[float] = []
        self.known, self.new = _Tally([], []), _Tally([], [])

    def add(
        self,
        answer: Callable[[Segments], Sequence[Answer]],
        segments: Segments,
        new: Bools,
        probing: Bools,
        factor: str,
    ) -> None:
        known, alien = _some(segments, probing & ~new), _some(segments, probing & new)
        ours, theirs = answer(known), answer(alien)
        inside, outside = _margins(ours, factor), _margins(theirs, factor)
        self.aurocs.append(auroc(-inside, -outside))
        self.known.add((inside >= 0) & _right(ours, known, factor), known)
        self.new.add(outside < 0, alien)

    def score(self) -> OpenScore:
        mean = float(np.mean(self.aurocs)) if self.aurocs else float("nan")
        return OpenScore(mean, self.known.score(), self.new.score())


class PaperTables(NamedTuple):
    """The rows of Tables 3 to 5 of the paper."""

    known_task: Score
    known_person: Score
    new_task: Score
    new_person: Score
    task_of_known_person: Score
    task_of_new_person: Score


PAPER = {"known_task": (47, 48), "known_person": (42, 48), "new_task": (22, 24), "new_person": (20, 24),
         "task_of_known_person": (11, 12), "task_of_new_person": (10, 12)}  # fmt: skip
"""What the paper reports: right, of so many."""


def paper_tables(
    segments: Segments,
    learner: Learner,
    rng: np.random.Generator,
    across: Learner | None = None,
    cycles: Sequence[int] = (0,),
) -> PaperTables:
    """The paper's experiments with its sizes: 6 tasks, 8 people, one cycle to probe, in three more those new.

    Table 3: 48 probes, the first cycle that does not teach. Table 4: four tasks by four people teach, and the two
    other tasks by the four other people probe in three cycles, 24. Table 5: twelve probes of the four tasks by the
    people who teach, twelve by the others; only those taken for known and named rightly count.

    Parameters
    ----------
    segments : of 6 tasks by 8 people, in the cycles that teach and in three more.
    learner : for Tables 3 and 4.
    rng : draws who and what is left out, and which twelve probe.
    across : for Table 5, whose probes are farther away (the paper, too, set another ε); None: ``learner``.
    cycles : those that teach.

    Raises
    ------
    MetricError
        If there are not 6 tasks, 8 people and three cycles that do not teach.
    """
    people, tasks = np.unique(labels(segments, "person")), np.unique(labels(segments, "task"))
    probing = np.setdiff1d(segments.cycle, cycles)
    if (len(tasks), len(people)) != (6, 8) or len(probing) < 3:
        raise MetricError(
            f"{len(tasks)} tasks by {len(people)} people with {len(probing)} cycles to probe; "
            "the paper's tables are of 6 by 8, with 3 or more"
        )
    first = _some(segments, np.isin(segments.cycle, [*cycles, probing[0]]))
    known = known_set(first, learner, rng, cycles)
    task = np.isin(labels(segments, "task"), rng.permutation(tasks)[:4])
    person = np.isin(labels(segments, "person"), rng.permutation(people)[:4])
    teach = np.isin(segments.cycle, cycles)
    taught, asked = _some(segments, teach & task & person), np.isin(segments.cycle, probing[:3])
    alien = _some(segments, asked & ~task & ~person)
    answers = learner(taught, rng)(alien)
    new = [score(_margins(answers, factor) < 0, _cells(alien)) for factor in FACTORS]
    answer = (across or learner)(taught, rng)
    named: list[Score] = []
    for who in (person, ~person):
        at = np.flatnonzero(asked & task & who)
        probes = segments[np.sort(rng.permutation(at)[:12])]
        found = answer(probes)
        named.append(score((_margins(found, "task") >= 0) & _right(found, probes, "task"), _cells(probes)))
    return PaperTables(known["task"], known["person"], *new, *named)


def labels(segments: Segments, factor: str) -> np.ndarray:
    """(S,) the names of a factor, "task" or "person"; a ``MetricError`` for another."""
    if factor not in FACTORS:
        raise MetricError(f"no factor {factor!r}; there are {' and '.join(FACTORS)}")
    return np.asarray(segments.task if factor == "task" else segments.person, str)


def _some(segments: Segments, chosen: Bools) -> Segments:
    if not chosen.any():
        raise MetricError("no segment is left to learn from or to probe with; more takes, tasks or people are needed")
    return segments[chosen]


def _cells(segments: Segments) -> list[str]:
    return [f"{task}\n{person}" for task, person in zip(segments.task, segments.person, strict=True)]


def _right(answers: Sequence[Answer], probes: Segments, factor: str) -> Bools:
    said = [one.task if factor == "task" else one.person for one in answers]
    return np.array(said, str) == labels(probes, factor)


def _margins(answers: Sequence[Answer], factor: str) -> Array:
    return np.array([one.margins[FACTORS.index(factor)] for one in answers])
