"""The joins of a library by name, for people and tables."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

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


def _place(library: MoveLibrary, frames: Ints) -> tuple[tuple[str, ...], Array]:
    clip = library.graph.clip_of[frames]
    return tuple(library.clips[k].name for k in clip.tolist()), (frames - library.starts[clip]) / GRID
