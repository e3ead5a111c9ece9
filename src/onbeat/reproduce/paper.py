"""The papers there are, and what each has to be able to do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Protocol

from onbeat.errors import OnbeatError
from onbeat.reproduce.data import Data
from onbeat.reproduce.result import PaperResult

Step = Callable[[float, str], None]
"""Told while a paper is done: the share of it that is done, 0…1, and what is done now."""


class Paper(Protocol):
    """A paper whose experiments can be done again."""

    @property
    def key(self) -> str:
        """By which users name it: ``P1``."""
        ...

    @property
    def title(self) -> str:
        """The paper's title."""
        ...

    def reproduce(self, data: Data, step: Step) -> PaperResult:
        """Do the experiments and draw the figures; the same data give the same bytes."""
        ...


PAPERS = {
    "P1": ("onbeat.reproduce.p1.music_to_dance", "dancing to music, 2006"),
    "P2": ("onbeat.reproduce.p2.temporal_scaling", "the same dance to faster music, 2007"),
    "P3": ("onbeat.reproduce.p3.keyposes", "keyposes, the poses in which a dance rests, 2009"),
}
"""Of each paper by its key: the module whose ``PAPER`` it is, imported when it is asked for, and what it is about."""


def chosen(keys: Sequence[str]) -> list[str]:
    """Papers by their keys, small letters too, each once, in order; all where none is named.

    Raises
    ------
    OnbeatError
        If there is no such paper.

    Examples
    --------
    >>> chosen(["p2", "P1"]), chosen([])
    (['P1', 'P2'], ['P1', 'P2', 'P3'])
    """
    wanted = {key.upper() for key in keys} or set(PAPERS)
    unknown = [key for key in keys if key.upper() not in PAPERS]
    if unknown:
        listed = "; ".join(f"{key}: {about}" for key, (_, about) in PAPERS.items())
        raise OnbeatError(f"no paper {unknown[0]!r} can be done again; there are {listed}")
    return [key for key in PAPERS if key in wanted]


def paper(key: str) -> Paper:
    """The paper of a key."""
    return import_module(PAPERS[key][0]).PAPER
