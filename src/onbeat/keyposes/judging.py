"""Which of two motions people find more like the original: trials in a drawn order, and the test of what they chose.

The paper's user study (Sec. 4.3, Table 2): the original in the middle, A and B beside it, the same motion in few
dimensions of the keypose space and of uniform sampling; 92 of 102 times keyposes were chosen.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from scipy.stats import binomtest

from onbeat.errors import MetricError
from onbeat.keyposes.decoding import decoded

VERSION = 1
SPACES = ("keyposes", "uniform")
"""What A and B are of; the first is what the test counts."""

Said = msgspec.Meta


class Trial(NamedTuple):
    """One question: the motion's name, of which space A and B are, and which stretch of the motion is shown."""

    motion: str
    a: str
    b: str
    stretch: int = 0


class Answer(msgspec.Struct, frozen=True):
    """What one person chose in one trial."""

    motion: Annotated[str, Said(description="name of the motion that was shown")]
    a: Annotated[str, Said(description="the space that A was of, `keyposes` or `uniform`")]
    b: Annotated[str, Said(description="the space that B was of")]
    chosen: Annotated[str, Said(description="`a` or `b`, whichever was found more like the original")]
    seconds: Annotated[float, Said(description="seconds it took")] = 0.0
    stretch: Annotated[int, Said(description="which stretch of the motion was shown; 0 is the cycle that taught")] = 0


class AnswersDocument(msgspec.Struct, frozen=True):
    """``answers.json``: what one person chose; the page ``judge.html`` writes it."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    dims: Annotated[int, Said(description="dimensions of the motions that were shown")]
    answers: Annotated[list[Answer], Said(description="in the order of the trials")]

    @classmethod
    def from_json(cls, data: bytes, source: str = "answers.json", page: str = "judge.html") -> AnswersDocument:
        """Read answers; a ``MetricError`` says what is wrong with them, and which ``page`` saves such files.

        Examples
        --------
        >>> AnswersDocument.from_json(b'{"version": 7}')
        Traceback (most recent call last):
        onbeat.errors.MetricError: answers.json: version 7; this onbeat reads version 1
        """
        found = decoded(data, cls, VERSION, source, f"a file of answers that {page} saved")
        for number, answer in enumerate(found.answers):
            if sorted((answer.a, answer.b)) != sorted(SPACES) or answer.chosen not in ("a", "b"):
                raise MetricError(
                    f"{source}: answer {number} chose {answer.chosen!r} of {answer.a!r} and {answer.b!r}; "
                    f"'a' or 'b' of {' and '.join(SPACES)} is expected"
                )
        return found


class Verdict(NamedTuple):
    """What the answers come to.

    ``chosen`` of ``trials`` chose keyposes; ``p`` is the chance of so one-sided a choice, or a more one-sided one, if
    people cannot tell (two-sided); ``low`` and ``high`` are the 95 % confidence interval of the true share that chooses
    keyposes (Clopper–Pearson).
    """

    chosen: int
    trials: int
    p: float
    low: float
    high: float


def trials(motions: Sequence[str], rng: np.random.Generator, repeats: int = 1) -> list[Trial]:
    """Each motion ``repeats`` times, a stretch of it each, in a drawn order; keyposes as often A as B but for one."""
    order = [(name, n) for n in range(repeats) for name in rng.permutation(np.array(motions, object)).tolist()]
    swapped = rng.permutation(np.arange(len(order)) % 2 == int(rng.integers(2)))
    return [
        Trial(name, SPACES[swap], SPACES[1 - swap], stretch)
        for (name, stretch), swap in zip(order, swapped.tolist(), strict=True)
    ]


def verdict(chosen: int, count: int) -> Verdict:
    """The exact binomial test of how often keyposes were chosen against one half.

    Raises
    ------
    MetricError
        If there is no trial, or more were chosen than there are.

    Examples
    --------
    >>> paper = verdict(92, 102)
    >>> round(paper.low, 3), round(paper.high, 3), paper.p < 1e-16
    (0.827, 0.952, True)
    """
    if not 0 <= chosen <= count or not count:
        raise MetricError(f"{chosen} of {count} answers chose keyposes; one answer at least is needed")
    test = binomtest(chosen, count, 0.5, alternative="two-sided")
    bounds = test.proportion_ci(0.95, method="exact")
    return Verdict(chosen, count, float(test.pvalue), float(bounds.low), float(bounds.high))


def verdict_of(documents: Iterable[AnswersDocument]) -> Verdict:
    """The verdict of all answers together.

    Raises
    ------
    MetricError
        If there is no answer, or not all are of motions in as many dimensions.
    """
    documents = list(documents)
    dims = sorted({document.dims for document in documents})
    if len(dims) > 1:
        raise MetricError(f"answers on motions of {' and of '.join(map(str, dims))} dimensions; judge each by itself")
    answers = [answer for document in documents for answer in document.answers]
    return verdict(
        sum((answer.a if answer.chosen == "a" else answer.b) == SPACES[0] for answer in answers), len(answers)
    )
