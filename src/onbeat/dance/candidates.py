"""Which part of a great library is worth searching: stretches that a beam of partial dances passes through.

The beam walks the whole motion graph at playback rate 1, joining where the graph joins, but it only ever looks at the
joins of the frames it stands on: what it costs depends on its width and on the song. Partial dances are compared by

    gain(t) − κ Σ_{s<t} u(s) + the best prospect of going on in the clip,

u(s) the most that any dance can earn at song frame s (:mod:`onbeat.dance.bound`) and κ the share of it that dances do
earn: so a dance that has earned what it could is not held against one that is about to. What joins do to stops is not
looked at. The stretches through which the best partial dances of each moment pass, and the way to them, are the part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array, Float32
from onbeat.dance.beam import mark_ways, walk
from onbeat.dance.bound import most_earned
from onbeat.dance.frames import lay_frames
from onbeat.dance.optimal import HOLD
from onbeat.dance.part import Part
from onbeat.dance.score import Music
from onbeat.dance.wished import Wished
from onbeat.moves.library import MoveLibrary

WIDTH = 400
"""Partial dances that are kept at each song frame."""
SHARE = 0.7
"""κ: what dances earn of the most that there is to be earned."""


@dataclass(frozen=True, eq=False)
class Field:
    """A library and a song as the beam sees them: frames at playback rate 1.

    Parameters
    ----------
    intensity, idle : (N,) as in ``score.Frames``.
    left : (N,) frames of the same clip that follow.
    stops, shifts : frames with a stop, and when after the frame.
    next_stop : (N,) place in ``stops`` of the first at a frame or after it.
    spent : (T + 1,) κ u summed up to each song frame.
    """

    intensity: Float32
    idle: Float32
    left: NDArray[np.int32]
    stops: NDArray[np.int32]
    shifts: NDArray[np.int32]
    next_stop: NDArray[np.int32]
    spent: Array
    music: Music

    @classmethod
    def of(cls, library: MoveLibrary, music: Music, wished: Wished | None = None) -> Field:
        """Read off the whole library; poses and motions are not touched."""
        laid = lay_frames(library, (1.0,))
        idle, left = laid.idle, laid.left.astype(np.int32)
        if wished is not None:  # nothing is left of a forbidden clip, so that no dance goes there
            idle, left = idle - wished.favour - wished.taste, np.where(wished.allowed(library), left, 0)
        stops = np.flatnonzero(laid.stop_worth > 0)
        spent = np.concatenate(([0.0], np.cumsum(most_earned(music, laid.intensity)))) * SHARE
        return cls(
            laid.intensity,
            idle.astype(np.float32),
            left.astype(np.int32),
            stops.astype(np.int32),
            laid.stop_shift[stops].astype(np.int32),
            np.searchsorted(stops, np.arange(len(laid))).astype(np.int32),
            spent,
            music,
        )


def find_part(
    library: MoveLibrary,
    music: Music,
    join_cost: tuple[float, float],
    frames: int,
    width: int = WIDTH,
    wished: Wished | None = None,
) -> Part:
    """The part of a library, of about so many frames, in which the best dances to a song are sought.

    Parameters
    ----------
    join_cost : (a, b): a join of pose distance d costs a + b d².
    frames : how many frames of the library's graph it may have.
    width : partial dances kept at each song frame.
    wished : clips that are not in it, clips that are liked, and stretches that must be in it, with ways to them.
    """
    field, graph = Field.of(library, music, wished), library.graph
    parent, time, entry, length, behind = walk(
        music.frames, HOLD, width, np.asarray(graph.indptr), np.asarray(graph.targets), np.asarray(graph.costs),
        *join_cost, field.intensity, field.idle, field.left, field.stops, field.shifts, field.next_stop, field.spent,
        music.beat_worth, music.intensity,
    )  # fmt: skip
    kept = np.zeros(len(graph), bool) if wished is None else wished.around(library)
    mark_ways(parent, time, entry, length, np.argsort(behind, kind="stable"), field.left, frames, kept)
    return Part.of(kept, np.asarray(graph.clip_of))
