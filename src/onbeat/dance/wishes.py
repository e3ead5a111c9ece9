"""What a user wishes of a dance: clips never to show, clips to show rather, stretches of an earlier dance to keep."""

from __future__ import annotations

import difflib
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Bools
from onbeat.dance.document import DanceDocument
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.moves.library import Clip, MoveLibrary
from onbeat.moves.making.stretches import recording_of

FAVOURED = 0.5
"""What a second of a favourite clip earns besides, in units of a stop on its beat."""
SHORTEST = 1 / GRID
"""Seconds that a kept stretch lasts at least."""


@dataclass(frozen=True)
class Kept:
    """A stretch of an earlier dance to the same song that is to be danced again as it was.

    Parameters
    ----------
    dance : the earlier dance, as its ``dance.json`` tells it.
    from_s, to_s : seconds of the song, the same in both dances.

    Raises
    ------
    PlanError
        If the stretch does not lie in the earlier dance.

    Examples
    --------
    >>> earlier = DanceDocument(1, 60.0, 8.0, 0, "optimal", [], [], [], {})
    >>> Kept(earlier, 6.0, 9.0)
    Traceback (most recent call last):
    onbeat.errors.PlanError: cannot keep 6 to 9 s: the earlier dance lasts 8 s; give a stretch of it, beginning first
    """

    dance: DanceDocument
    from_s: float
    to_s: float

    def __post_init__(self) -> None:
        good = math.isfinite(self.from_s) and math.isfinite(self.to_s)
        if not (good and 0 <= self.from_s <= self.to_s - SHORTEST and self.to_s <= self.dance.duration + 1e-3):
            raise PlanError(
                f"cannot keep {self}: the earlier dance lasts {self.dance.duration:g} s; "
                "give a stretch of it, beginning first"
            )

    def __str__(self) -> str:
        return f"{self.from_s:g} to {self.to_s:g} s"


@dataclass(frozen=True)
class Wishes:
    """What is wished of a dance.

    A name marks a clip and its mirror image, that of a recording all stretches of it; the name of a mirror image marks
    it alone. What is forbidden and a favourite is forbidden, unless the same name says both.

    Parameters
    ----------
    forbidden : names of clips that never appear.
    favourites : names of clips that are preferred: each second of them earns ``FAVOURED``.
    kept : stretches of earlier dances that are danced again.

    Raises
    ------
    PlanError
        If a name is forbidden and a favourite.

    Examples
    --------
    >>> bool(Wishes()), bool(Wishes(forbidden=frozenset({"bow"})))
    (False, True)
    """

    forbidden: frozenset[str] = frozenset()
    favourites: frozenset[str] = frozenset()
    kept: tuple[Kept, ...] = ()

    def __post_init__(self) -> None:
        both = sorted(self.forbidden & self.favourites)
        if both:
            raise PlanError(f"clip {both[0]!r} is forbidden and a favourite; decide for one")

    def __bool__(self) -> bool:
        return bool(self.forbidden or self.favourites or self.kept)

    def marks(self, library: MoveLibrary) -> Marks:
        """Which clips of a library are meant; a ``PlanError`` says which name it does not have."""
        forbidden, favourites = (_named(library.clips, names) for names in (self.forbidden, self.favourites))
        if forbidden.all():
            raise PlanError(f"all {len(forbidden)} clips are forbidden; leave some to dance with")
        return Marks(forbidden, favourites & ~forbidden)


NO_WISHES = Wishes()
"""The dance is as the search finds it."""


@dataclass(frozen=True)
class Marks:
    """Wishes about clips, for the clips of one library.

    Parameters
    ----------
    forbidden, favourites : (clips,) true where a clip is.
    """

    forbidden: Bools
    favourites: Bools


def _named(clips: Sequence[Clip], names: frozenset[str]) -> Bools:
    """(clips,) true for those that ``names`` mean."""
    if not names:
        return np.zeros(len(clips), bool)
    known = {clip.name for clip in clips}
    for name in sorted(names - known - {recording_of(name) for name in known}):
        near = difflib.get_close_matches(name, sorted(known), 3, 0.4) or sorted(known)[:3]
        raise PlanError(
            f"no clip {name!r} among the {len(known)} of the library; there are {', '.join(map(repr, near))}, …: "
            "`onbeat moves show` lists all of a library, dance.json those of a dance"
        )
    own = [clip for clip in clips if not clip.mirrored]
    originals = {clip.source for clip in own if names & {clip.name, recording_of(clip.name)}}
    meant = [clip.name in names or clip.source in originals for clip in clips]
    return np.array(meant, bool)
