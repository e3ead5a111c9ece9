"""How the arrays of a clip lie in its bytes.

One after the other, without gaps: ``rotations`` (frames × joints × 4 float64, wxyz), ``root_positions`` (frames × 3
float64, metres), ``stops``, ``keyposes`` (float64, seconds), ``intensity`` (poses, float64) and ``poses`` (poses ×
width, float32). A mirror image has no motion of its own: it is made from its original when it is asked for.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from onbeat.errors import FormatError, LibraryError
from onbeat.motion.mirror import mirrored
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.moves.disk.shards import Bytes, Shards, Span
from onbeat.moves.lazy import Maker
from onbeat.moves.library import Clip
from onbeat.moves.recordings import About


class Shape(NamedTuple):
    """Counts from which the places of a clip's arrays follow."""

    mirrored: bool
    fps: float
    frames: int
    joints: int
    poses: int
    width: int
    stops: int
    keyposes: int

    @classmethod
    def of(cls, clip: Clip) -> Shape:
        """The counts of a clip."""
        frames, joints = clip.motion.rotations.shape[:2]
        poses, width = clip.poses.shape
        return cls(clip.mirrored, clip.motion.fps, frames, joints, poses, width, len(clip.stops), len(clip.keyposes))

    @property
    def _kinds(self) -> dict[str, tuple[str, tuple[int, ...]]]:
        moving = 0 if self.mirrored else self.frames
        return {
            "rotations": ("<f8", (moving, self.joints, 4)),
            "root_positions": ("<f8", (moving, 3)),
            "stops": ("<f8", (self.stops,)),
            "keyposes": ("<f8", (self.keyposes,)),
            "intensity": ("<f8", (self.poses,)),
            "poses": ("<f4", (self.poses, self.width)),
        }

    @property
    def size(self) -> int:
        """Bytes of all arrays."""
        return self.poses_at + 4 * self.poses * self.width

    @property
    def poses_at(self) -> int:
        """Bytes before the poses."""
        moving = 0 if self.mirrored else self.frames
        return 8 * (moving * (4 * self.joints + 3) + self.stops + self.keyposes + self.poses)

    def split(self, data: Bytes) -> dict[str, np.ndarray]:
        """The arrays by name, views of the bytes."""
        found: dict[str, np.ndarray] = {}
        start = 0
        for name, (kind, shape) in self._kinds.items():
            size = int(np.prod(shape)) * int(kind[2])
            found[name] = data[start : start + size].view(kind).reshape(shape)
            start += size
        return found


def arrays_of(clip: Clip) -> list[np.ndarray]:
    """The arrays of a clip that are stored, in their order."""
    motion = [] if clip.mirrored else [clip.motion.rotations, clip.motion.root_positions]
    rest = [clip.stops, clip.keyposes, clip.intensity]
    return [*motion, *(np.asarray(array, np.float64) for array in rest), np.asarray(clip.poses, np.float32)]


class Label(NamedTuple):
    """What a clip is called, the number of its recording, and what is told of it."""

    name: str
    source: int
    about: About = About()


class _Stored(NamedTuple):
    """Where a clip lies, and what its motion needs beside its bytes."""

    shards: Shards
    span: Span
    shape: Shape
    skeleton: Skeleton
    name: str
    original: Clip | None

    def part(self, array: str) -> np.ndarray:
        return self.shape.split(self.shards.read(self.span))[array]

    def motion(self) -> Motion:
        if self.original is not None:
            return mirrored(self.original.motion).replace(name=self.name)
        rotations, path = self.part("rotations"), self.part("root_positions")
        try:
            return Motion(self.skeleton, rotations, path, self.shape.fps, self.name)
        except FormatError as error:
            raise LibraryError(f"the library is damaged ({error}); build it again") from None


class _Part(Maker[Any]):
    """An array of a stored clip, or its motion."""

    __slots__ = ("_array", "_stored")

    def __init__(self, stored: _Stored, array: str) -> None:
        self._stored, self._array = stored, array

    def make(self) -> Any:
        return self._stored.motion() if self._array == "motion" else self._stored.part(self._array)


def stored_clip(
    shards: Shards, span: Span, shape: Shape, skeleton: Skeleton, label: Label, original: Clip | None = None
) -> Clip:
    """A clip whose arrays are read when they are asked for; of a mirror image the original is needed.

    Raises
    ------
    LibraryError
        When an array is asked for and is not there, or is no motion.
    """
    stored = _Stored(shards, span, shape, skeleton, label.name, original)
    motion, *parts = (_Part(stored, array) for array in ("motion", "stops", "intensity", "poses", "keyposes"))
    length = shape.frames, shape.fps
    return Clip(motion, label.name, label.source, shape.mirrored, *parts, length=length, about=label.about)
