"""The joins of a library by name, for people and tables."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

LOOKED_AT = 100
"""Clips up to which all joins of a library are looked at."""
PART = 1 << 16  # joins whose links are compared at a time: 50 MB


class Joins(NamedTuple):
    """Columns of a table with one row a join, in order of the frame it leaves.

    Parameters
    ----------
    leave, leave_s : name of the clip that is left, and the second of it.
    enter, enter_s : name of the clip that is entered, and the second of it.
    distance : of the two poses (see ``poses``).
    link_error : degrees, mean angle between the links of the two poses.
    """

    leave: tuple[str, ...]
    leave_s: Array
    enter: tuple[str, ...]
    enter_s: Array
    distance: Array
    link_error: Array


def joins_table(library: MoveLibrary) -> Joins:
    """Which clips the joins of a library link, where, and how well they fit."""
    leave, enter = library.graph.sources, library.graph.targets
    from_clip, from_s = _place(library, leave)
    to_clip, to_s = _place(library, enter)
    parts = [slice(first, first + PART) for first in range(0, len(leave), PART)]
    error = np.concatenate([np.zeros(0), *(library.link_errors(leave[part], enter[part]) for part in parts)])
    return Joins(from_clip, from_s, to_clip, to_s, library.graph.costs.astype(np.float64), error)


def mean_link_error(library: MoveLibrary) -> float | None:
    """Degrees, mean of the joins' links; none where there is no join.

    Of a great library only the joins between ``LOOKED_AT`` clips, evenly chosen, are looked at.
    """
    leave, enter = library.graph.sources, library.graph.targets
    if len(library.clips) > LOOKED_AT:
        chosen = np.zeros(len(library.clips), np.bool_)
        chosen[np.linspace(0, len(chosen) - 1, LOOKED_AT).astype(np.int64)] = True
        both = np.flatnonzero(chosen[library.graph.clip_of[leave]] & chosen[library.graph.clip_of[enter]])
        leave, enter = leave[both], enter[both]
    parts = [slice(first, first + PART) for first in range(0, len(leave), PART)]
    errors = [library.link_errors(leave[part], enter[part]) for part in parts]
    return float(np.concatenate(errors).mean()) if errors else None


def _place(library: MoveLibrary, frames: Ints) -> tuple[tuple[str, ...], Array]:
    clip = library.graph.clip_of[frames]
    return tuple(library.clips[k].name for k in clip.tolist()), (frames - library.starts[clip]) / GRID
