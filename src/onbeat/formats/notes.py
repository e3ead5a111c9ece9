"""What a reader guessed about a file and why, for whoever asks.

Files leave things open: their unit, their up axis, their rate, what a gap held. A reader tells what it took them for;
nothing is printed unless somebody listens with :func:`noted`. What a user has to know even without asking is a warning.
"""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple


class Note(NamedTuple):
    """What is told about (``unit``, ``up``, ``fps``, ``gaps``, …), what it was taken for, and why."""

    about: str
    taken: str
    why: str


_listening: ContextVar[list[Note] | None] = ContextVar("notes", default=None)


def tell(about: str, taken: object, why: str) -> None:
    """Tell those who listen."""
    notes = _listening.get()
    if notes is not None:
        notes.append(Note(about, str(taken), why))


@contextmanager
def noted() -> Generator[list[Note]]:
    """Listen to all notes told within.

    Examples
    --------
    >>> with noted() as notes:
    ...     tell("unit", "cm", "the body spans 190 of them")
    >>> notes[0].taken
    'cm'
    """
    notes: list[Note] = []
    token = _listening.set(notes)
    try:
        yield notes
    finally:
        _listening.reset(token)
