"""Who dances what (keyposes 2009, Sec. 5): Tables 3 to 5, by the multi-factor tensor as published, and ours.

The tasks are six pieces of the folk dance from a keypose to the next, danced by eight people in five cycles, as many as
the paper has. How unlike oneself a dancer is from cycle to cycle nobody knows of the paper's eight; here it is a
number, and all tables are told for four values of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array
from onbeat.recognition.hard_troupe import hard_pieces
from onbeat.recognition.open_set import KNOWN_EPSILON, NEW_EPSILON, OpenSet, learn
from onbeat.recognition.protocols import FACTORS, PAPER, Answer, Learner, PaperTables, Score, known_set, paper_tables
from onbeat.recognition.recogniser import Recogniser
from onbeat.recognition.segments import Segments
from onbeat.recognition.tensor import TensorModel
from onbeat.reproduce.paper import Step
from onbeat.reproduce.result import Claim, Row, TableResult
from onbeat.reproduce.shares import spread

HARDNESS = (0.0, 0.25, 0.5, 1.0)
"""How unlike themselves dancers are from cycle to cycle: each number of their style varies by as much of its spread
among the eight. Above 0 every cycle is danced in a body drawn from all eight, and keyposes are early or late."""
DRAWS = 5
"""How often it is all done anew, danced anew and with others left out."""
TAKES, TEACH = 5, (0, 1)
"""Cycles that are danced, and those that teach: one for the tensor, another for what is usual."""
TABLES = {
    "Table 3": ("Known tasks by known people", {"known_task": "task", "known_person": "person"}),
    "Table 4": ("New tasks by new people", {"new_task": "task found new", "new_person": "person found new"}),
    "Table 5": ("Known tasks, by known and by new people",
                {"task_of_known_person": "task, known person", "task_of_new_person": "task, new person"}),
}  # fmt: skip
"""The paper's tables: what each is of, and its rows by the fields of :class:`PaperTables`."""


class Said(NamedTuple):
    """What the tensor says of a probe."""

    task: str
    person: str
    margins: tuple[float, float]


def as_published(epsilon: float) -> Learner:
    """The paper's recogniser: the vote of the body's elements, and the share ε within which a probe is known."""

    def train(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Sequence[Answer]]:
        model = TensorModel.fit(segments)
        judges = {factor: learn(segments, factor, epsilon=epsilon) for factor in FACTORS}
        return lambda probes: _answers(model, judges, probes)

    return train


def _answers(model: TensorModel, judges: Mapping[str, OpenSet], probes: Segments) -> list[Said]:
    matches = {factor: model.match(probes, factor) for factor in FACTORS}
    margins = [judges[factor].judge(matches[factor]).margins.tolist() for factor in FACTORS]
    names = [matches[factor].best for factor in FACTORS]
    return [Said(task, person, (a, b)) for task, person, a, b in zip(*names, *margins, strict=True)]


def ours(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Sequence[Answer]]:
    """Our recogniser: how segments are looked at, and what is new, is learned by cross-validation."""
    return Recogniser.train(segments, rng).predict


def ours_across(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Sequence[Answer]]:
    """Ours, made to tell tasks of people whom it does not know."""
    return Recogniser.train(segments, rng, across=True).predict


Found = Mapping[float, Sequence[tuple[PaperTables, PaperTables]]]
"""By hardness, of every draw what is right as published, and by ours."""


def recognised(seed: int, step: Step, draws: int = DRAWS, hardness: Sequence[float] = HARDNESS) -> Found:
    """The paper's experiments by both recognisers, on the same segments and probes."""
    found: dict[float, list[tuple[PaperTables, PaperTables]]] = {hard: [] for hard in hardness}
    pairs = [(hard, draw) for hard in hardness for draw in range(draws)]
    for number, (hard, draw) in enumerate(pairs):
        step(number / len(pairs), "recognising")
        rng = np.random.default_rng((seed, draw))
        segments = hard_pieces(hard, rng, takes=TAKES)
        literal, loose = as_published(NEW_EPSILON), as_published(KNOWN_EPSILON)
        drawn = int(rng.integers(2**32))  # who is left out, the same for both
        found[hard].append(
            (
                paper_tables(segments, literal, np.random.default_rng(drawn), loose, TEACH),
                paper_tables(segments, ours, np.random.default_rng(drawn), ours_across, TEACH),
            )
        )
    return found


def recognition_tables(found: Found) -> tuple[TableResult, ...]:
    """Tables 3, 4 and 5."""
    remarks = (
        "At full rank the tensor is the nearest neighbour by elements of the body. Pieces of a dance are known again "
        "whoever dances them; who it is depends on how alike a dancer's cycles are, and on the body, which is another "
        "each time above 0. How alike the cycles of the paper's eight are nobody knows.",
        "As published a probe counts as known if its distance is within 5% of that of another cycle of the same. "
        "Hardly anything is, so that what is new is found; what that costs Table 5 shows.",
        "As published with 12% in place of 5%; “learned” is ours. Only what is taken for known and named rightly "
        "counts. So narrow a width turns away most of what is known; it is set by hand.",
    )
    draws = len(next(iter(found.values())))
    times = (
        f" Sums of {draws} draws, each of as many probes as the paper has; in brackets the least and the most of them."
    )
    return tuple(
        TableResult(
            number,
            title,
            tuple(_row(found, hard, field, label) for field, label in fields.items() for hard in found),
            ("right of so many", "paper", "ours: as published", "ours: learned", "unlike themselves"),
            remark + (times if draws > 1 else ""),
        )
        for (number, (title, fields)), remark in zip(TABLES.items(), remarks, strict=True)
    )


def _row(found: Found, hard: float, field: str, label: str) -> Row:
    right, of = PAPER[field]
    literal, learned = ([getattr(pair[which], field) for pair in found[hard]] for which in (0, 1))
    words = {0.0: "0: all cycles alike", 1.0: "1: as one is unlike another"}.get(hard, f"{hard:g}")
    return Row(label, f"{right} / {of} · {right / of:.0%}", _told(literal), words, (_told(learned),))


def _told(scores: Sequence[Score]) -> str:
    right, of = (sum(getattr(one, name) for one in scores) for name in ("right", "of"))
    least, most = (pick(one.share for one in scores) for pick in (min, max))
    return f"{right} / {of} · {right / of:.0%}" + (f" ({100 * least:.0f}–{most:.0%})" if least < most else "")


CLAIMED = (
    ("The tensor tells tasks that it knows", ("known_task",), "", "", ("Table 3",)),
    (
        "It tells people whom it knows",
        ("known_person",),
        "",
        " How alike the cycles of the paper's dancers are is not known.",
        ("Table 3",),
    ),
    (
        "It finds tasks and people that are new",
        ("new_task", "new_person"),
        " But most of what is known is taken for new, too: see the next.",
        "",
        ("Table 4",),
    ),
    (
        "It tells known tasks, of known people and of new ones",
        ("task_of_known_person", "task_of_new_person"),
        "",
        " Distances vary by more than 12% either way from cycle to cycle, and most of what is known is turned away.",
        ("Table 5",),
    ),
)
"""What the paper says, the rows that decide it, what is said of it where it holds, and where it does not always, and
the table of all."""


def recognition_claims(found: Found) -> tuple[Claim, ...]:
    """What the paper says of the tensor; what holds of some dancers only is left open."""
    return tuple(_claim(found, *one) for one in CLAIMED)


def _claim(found: Found, words: str, fields: Sequence[str], more: str, why: str, see: tuple[str, ...]) -> Claim:
    paper = [PAPER[field] for field in fields]
    shares = np.array([[[_mean(pairs, which, f) for f in fields] for pairs in found.values()] for which in (0, 1)])
    holds = (shares[0] >= [right / of - NEAR for right, of in paper]).all(axis=1)
    learned = spread(shares[1].ravel().tolist())
    told = f"As published {_by_dancers(shares[0], list(found), holds.tolist())}; learned {learned}."
    return Claim(
        f"{words} ({' and '.join(f'{right} of {of}' for right, of in paper)}).",
        bool(holds[0]) if (holds == holds[0]).all() else None,
        told + (more if holds.all() else why),
        see,
    )


def _by_dancers(shares: Array, hardness: Sequence[float], holds: Sequence[bool]) -> str:
    """How much is right (H, fields), and for which dancers that is as much as in the paper."""
    told = f"{spread(shares.ravel().tolist())} are right"
    if all(holds) or not any(holds):
        return f"{told}, however unlike themselves dancers are"
    good, bad = (
        " and ".join(f"{h:g}" for h, held in zip(hardness, holds, strict=True) if held is w) for w in (True, False)
    )
    return f"{told}: about as in the paper for dancers unlike themselves by {good}, not by {bad}"


def _mean(pairs: Sequence[tuple[PaperTables, PaperTables]], which: int, field: str) -> float:
    return float(np.mean([getattr(pair[which], field).share for pair in pairs]))


NEAR = 0.1
"""How far under the paper's share a claim still counts as holding."""


def known_in_files(segments: Segments, seed: int) -> tuple[TableResult, tuple[Claim, ...]]:
    """Table 3 on segments of one's own: the first take of everything teaches, the others are asked about."""
    rows: list[Row] = []
    claims: list[Claim] = []
    first = int(segments.cycle.min())
    scores = [known_set(segments, learner, np.random.default_rng(seed), (first,)) for learner in (_vote, ours)]
    for factor in FACTORS:
        right, of = PAPER[f"known_{factor}"]
        literal, learned = (_told([one[factor]]) for one in scores)
        rows.append(Row(factor, f"{right} / {of} · {right / of:.0%}", literal, "other takes of the same", (learned,)))
        said = f"{CLAIMED[FACTORS.index(factor)][0]} ({right} of {of})."
        holds = scores[0][factor].share >= right / of - NEAR
        claims.append(Claim(said, holds, f"As published {literal}; learned {learned}.", ("Table 3",)))
    table = TableResult(
        "Table 3",
        "Known tasks by known people",
        tuple(rows),
        ("right of so many", "paper", "ours: as published", "ours: learned", "note"),
        f"{len(segments)} segments of {len(set(segments.task))} tasks by {len(set(segments.person))} people. Tables 4 "
        "and 5 are of six tasks by eight people in five cycles and are made of the embedded troupe alone.",
    )
    return table, tuple(claims)


def _vote(segments: Segments, rng: np.random.Generator) -> Callable[[Segments], Sequence[Answer]]:
    """The tensor's vote where there is but one take: nothing tells what is new."""
    model = TensorModel.fit(segments)

    def answer(probes: Segments) -> list[Said]:
        names = [model.match(probes, factor).best for factor in FACTORS]
        return [Said(task, person, (0.0, 0.0)) for task, person in zip(*names, strict=True)]

    return answer
