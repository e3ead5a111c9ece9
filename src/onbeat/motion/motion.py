"""A motion: what a skeleton does over time, sampled at a steady rate, readable at any time between."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Positions, Rotations, Times, frozen
from onbeat.errors import FormatError
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class Motion:
    """Joint rotations and the root's path over time.

    Parameters
    ----------
    skeleton : the body, J joints.
    rotations : (F, J, 4) unit quaternions wxyz, each joint's rotation in its parent's frame.
    root_positions : (F, 3) metres, Z up.
    fps : frames per second.
    name : where it came from, for messages and plans.
    translations : (F, J, 3) metres or None; animated offsets that replace the skeleton's where a file has them.
        The root's row is not used.

    Raises
    ------
    FormatError
        If shapes disagree, there is no frame, or a value is not finite (the first such frame and joint are named).

    Examples
    --------
    >>> body = Skeleton(("hips",), [-1], [[0, 0, 0]])
    >>> motion = Motion(body, np.tile([1.0, 0, 0, 0], (60, 1, 1)), np.zeros((60, 3)), fps=30)
    >>> motion.duration, len(motion)
    (2.0, 60)
    """

    skeleton: Skeleton
    rotations: Rotations
    root_positions: Positions
    fps: float
    name: str = ""
    translations: Positions | None = None

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        set_(self, "rotations", frozen(self.rotations))
        set_(self, "root_positions", frozen(self.root_positions))
        set_(self, "fps", float(self.fps))
        if self.translations is not None:
            set_(self, "translations", frozen(self.translations))
        self._check()

    def _check(self) -> None:
        label = f"motion {self.name!r}" if self.name else "the motion"
        joints = len(self.skeleton)
        if self.rotations.ndim != 3 or self.rotations.shape[1:] != (joints, 4):
            raise FormatError(f"{label} has rotations of shape {self.rotations.shape}; (frames, {joints}, 4) is needed")
        frames = self.rotations.shape[0]
        if frames == 0:
            raise FormatError(f"{label} has no frames")
        if self.root_positions.shape != (frames, 3):
            raise FormatError(
                f"{label} has root positions of shape {self.root_positions.shape}; ({frames}, 3) is needed"
            )
        if self.translations is not None and self.translations.shape != (frames, joints, 3):
            raise FormatError(
                f"{label} has translations of shape {self.translations.shape}; ({frames}, {joints}, 3) is needed"
            )
        if not (np.isfinite(self.fps) and self.fps > 0):
            raise FormatError(f"{label} has {self.fps} frames per second; a positive rate is needed")
        good = np.isfinite(self.rotations).all((1, 2)) & np.isfinite(self.root_positions).all(1)
        if self.translations is not None:
            good &= np.isfinite(self.translations).all((1, 2))
        if not good.all():
            raise FormatError(f"{label} has a value that is not a number at frame {int(np.argmin(good))}")

    def __len__(self) -> int:
        return self.rotations.shape[0]

    @property
    def duration(self) -> float:
        """Seconds; each frame is shown for 1/fps."""
        return len(self) / self.fps

    @property
    def times(self) -> Times:
        """(F,) seconds, the time of each frame from 0."""
        return np.arange(len(self)) / self.fps

    @cached_property
    def _world(self) -> tuple[Rotations, Positions]:
        world_rotations, positions = forward_kinematics(
            self.skeleton, self.rotations, self.root_positions, self.translations
        )
        world_rotations.setflags(write=False)
        positions.setflags(write=False)
        return world_rotations, positions

    @property
    def world_rotations(self) -> Rotations:
        """(F, J, 4) wxyz, each joint's rotation in the world."""
        return self._world[0]

    @property
    def positions(self) -> Positions:
        """(F, J, 3) metres, each joint's position in the world."""
        return self._world[1]

    def at(self, times: Times) -> Motion:
        """The motion at other times, in seconds from its start, as a motion of as many frames (fps kept).

        Rotations by spherical, positions by linear interpolation; times outside are clamped to the ends.
        """
        frames = np.clip(np.asarray(times, np.float64) * self.fps, 0, len(self) - 1)
        low = np.minimum(frames.astype(np.int64), max(len(self) - 2, 0))
        high = np.minimum(low + 1, len(self) - 1)
        part = frames - low
        mix = part[:, None]
        translations = None
        if self.translations is not None:
            t = self.translations
            translations = t[low] * (1 - mix[..., None]) + t[high] * mix[..., None]
        return Motion(
            self.skeleton,
            rot.slerp(self.rotations[low], self.rotations[high], part[:, None]),
            self.root_positions[low] * (1 - mix) + self.root_positions[high] * mix,
            self.fps,
            self.name,
            translations,
        )

    def resampled(self, fps: float) -> Motion:
        """The same motion at another rate; the last frame is the last that both rates reach."""
        if abs(fps - self.fps) < 1e-9:
            return self
        count = max(1, int(np.floor((len(self) - 1) / self.fps * fps + 1e-6)) + 1)
        return self.at(np.arange(count) / fps).replace(fps=fps)

    def replace(
        self,
        *,
        skeleton: Skeleton | None = None,
        rotations: Rotations | None = None,
        root_positions: Positions | None = None,
        fps: float | None = None,
        name: str | None = None,
    ) -> Motion:
        """A copy with some fields changed."""
        return Motion(
            self.skeleton if skeleton is None else skeleton,
            self.rotations if rotations is None else rotations,
            self.root_positions if root_positions is None else root_positions,
            self.fps if fps is None else fps,
            self.name if name is None else name,
            self.translations,
        )

    def __getitem__(self, frames: slice) -> Motion:
        """Some of the frames, as a motion; where its joints are is not reckoned again if that was done for all."""
        translations = None if self.translations is None else self.translations[frames]
        part = Motion(
            self.skeleton, self.rotations[frames], self.root_positions[frames], self.fps, self.name, translations
        )
        if "_world" in self.__dict__:
            part.__dict__["_world"] = tuple(frozen(array[frames]) for array in self._world)
        return part
