"""Library frames at several playback rates, laid in a row for the search."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Ints
from onbeat.dance.part import Part
from onbeat.dance.score import FINE, STANDING, Frames, z_rank
from onbeat.moves.graph import GRID
from onbeat.moves.library import MoveLibrary

RATES = (1.0, 0.87, 1.1)
"""Playback rates the search may choose from, clip seconds a second."""
IDLE, PAUSE = 0.35, 0.6  # m/s of Eq. 2, smoothed over so many seconds, under which a body stands about
BLOCK = 0.25
"""Seconds of source that count as shown or not shown."""


def lay_frames(library: MoveLibrary, rates: Sequence[float] = RATES, part: Part | None = None) -> Frames:
    """The library's frames at each of ``rates``, or those of a part of it, laid as those of the whole are.

    Of a part, base frames are counted in the part; ``entry`` is −1 where a base frame's virtual frame is not in it.
    """
    part = Part.whole(library) if part is None else part
    base: list[Ints] = []
    rate_of: list[Array] = []
    seconds: list[Array] = []
    left: list[Ints] = []
    stops: list[tuple[Ints, Ints]] = []
    entry = np.full((len(rates), len(part)), -1, np.int64)
    offset = 0
    for number, rate in enumerate(rates):
        for (clip, first, end), place in zip(part, part.starts.tolist(), strict=False):
            start, length = int(library.starts[clip]), int(library.starts[clip + 1] - library.starts[clip])
            virtual = int((length - 1) / rate) + 1
            shown = np.minimum(np.round(np.arange(virtual) * rate).astype(np.int64), length - 1)
            low, high = np.searchsorted(shown, (first - start, end - start)).tolist()
            base.append(place + shown[low:high] - (first - start))
            rate_of.append(np.full(high - low, rate))
            seconds.append(np.arange(low, high, dtype=np.float64) * rate / GRID)
            left.append(high - 1 - np.arange(low, high))
            near = np.minimum(np.round(np.arange(first - start, end - start) / rate).astype(np.int64), virtual - 1)
            inside = np.flatnonzero((near >= low) & (near < high))
            entry[number, place + inside] = offset + near[inside] - low
            fine = np.round(library.clips[clip].stops / rate * GRID * FINE).astype(np.int64)
            at = np.minimum((fine + FINE // 2) // FINE, virtual - 1)
            seen = (at >= low) & (at < high)
            stops.append((offset + at[seen] - low, fine[seen] - at[seen] * FINE))
            offset += high - low
    worth, shift = np.zeros(offset, np.float32), np.zeros(offset, np.int64)
    for at, rest in stops:
        np.add.at(worth, at, np.float32(1))
        shift[at] = rest
    all_base = np.concatenate(base)
    block, blocks = _blocks(library, part)
    return Frames(
        base=all_base,
        rate=np.concatenate(rate_of),
        second=np.concatenate(seconds),
        left=np.concatenate(left),
        entry=entry,
        stop_worth=worth,
        stop_shift=np.clip(shift, -FINE, FINE),
        intensity=z_rank(library.intensity)[part.frames][all_base].astype(np.float32),
        idle=(_idleness(library, part) * STANDING / GRID)[all_base].astype(np.float32),
        block=block[all_base],
        blocks=blocks,
    )


def _idleness(library: MoveLibrary, part: Part) -> Array:
    """(n,) 1 where the hands have not moved between two stops for ``PAUSE`` seconds, 0 where they dance."""
    calm: list[Array] = []
    for clip, first, end in part:
        smooth = gaussian_filter1d(library.clips[clip].intensity, PAUSE * GRID, mode="nearest")
        calm.append(smooth[first - int(library.starts[clip]) : end - int(library.starts[clip])])
    return np.clip(1 - np.concatenate(calm) / IDLE, 0.0, 1.0)


def _blocks(library: MoveLibrary, part: Part) -> tuple[Ints, int]:
    """(n,) the stretch of clip each frame shows, and how many there are; a mirror image is another stretch."""
    clips = np.asarray(library.graph.clip_of)[part.frames]
    within = ((part.frames - library.starts[clips]) / GRID / BLOCK).astype(np.int64)
    most = int(np.ceil(np.diff(library.starts).max() / GRID / BLOCK)) + 1
    block = np.unique(clips * most + within, return_inverse=True)[1].reshape(-1)
    return block.astype(np.int64), int(block.max()) + 1
