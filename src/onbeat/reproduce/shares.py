"""Shares of few: in words, and whether most is more than chance."""

from __future__ import annotations

import math
from collections.abc import Sequence

from onbeat.keyposes.judging import verdict

RARE = 0.05
"""How often chance may do as well at most where most of some are said to be so."""


def by_chance(right: int, of: int) -> float:
    """How often so many or more come out right if each is right or wrong by the toss of a coin: the sign test.

    >>> by_chance(2, 3), by_chance(6, 6)
    (0.5, 0.015625)
    """
    return sum(math.comb(of, k) for k in range(right, of + 1)) / 2**of


def most(right: int, of: int) -> bool | None:
    """Whether more than half are right; None where so few do not tell it from chance, either way.

    >>> most(3, 5), most(10, 13), most(1, 9)
    (None, True, False)
    """
    if by_chance(right, of) < RARE:
        return True
    return False if by_chance(of - right, of) < RARE else None


def counted(right: int, of: int) -> str:
    """So many of so many, their share with its 95 % interval (Clopper and Pearson).

    >>> counted(3, 5)
    '3 of 5 (60%, 95 % interval 15% to 95%)'
    """
    found = verdict(right, of)
    return f"{right} of {of} ({right / of:.0%}, 95 % interval {found.low:.0%} to {found.high:.0%})"


def spread(values: Sequence[float]) -> str:
    """From the least to the most, in per cent.

    >>> spread([0.52, 0.99]), spread([1.0, 0.999])
    ('52% to 99%', '100%')
    """
    low, high = min(values), max(values)
    return f"{low:.0%}" if f"{low:.0%}" == f"{high:.0%}" else f"{low:.0%} to {high:.0%}"
