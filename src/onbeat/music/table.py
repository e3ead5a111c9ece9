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


def bar_numbers(song: Song) -> Ints:
    """Number of the bar of each beat, 1 from the first downbeat on; the beats before it are bar 0.

    >>> song = Song(3.0, 120.0, 4, [0.5, 1.0, 1.5, 2.0], [1.0], np.zeros(4), [0.0], [0.0])
    >>> bar_numbers(song).tolist()
    [0, 1, 1, 1]
    """
    return np.cumsum(np.isin(song.beats, song.downbeats)).astype(np.int64)


def sections_at_beats(song: Song) -> list[str]:
    """Kind of the section in which each beat lies; empty where it is not known."""
    if not song.sections:
        return [""] * len(song.beats)
    starts = [part.start for part in song.sections]
    index = np.maximum(np.searchsorted(starts, song.beats + 1e-6, side="right") - 1, 0)
    return [song.sections[place].kind for place in index.tolist()]


def to_csv(song: Song) -> bytes:
    """A heading, then a line a beat; times in seconds, beat 1 = downbeat, what is not known left empty."""
    lines = ["time,beat,chord_change,bar,strength,confidence,tempo,chord,section"]
    known, curve = len(song.confidence) > 0, song.tempo_curve
    for index, (place, bar, section) in enumerate(
        zip(bar_positions(song), bar_numbers(song), sections_at_beats(song), strict=True)
    ):
        confidence = f"{song.confidence[index]:.4f}" if known else ""
        tempo = f"{curve.bpm[index]:.2f}" if len(curve.bpm) else ""
        chord = song.chord_root[index] if song.chord_root else ""
        lines.append(
            f"{song.beats[index]:.4f},{place},{song.chord_change[index]:.4f},{bar},{song.beat_strength[index]:.4f},"
            f"{confidence},{tempo},{chord},{section}"
        )
    return ("\n".join(lines) + "\n").encode()
