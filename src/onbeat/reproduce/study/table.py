"""What the people of a study chose, beside Table 2 of keyposes 2009: exact binomial tests, with intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from onbeat.errors import OnbeatError
from onbeat.keyposes.judging import SPACES, Answer, Verdict, verdict
from onbeat.reproduce.result import Row, TableResult
from onbeat.reproduce.study.answers import StudyDocument

PAPER = ((32, 34), (29, 34), (31, 34))
"""How many of how many people chose keyposes, of the paper's three sequences."""
RESAMPLES = 4000
LONGEST_NAME = 60
"""Letters of a motion's name that are printed."""


class Outcome(NamedTuple):
    """What a study comes to.

    Parameters
    ----------
    sequences : of each motion, by name, how often keyposes were chosen.
    total : of all answers; as if each were somebody's only one.
    people : how many people chose keyposes more often than not, of those who did not do both as often.
    left : how often A was chosen, whatever it was: 1/2 unless people lean to a side.
    spread : (low, high) of the share that chooses keyposes, 95 %, by drawing people anew: answers of one person are
        not independent.
    """

    sequences: dict[str, Verdict]
    total: Verdict
    people: Verdict | None
    left: Verdict
    spread: tuple[float, float]


def outcome_of(document: StudyDocument) -> Outcome:
    """What the answers come to.

    Raises
    ------
    OnbeatError
        If there is no answer.

    Examples
    --------
    >>> from onbeat.reproduce.study.answers import PersonAnswers
    >>> of = lambda chosen: [Answer("bow", "keyposes", "uniform", chosen)]
    >>> people = [PersonAnswers(f"{n:016x}", of("a" if n else "b")) for n in range(8)]
    >>> found = outcome_of(StudyDocument(1, "x", 3, people))
    >>> found.total.chosen, found.total.trials, round(found.total.p, 3)
    (7, 8, 0.07)
    """
    answers = [answer for person in document.people for answer in person.answers]
    if not answers:
        raise OnbeatError("no answers; give files that study.html saved")
    names = sorted({answer.motion for answer in answers})
    own = [(sum(map(chose_keyposes, one.answers)), len(one.answers)) for one in document.people if one.answers]
    decided = [2 * right > of for right, of in own if 2 * right != of]
    return Outcome(
        {name: _verdict([answer for answer in answers if answer.motion == name]) for name in names},
        _verdict(answers),
        verdict(sum(decided), len(decided)) if decided else None,
        verdict(sum(answer.chosen == "a" for answer in answers), len(answers)),
        _resampled(np.array(own)),
    )


def chose_keyposes(answer: Answer) -> bool:
    """Whether the keyposes' motion was found more like the original."""
    return (answer.a if answer.chosen == "a" else answer.b) == SPACES[0]


def _verdict(answers: Sequence[Answer]) -> Verdict:
    return verdict(sum(map(chose_keyposes, answers)), len(answers))


def _resampled(own: np.ndarray) -> tuple[float, float]:
    """The share's 95 % interval by a bootstrap over people, of (P, 2) how often each chose keyposes, of how many."""
    drawn = own[np.random.default_rng(0).integers(0, len(own), (RESAMPLES, len(own)))].sum(axis=1)
    low, high = np.quantile(drawn[:, 0] / drawn[:, 1], [0.025, 0.975])
    return float(low), float(high)


def study_table(document: StudyDocument | None) -> TableResult:
    """Table 2: the paper's people and, where some were asked, ours."""
    found = None if document is None else outcome_of(document)
    ours = list(found.sequences.items()) if found else []
    rows: list[Row] = []
    for number in range(max(len(PAPER), len(ours))):
        name, own = ours[number] if number < len(ours) else ("", None)
        paper = verdict(*PAPER[number]) if number < len(PAPER) else None
        rows.append(_row(f"sequence {number + 1}" + (f" (ours: {_plain(name)})" if name else ""), paper, own))
    total = verdict(*(sum(column) for column in zip(*PAPER, strict=True)))
    rows.append(_row("total", total, found.total if found else None))
    if found is not None and document is not None:
        rows += _more(found, len(document.people))
    return TableResult("Table 2", "How often people chose keyposes", tuple(rows), HEADS, _remark(document))


def _plain(name: str) -> str:
    """A name as it can be printed: files come from anywhere, and what steers a terminal is left out."""
    return "".join(letter if letter.isprintable() else "?" for letter in name[:LONGEST_NAME])


HEADS = (
    "",
    "paper (95 % interval computed here)",
    "ours (95 % interval)",
    "chance of so one-sided a choice by guessing",
)


def _row(label: str, paper: Verdict | None, ours: Verdict | None) -> Row:
    chance = "; ".join(
        f"{whose} {_chance(one.p)}" for whose, one in (("paper", paper), ("ours", ours)) if one is not None
    )
    return Row(label, None if paper is None else _told(paper), "–" if ours is None else _told(ours), chance)


def _told(found: Verdict) -> str:
    share = found.chosen / found.trials
    return f"{found.chosen} / {found.trials} · {share:.0%} ({found.low:.0%}–{found.high:.0%})"


def _chance(p: float) -> str:
    return f"p = {p:.2g}" if p >= 1e-4 else f"p < 1e{np.ceil(np.log10(max(p, 1e-300))):.0f}"


def _more(found: Outcome, people: int) -> list[Row]:
    low, high = found.spread
    rows = [Row("total, people drawn anew", None, f"{low:.0%}–{high:.0%}", f"bootstrap over {people} people")]
    if found.people is not None:
        rows.append(_row("people who chose them more often than not", None, found.people))
    rows.append(_row("A chosen, whatever it was", None, found.left))
    return rows


def _remark(document: StudyDocument | None) -> str:
    told = (
        "In the paper 34 visitors of an open campus each chose once for each of three sequences; in the picture of it "
        "keyposes are A, and nothing is said of balancing sides. The test is exact, binomial, two-sided; the "
        "intervals are those of Clopper and Pearson. "
    )
    if document is None:
        return told + (
            "Nobody was asked here: study.html is ready to be opened, and `onbeat reproduce study FOLDER` serves it "
            "and gathers the answers, `onbeat reproduce study ANSWERS…` tells what they come to."
        )
    return told + f"{len(document.people)} people were asked here, in {document.dims} dimensions."
