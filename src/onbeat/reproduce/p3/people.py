"""Whose dances few dimensions are made of (keyposes 2009, Sec. 4): one dance, one motion of each person."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from onbeat._shapes import Times
from onbeat.errors import OnbeatError
from onbeat.keyposes.extract import find_keyposes
from onbeat.keyposes.lowdim import LowDimensional, low_dimensional
from onbeat.motion import Motion
from onbeat.reproduce.data import Data
from onbeat.reproduce.p3.dances import Danced, embedded_dances
from onbeat.reproduce.p3.files import Take, keyposes_of, one_dance, takes_of

DIMS = 3
"""The paper's K′: three suffice to look right."""
FOLK, IN_CYCLE = "folk dance", 8
"""The dance that stands for Aizu-bandaisan, and how many keyposes a cycle of both has."""


class People(NamedTuple):
    """Motions of one dance, one of each person, with their keyposes.

    Parameters
    ----------
    motions : of each person.
    keyposes : (K,) seconds of each motion's.
    names : of the people.
    cycle : keyposes in a cycle of the dance; None where it is not known.
    """

    motions: list[Motion]
    keyposes: list[Times]
    names: list[str]
    cycle: int | None

    def spaces(self) -> LowDimensional:
        """Their dance in three dimensions, or in as many as the keyposes span."""
        most = len(self.names) * min(len(times) for times in self.keyposes) - 1
        dims = max(1, min(DIMS, most))
        return low_dimensional(self.motions, self.keyposes, self.names, dims=dims, cycle=self.cycle)


def of_dances(dances: Sequence[Danced]) -> People:
    """The folk dance of the embedded troupe; its keyposes are those found while it is danced, as in the paper."""
    some = [one for one in dances if one.dance == FOLK]
    keyposes: list[Times] = []
    for one in some:
        found = find_keyposes(one.motion, one.beats)
        keyposes.append(found.times[(found.beats >= one.first) & (found.beats < one.end)])
    return People([one.motion for one in some], keyposes, [one.person for one in some], IN_CYCLE)


def of_takes(takes: Sequence[Take]) -> People:
    """One dance of some files, its first take by each person.

    Raises
    ------
    OnbeatError
        If it is danced by one person alone, or somebody has too few keyposes.
    """
    some = one_dance(list(takes))
    if len(some) < 2:
        raise OnbeatError(
            f"{some[0].person} alone dances {some[0].task!r}; a keypose space is of several people: give a file of each"
        )
    return People([t.motion for t in some], [keyposes_of(t) for t in some], [t.person for t in some], None)


def people_of(data: Data) -> People:
    """Of the embedded troupe, or of the given files."""
    if data.embedded:
        return of_dances(embedded_dances(data.seed, names=(FOLK,)))
    return of_takes(takes_of(data))
