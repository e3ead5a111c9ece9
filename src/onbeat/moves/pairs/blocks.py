"""Groups of frames and the blocks between them: how the table of all pairs of frames is cut into tasks.

Frames of all clips lie in a row, cut into groups of about ``GROUP`` frames. A group holds whole clips; a clip longer
than that is cut into pieces that share a rim, so that each minimum of the table lies inside one piece alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Bools, Float32, Ints
from onbeat.errors import LibraryError

GROUP = 4096
"""Frames of a group, about: a block is one task, of about 17 million pairs."""
NEAR = 2
"""Frames on each side among which a minimum is the lowest, in both directions of the table."""
LARGEST = 1e6
"""Largest number that a pose may hold: its square is still far from the end of float32."""


class Pairs(NamedTuple):
    """Pairs of frames, in order of the first and then of the second.

    Parameters
    ----------
    first, second : (P,) int64 frames.
    distance : (P,) float32 of their poses.
    """

    first: Ints
    second: Ints
    distance: Float32

    @classmethod
    def none(cls) -> Pairs:
        """No pair."""
        return cls(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0, np.float32))

    @classmethod
    def joined(cls, parts: Sequence[Pairs]) -> Pairs:
        """All pairs of some parts, in order."""
        if not parts:
            return cls.none()
        first, second, distance = (np.concatenate(column) for column in zip(*parts, strict=True))
        order = np.lexsort((second, first))
        return cls(first[order], second[order], distance[order])

    def moved(self, first: int, second: int) -> Pairs:
        """The same pairs counted from elsewhere: a group's own frames made frames of all clips."""
        return Pairs(self.first + first, self.second + second, self.distance)


class Span(NamedTuple):
    """Frames ``start`` to ``stop`` of all clips in a row."""

    start: int
    stop: int


def group_spans(lengths: Sequence[int], size: int = GROUP) -> list[Span]:
    """The frames of each group, for clips of some numbers of frames; spans of one long clip share 2 ``NEAR`` frames.

    More clips at the end change the last span alone.

    Examples
    --------
    >>> [tuple(span) for span in group_spans([30, 40, 50, 250], size=100)]
    [(0, 70), (70, 120), (120, 220), (216, 316), (312, 370)]
    """
    spans: list[Span] = []
    begin, here = 0, 0
    for length in lengths:
        if here > begin and here + length - begin > size:
            spans.append(Span(begin, here))
            begin = here
        here += length
        while here - begin > size and here - begin > 4 * NEAR + 1:
            spans.append(Span(begin, begin + size))
            begin += size - 2 * NEAR
    return [*spans, Span(begin, here)] if here > begin else spans


@dataclass(frozen=True, eq=False)
class Group:
    """Some frames that follow one another in the row of all clips.

    Parameters
    ----------
    poses : (n, D) float32 pose vectors.
    clip_of : (n,) number of the clip of each frame, whole clips (or one piece of a long one) after one another.

    Raises
    ------
    LibraryError
        If the shapes disagree, or a pose is no finite number of sensible size.
    """

    poses: Float32
    clip_of: Ints

    def __post_init__(self) -> None:
        poses = np.ascontiguousarray(self.poses, np.float32)
        clip_of = np.asarray(self.clip_of, np.int64)
        if poses.ndim != 2 or clip_of.shape != poses.shape[:1]:
            raise LibraryError(
                f"a group of frames has poses {poses.shape} and clips {clip_of.shape}; expected (n, D) and (n,)"
            )
        good = (np.abs(poses) <= LARGEST).all(axis=1)
        if not good.all():
            frame = int(np.argmin(good))
            raise LibraryError(
                f"frame {frame - int(np.searchsorted(clip_of, clip_of[frame]))} of clip {clip_of[frame]} has a pose "
                f"that is not a number, or beyond {LARGEST:.0e}; leave the clip out, or repair it"
            )
        object.__setattr__(self, "poses", poses)
        object.__setattr__(self, "clip_of", clip_of)

    def __len__(self) -> int:
        return len(self.poses)

    @cached_property
    def bounds(self) -> Ints:
        """(clips + 1,) where each clip begins, and the number of frames."""
        changes = np.flatnonzero(np.diff(self.clip_of)) + 1
        return np.concatenate(([0], changes, [len(self)])).astype(np.int64) if len(self) else np.zeros(1, np.int64)

    def inner(self, near: int = NEAR) -> Bools:
        """(n,) true for frames that have ``near`` frames of their clip on each side."""
        inside = np.zeros(len(self), np.bool_)
        for begin, end in zip(self.bounds[:-1].tolist(), self.bounds[1:].tolist(), strict=True):
            inside[begin + near : max(end - near, begin + near)] = True
        return inside

    @cached_property
    def middle(self) -> Float32:
        """(D,) halfway between the lowest and the highest number of each column.

        Seen from there distances are small, and so is what rounding does to products.
        """
        return (self.poses.min(axis=0) + self.poses.max(axis=0)) * np.float32(0.5)
