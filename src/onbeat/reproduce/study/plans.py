"""The user study of keyposes 2009 (Sec. 4.3, Table 2), ready to be run with people: who is asked what, and the page.

Each person sees three dances, each as the original with the same motion in three dimensions beside it, A and B: of the
keypose space and of uniform sampling. In what the paper shows of it keyposes are A. Here which is A and which dance
comes first are balanced over the people: each person gets the next of a list of plans.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat.errors import OnbeatError
from onbeat.keyposes.judging import SPACES, Trial
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.viewer.pages.judge import judge_page

PAGE, ANSWERS = "study.html", "answers"
"""The study's page, and beside it the folder of the answers."""
SEQUENCES = 3
"""Dances that each person is asked about, as in the paper."""
BLOCKS = 8
"""How often each order of each dance comes, with either side for keyposes, before the plans begin anew."""


def plans(motions: Sequence[str], rng: np.random.Generator, blocks: int = BLOCKS) -> list[list[Trial]]:
    """What person after person is asked, each motion once.

    In every block of two times as many people as there are motions each motion comes at each place twice, once with
    keyposes as A and once as B.

    Parameters
    ----------
    motions : names, each another.
    rng : draws orders and sides.
    blocks : how many.

    Examples
    --------
    >>> six = plans(["a", "b", "c"], np.random.default_rng(0), 1)
    >>> [[trial.motion for trial in plan] for plan in six].count(["b", "c", "a"]), len(six)
    (2, 6)
    >>> [plan[0].a for plan in six].count("keyposes")
    3
    """
    made: list[list[Trial]] = []
    for _ in range(blocks):
        order = [motions[int(k)] for k in rng.permutation(len(motions))]
        sides = rng.permutation(np.arange(len(motions)) % 2 == int(rng.integers(2))).tolist()
        drawn = [(name, bool(side)) for name, side in zip(order, sides, strict=True)]
        block = [
            [_trial(name, side ^ flipped) for name, side in drawn[shift:] + drawn[:shift]]
            for shift in range(len(motions))
            for flipped in (False, True)
        ]
        made += [block[k] for k in rng.permutation(len(block)).tolist()]
    return made


def _trial(name: str, swapped: bool) -> Trial:
    return Trial(name, SPACES[swapped], SPACES[not swapped])


def study_page(found: LowDimensional, seed: int, sequences: int = SEQUENCES) -> bytes:
    """The page of a study: some of the motions, drawn by the seed, and the plans of 48 people; then they come anew.

    Raises
    ------
    OnbeatError
        If fewer motions are there than are to be shown.
    """
    people = [one.person for one in found.taught]
    if not 1 <= sequences <= len(people):
        raise OnbeatError(f"{sequences} dances cannot be shown of {len(people)}; give as many motions, or fewer dances")
    rng = np.random.default_rng(seed)
    shown = [people[k] for k in sorted(rng.permutation(len(people))[:sequences].tolist())]
    return judge_page(found, (), plans(shown, rng))
