"""How keyposes are laid out on a sheet: rows of beats like lines of music, numbers, places of the pictures."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints, Times

MOST, EASY = 12, 8
"""Pictures in a row, and in each of two rows that are a whole sheet."""
BARS = (16, 8, 4, 2, 1)
"""Bars that a row may be long."""
USUAL_BAR = 4
"""Beats of a bar where no downbeats are known."""


class Row(NamedTuple):
    """A row of a sheet: a stretch of beats and the keyposes in it.

    Parameters
    ----------
    title : what it is.
    first, end : its first beat and the one after its last.
    chosen : (K,) which keyposes are in it.
    numbers : (K,) the number of each, from 1.
    columns : (C,) where pictures want to be, in beats from ``first``; the same for rows that stand in one's columns.
    column : (K,) in which of them each keypose stands.
    """

    title: str
    first: int
    end: int
    chosen: Ints
    numbers: Ints
    columns: Array
    column: Ints


def in_beats(times: Times, beats: Times) -> Array:
    """Times as fractions of beats (B,), which are 0, 1, 2, …; before the first and after the last at the usual tempo.

    Examples
    --------
    >>> in_beats(np.array([0.5, 1.25, 5.0]), np.array([1.0, 1.5, 2.0])).tolist()
    [-1.0, 0.5, 8.0]
    """
    gap = float(np.median(np.diff(beats))) if len(beats) > 1 else 0.5
    inside = np.interp(times, beats, np.arange(len(beats), dtype=np.float64))
    return inside + np.minimum(times - beats[0], 0.0) / gap + np.maximum(times - beats[-1], 0.0) / gap


def downbeats_among(beats: Times, downbeats: Times) -> Ints:
    """Which of the beats are downbeats, as indices."""
    return np.flatnonzero(np.abs(beats[:, None] - np.asarray(downbeats)[None]).min(axis=1, initial=1.0) < 0.01)


def spread(wanted: Array, apart: float, low: float, high: float) -> Array:
    """Places (K,), in order and ``apart`` from each other, as near as can be to those ``wanted``, in ``low``…``high``.

    The least squares solution, by pooling neighbours that crowd; where there is too little room they share it evenly.

    Examples
    --------
    >>> spread(np.array([0.0, 5.0, 5.0]), 1.0, 0.0, 10.0).tolist()
    [0.0, 4.5, 5.5]
    """
    count = len(wanted)
    if count > 1:
        apart = min(apart, (high - low) / (count - 1))
    groups: list[tuple[float, int]] = []
    steps = apart * np.arange(count, dtype=np.float64)
    for value in (np.asarray(wanted, np.float64) - steps).tolist():
        mean, size = value, 1
        while groups and groups[-1][0] > mean:
            before, many = groups.pop()
            mean, size = (mean * size + before * many) / (size + many), size + many
        groups.append((mean, size))
    loose = np.array([mean for mean, size in groups for _ in range(size)], np.float64)
    return np.minimum(np.maximum(loose, low), high - apart * max(count - 1, 0)) + steps


def cycle_columns(beats: Ints, start: int, cycle: int) -> tuple[Ints, Ints]:
    """The beat (K,) of each keypose within its cycle, and its number (K,): that of all keyposes on this beat."""
    column = (np.asarray(beats, np.int64) - start) % cycle
    return column, np.searchsorted(np.unique(column), column) + 1


def keypose_numbers(beats: Ints, song_beats: Times, downbeats: Times, cycle: int | None = None) -> Ints:
    """(K,) numbers from 1: those of the same keypose are the same in every cycle, where its beats are known."""
    if cycle is None or not len(beats):
        return np.arange(1, len(beats) + 1)
    start = _start(beats, downbeats_among(song_beats, downbeats))
    return cycle_columns(beats, start, min(cycle, len(song_beats)))[1]


def rows_of(beats: Ints, song_beats: Times, downbeats: Times, cycle: int | None = None) -> list[Row]:
    """The rows of a sheet; stretches without a keypose have none.

    Parameters
    ----------
    beats : (K,) the beat of each keypose, increasing.
    song_beats : (B,) seconds.
    downbeats : seconds, empty where they are not known.
    cycle : beats after which the dance repeats.
    """
    down = downbeats_among(song_beats, downbeats)
    start = _start(beats, down)
    if cycle is not None and len(beats):
        # A cycle as long as the song or longer is one, however long: it ends with the beats.
        return _cycles(np.asarray(beats, np.int64), start, min(cycle, len(song_beats)), len(song_beats))
    bar = round(float(np.median(np.diff(down)))) if len(down) > 1 else USUAL_BAR
    return _lines(np.asarray(beats, np.int64), start, max(bar, 1), len(song_beats))


def _start(beats: Ints, down: Ints) -> int:
    """The beat with which rows begin: a downbeat at or before the first keypose, else the keypose's own."""
    first = int(beats[0]) if len(beats) else 0
    before = down[down <= first]
    return int(before[-1]) if len(before) else first


def _lines(beats: Ints, start: int, bar: int, count: int) -> list[Row]:
    length = _length(beats, start, bar)
    rows: list[Row] = []
    for line in np.unique((beats - start) // length).tolist() if len(beats) else [0]:
        first = start + line * length
        chosen = np.flatnonzero((beats >= first) & (beats < first + length))
        columns = (beats[chosen] - first).astype(np.float64)
        title = f"beats {first + 1}–{min(first + length, count)}"
        rows.append(Row(title, first, first + length, chosen, chosen + 1, columns, np.arange(len(chosen))))
    return rows if len(rows) > 1 else [_alone(rows[0], count)]


def _length(beats: Ints, start: int, bar: int) -> int:
    """Beats of a row: as many bars as do not hold too many keyposes."""
    lengths = [bars * bar for bars in BARS]
    longest = next((length for length in lengths if _fullest(beats, start, length) <= MOST), MOST)
    if _fullest(beats, start, longest) < len(beats) or len(beats) <= EASY:
        return longest
    # All in one row would be small; two rows have a page, too.
    halves = (length for length in lengths if len(np.unique((beats - start) // length)) == 2)
    half = next(halves, longest)
    return half if _fullest(beats, start, half) <= EASY else longest


def _alone(row: Row, count: int) -> Row:
    """The only row of a sheet has nothing to be aligned with: its room is for where the keyposes are."""
    last = row.first + int(row.columns[-1]) if len(row.columns) else row.end
    end = max(min(row.end, count, last + 2 + (last - row.first) // 4), row.first + 2)
    return row._replace(title=f"beats {row.first + 1}–{end}", end=end)


def _fullest(beats: Ints, start: int, length: int) -> int:
    return int(np.unique((beats - start) // length, return_counts=True)[1].max(initial=0))


def _cycles(beats: Ints, start: int, cycle: int, count: int) -> list[Row]:
    """One cycle under another; those of too many keyposes in parts, all cycles of a part under each other."""
    place, numbers = cycle_columns(beats, start, cycle)
    which = (beats - start) // cycle
    used = np.unique(place)
    parts = next(n for n in range(1, cycle + 1) if _fullest(used, 0, -(-cycle // n)) <= MOST)
    length = -(-cycle // parts)
    rows: list[Row] = []
    for offset in range(0, cycle, length):
        end = min(offset + length, cycle)
        columns = used[(used >= offset) & (used < end)]
        for one in np.unique(which).tolist():
            chosen = np.flatnonzero((which == one) & (place >= offset) & (place < end))
            if not len(chosen):
                continue
            first, last = start + one * cycle + offset, start + one * cycle + end
            title = f"cycle {one + 1 - int(which[0])} · beats {first + 1}–{min(last, count)}"
            wanted, column = (columns - offset).astype(np.float64), np.searchsorted(columns, place[chosen])
            rows.append(Row(title, first, last, chosen, numbers[chosen], wanted, column))
    return rows
