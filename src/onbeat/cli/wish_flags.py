"""The flags with which a user says what to dance, what not, and what to keep of an earlier dance."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import cyclopts

from onbeat.errors import PlanError

if TYPE_CHECKING:
    from onbeat.dance.wishes import Kept, Wishes

LARGEST = 64 << 20
"""Bytes of a dance.json that is read."""


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class WishFlags:
    """What is wished of a dance.

    Parameters
    ----------
    without
        Names of clips that are not to appear, nor their mirror images; the name of a mirror image leaves out that
        alone.
    prefer
        Names of clips to be preferred.
    keep
        Stretches of an earlier dance to the same song to dance again, as ``dance.json:FROM-TO`` in seconds of the song.
        Another ``--seed`` dances the rest otherwise.
    """

    without: Annotated[tuple[str, ...], cyclopts.Parameter(negative="", consume_multiple=True)] = ()
    prefer: Annotated[tuple[str, ...], cyclopts.Parameter(negative="", consume_multiple=True)] = ()
    keep: Annotated[tuple[str, ...], cyclopts.Parameter(negative="", consume_multiple=True)] = ()

    def wishes(self) -> Wishes:
        """Read the earlier dances; a ``PlanError`` says what cannot be."""
        from onbeat.dance.wishes import Wishes

        return Wishes(frozenset(self.without), frozenset(self.prefer), tuple(_kept(text) for text in self.keep))


NO_WISH_FLAGS = WishFlags()
"""None was given."""


def _kept(text: str) -> Kept:
    """The stretch that ``FILE:FROM-TO`` means."""
    from onbeat.dance.document import DanceDocument
    from onbeat.dance.wishes import Kept

    name, _, span = text.rpartition(":")
    first, dash, last = span.partition("-")
    try:
        if not (name and dash):
            raise ValueError
        begin, end = float(first), float(last)
    except ValueError:
        raise PlanError(f"--keep {text!r}: give a dance.json and seconds of the song, as dance.json:12.5-20") from None
    path = Path(name)
    try:
        if path.stat().st_size > LARGEST:
            raise PlanError(f"--keep: {path} is larger than any dance.json; give one that `onbeat dance` wrote")
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        said = error.strerror if isinstance(error, OSError) else error
        raise PlanError(f"--keep: cannot read {path}: {said}; give the dance.json of an earlier dance") from None
    return Kept(DanceDocument.from_json(data, str(path)), begin, end)
