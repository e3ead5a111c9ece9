"""A library of minutes out of one of hours, for those who look at every frame again and again, such as a live dance."""

from __future__ import annotations

import numpy as np

from onbeat.dance.part import cut_library
from onbeat.dance.score import score_music
from onbeat.dance.search import candidates
from onbeat.errors import PlanError
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

MINUTE, SWELL = 60.0, 20.0
"""Seconds of the music that stands for music of a tempo, and in which it grows loud and quiet again."""


def sublibrary(library: MoveLibrary, song: Song | float, seconds: float = 600.0) -> MoveLibrary:
    """The part of a library that suits a song, or music of a tempo, as a library of its own.

    Parameters
    ----------
    library : the moves; one that is not longer is given back as it is.
    song : what is danced to, or its tempo in beats a minute.
    seconds : how long the part may be, about; mirror images count.

    Returns
    -------
    A library whose clips are stretches of the library's, under their names; motions are read when they are asked for.

    Raises
    ------
    PlanError
        If the tempo or ``seconds`` cannot be.

    Examples
    --------
    >>> from onbeat.moves.embedded import embedded_library
    >>> library = embedded_library()
    >>> 50 < sublibrary(library, 110.0, 60.0).graph.clip_of.size / 30 < 90
    True
    """
    if not 1.0 <= seconds < np.inf:
        raise PlanError(f"a part of {seconds:g} s cannot be; give 1 or more")
    if len(library.graph) <= seconds * GRID:
        return library
    song = song if isinstance(song, Song) else _steady(song)
    return cut_library(library, candidates(library, score_music(song), round(seconds * GRID)))


def _steady(tempo: float) -> Song:
    """A minute of even beats that grows loud and quiet again."""
    if not 20.0 <= tempo <= 400.0:
        raise PlanError(f"a tempo of {tempo:g} beats a minute cannot be; give 20 to 400")
    beats, clock = np.arange(0.0, MINUTE, 60 / tempo), np.arange(0.0, MINUTE, 0.1)
    loud = 0.5 - 0.5 * np.cos(2 * np.pi * clock / SWELL)
    return Song(MINUTE, tempo, 4, beats, beats[::4], np.zeros(len(beats)), clock, loud)
