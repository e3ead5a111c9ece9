"""Markers: labelled points on a moving body, as optical motion capture records them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Bools, Positions, Times, frozen
from onbeat.errors import FormatError


class Gap(NamedTuple):
    """A stretch in which a marker is not seen: its name, the first frame, and the frame after the last."""

    name: str
    first: int
    end: int


@dataclass(frozen=True, eq=False)
class Markers:
    """Positions of labelled markers over time.

    Parameters
    ----------
    names : M labels, no two alike.
    positions : (F, M, 3) metres, Z up; NaN in all three coordinates where a marker is not seen.
    fps : frames per second.
    name : where they came from, for messages.

    Raises
    ------
    FormatError
        If shapes disagree, there is no frame or no marker, a label occurs twice or a position is infinite.

    Examples
    --------
    >>> seen = Markers(("LWRA", "LWRB"), np.zeros((60, 2, 3)), fps=30)
    >>> seen.duration, len(seen), seen.gaps()
    (2.0, 60, [])
    """

    names: tuple[str, ...]
    positions: Positions
    fps: float
    name: str = ""

    def __init__(self, names: Sequence[str], positions: Positions, fps: float, name: str = "") -> None:
        set_ = object.__setattr__
        set_(self, "names", tuple(names))
        set_(self, "positions", frozen(positions))
        set_(self, "fps", float(fps))
        set_(self, "name", name)
        self._check()

    def _check(self) -> None:
        label, count = f"markers of {self.name!r}" if self.name else "the markers", len(self.names)
        if self.positions.ndim != 3 or self.positions.shape[1:] != (count, 3):
            raise FormatError(f"{label} have positions of shape {self.positions.shape}; (frames, {count}, 3) is needed")
        if not count or not len(self.positions):
            raise FormatError(f"{label}: {len(self.positions)} frames of {count} markers hold no motion")
        twice = sorted(name for name, times in Counter(self.names).items() if times > 1)
        if twice:
            raise FormatError(f"{label}: labels occur twice: {', '.join(twice)}; rename them")
        if not (np.isfinite(self.fps) and self.fps > 0):
            raise FormatError(f"{label} have {self.fps} frames per second; a positive rate is needed")
        if np.isinf(self.positions).any():
            frame, marker = np.argwhere(np.isinf(self.positions))[0][:2].tolist()
            raise FormatError(f"{label}: frame {frame} of {self.names[marker]!r} is infinite")

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def duration(self) -> float:
        """Seconds; each frame is shown for 1/fps."""
        return len(self) / self.fps

    @property
    def times(self) -> Times:
        """(F,) seconds, the time of each frame from 0."""
        return np.arange(len(self)) / self.fps

    @property
    def seen(self) -> Bools:
        """(F, M) true where a marker is seen."""
        return np.asarray(np.isfinite(self.positions).all(axis=-1))

    def index(self, name: str) -> int:
        """Index of the marker called ``name``; a ``FormatError`` lists the labels there are."""
        try:
            return self.names.index(name)
        except ValueError:
            raise FormatError(f"no marker {name!r}; there are {', '.join(self.names)}") from None

    def gaps(self) -> list[Gap]:
        """All stretches in which a marker is not seen, marker by marker.

        Examples
        --------
        >>> seen = np.zeros((5, 1, 3))
        >>> seen[1:3] = np.nan
        >>> Markers(("C7",), seen, 30).gaps()
        [Gap(name='C7', first=1, end=3)]
        """
        found: list[Gap] = []
        for name, seen in zip(self.names, self.seen.T, strict=True):
            edges = np.flatnonzero(np.diff(np.concatenate(([True], seen, [True])).astype(np.int8)))
            found += [Gap(name, first, end) for first, end in edges.reshape(-1, 2).tolist()]
        return found

    def chosen(self, names: Sequence[str]) -> Markers:
        """Only the markers called so, in that order."""
        return Markers(names, self.positions[:, [self.index(name) for name in names]], self.fps, self.name)

    def __getitem__(self, frames: slice) -> Markers:
        """Some of the frames."""
        return Markers(self.names, self.positions[frames], self.fps, self.name)

    def resampled(self, fps: float) -> Markers:
        """The same markers at another rate, linear between frames; unseen where a neighbouring frame is."""
        if abs(fps - self.fps) < 1e-9:
            return self
        count = max(1, int(np.floor((len(self) - 1) / self.fps * fps + 1e-6)) + 1)
        frames = np.minimum(np.arange(count) / fps * self.fps, len(self) - 1)
        low = np.floor(frames + 1e-9).astype(np.int64)
        part = np.clip(frames - low, 0, 1)[:, None, None]
        high = np.where(part[:, 0, 0] > 1e-9, np.minimum(low + 1, len(self) - 1), low)
        return Markers(self.names, self.positions[low] * (1 - part) + self.positions[high] * part, fps, self.name)
