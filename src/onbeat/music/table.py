"""A song as a table for spreadsheets: one line a beat."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Ints
from onbeat.music.song import Song


def bar_positions(song: Song) -> Ints:
    """Place of each beat in its bar, 1 at downbeats; beats before the first downbeat count back from it.

    >>> song = Song(3.0, 120.0, 4, [0.5, 1.0, 1.5, 2.0], [1.0], np.zeros(4), [0.0], [0.0])
    >>> bar_positions(song).tolist()
    [4, 1, 2, 3]
    """
    starts = np.flatnonzero(np.isin(song.beats, song.downbeats))
    index = np.arange(len(song.beats))
    if not len(starts):
        return index % max(song.meter, 1) + 1
    latest = starts[np.maximum(np.searchsorted(starts, index, side="right") - 1, 0)]
    return np.where(index >= starts[0], index - latest, (index - starts[0]) % max(song.meter, 1)) + 1


def to_csv(song: Song) -> bytes:
    """Lines of ``time,beat,chord_change`` with a heading; time in seconds, beat 1 = downbeat."""
    lines = ["time,beat,chord_change"]
    for time, position, change in zip(song.beats, bar_positions(song), song.chord_change, strict=True):
        lines.append(f"{time:.4f},{position},{change:.4f}")
    return ("\n".join(lines) + "\n").encode()
