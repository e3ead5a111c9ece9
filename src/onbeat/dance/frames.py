"""Library frames at several playback rates, laid in a row for the search."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Ints
from onbeat.dance.score import FINE, STANDING, Frames, z_rank
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

RATES = (1.0, 0.87, 1.1)
"""Playback rates the search may choose from, clip seconds a second."""
IDLE, PAUSE = 0.35, 0.6  # m/s of Eq. 2, smoothed over so many seconds, under which a body stands about
BLOCK = 0.25
"""Seconds of source that count as shown or not shown."""


def lay_frames(library: MoveLibrary, rates: Sequence[float] = RATES) -> Frames:
    """The library's frames at each of ``rates``."""
    count = len(library.graph)
    starts = library.starts
    base: list[Ints] = []
    rate_of: list[Array] = []
    seconds: list[Array] = []
    left: list[Ints] = []
    stops: list[tuple[Ints, Ints]] = []
    entry = np.zeros((len(rates), count), np.int64)
    offset = 0
    for number, rate in enumerate(rates):
        for clip, start in enumerate(starts[:-1]):
            length = int(starts[clip + 1] - start)
            virtual = int((length - 1) / rate) + 1
            shown = np.minimum(np.round(np.arange(virtual) * rate).astype(np.int64), length - 1)
            base.append(start + shown)
            rate_of.append(np.full(virtual, rate))
            seconds.append(np.arange(virtual, dtype=np.float64) * rate / GRID)
            left.append(virtual - 1 - np.arange(virtual))
            near = np.minimum(np.round(np.arange(length) / rate).astype(np.int64), virtual - 1)
            entry[number, start : start + length] = offset + near
            fine = np.round(library.clips[clip].stops / rate * GRID * FINE).astype(np.int64)
            at = np.minimum((fine + FINE // 2) // FINE, virtual - 1)
            stops.append((offset + at, fine - at * FINE))
            offset += virtual
    worth, shift = np.zeros(offset, np.float32), np.zeros(offset, np.int64)
    for at, rest in stops:
        np.add.at(worth, at, np.float32(1))
        shift[at] = rest
    all_base = np.concatenate(base)
    block, blocks = _blocks(library)
    return Frames(
        base=all_base,
        rate=np.concatenate(rate_of),
        second=np.concatenate(seconds),
        left=np.concatenate(left),
        entry=entry,
        stop_worth=worth,
        stop_shift=np.clip(shift, -FINE, FINE),
        intensity=z_rank(library.intensity)[all_base].astype(np.float32),
        idle=(_idleness(library) * STANDING / GRID)[all_base].astype(np.float32),
        block=block[all_base],
        blocks=blocks,
    )


def _idleness(library: MoveLibrary) -> Array:
    """(N,) 1 where the hands have not moved between two stops for ``PAUSE`` seconds, 0 where they dance."""
    calm = [gaussian_filter1d(clip.intensity, PAUSE * GRID, mode="nearest") for clip in library.clips]
    return np.clip(1 - np.concatenate(calm) / IDLE, 0.0, 1.0)


def _blocks(library: MoveLibrary) -> tuple[Ints, int]:
    """(N,) the stretch of clip each frame shows, and how many there are; a mirror image is another stretch."""
    block = np.zeros(len(library.graph), np.int64)
    used = 0
    for start, end in itertools.pairwise(library.starts.tolist()):
        within = (np.arange(end - start) / GRID / BLOCK).astype(np.int64)
        block[start:end] = used + within
        used += int(within[-1]) + 1
    return block, used
