"""What a robot's hinges do over time, without the robot: its angles, sampled at a steady rate."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import FormatError


@dataclass(frozen=True, eq=False)
class JointAngles:
    """The angles of n joints in F frames.

    Parameters
    ----------
    names : (n,) the joints, each once.
    angles : (F, n) radians (metres of a joint that slides).
    fps : frames per second.
    name : where they came from, for messages.

    Raises
    ------
    FormatError
        If shapes disagree, there is no frame or no joint, a name is there twice, the rate is not above 0 or a value is
        not finite (the first such frame and its joint are named).

    Examples
    --------
    >>> wave = JointAngles(("shoulder", "elbow"), np.zeros((60, 2)), fps=30)
    >>> wave.duration, len(wave), wave.of(["elbow"]).names
    (2.0, 60, ('elbow',))
    """

    names: tuple[str, ...]
    angles: Array
    fps: float
    name: str = ""

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        set_(self, "names", tuple(self.names))
        set_(self, "angles", frozen(self.angles))
        set_(self, "fps", float(self.fps))
        self._check()

    def _check(self) -> None:
        label = f"the angles of {self.name!r}" if self.name else "the joint angles"
        n = len(self.names)
        if self.angles.ndim != 2 or self.angles.shape[1] != n or n == 0:
            raise FormatError(f"{label} have the shape {self.angles.shape}; (frames, {max(n, 1)}) is needed")
        if len(self.angles) == 0:
            raise FormatError(f"{label} have no frames")
        twice = [joint for joint, count in Counter(self.names).items() if count > 1]
        if twice:
            raise FormatError(f"{label} have the joint {twice[0]} more than once; name each joint once")
        if not (np.isfinite(self.fps) and self.fps > 0):
            raise FormatError(f"{label} have {self.fps} frames per second; a positive rate is needed")
        bad = ~np.isfinite(self.angles)
        if bad.any():
            frame, joint = np.argwhere(bad)[0].tolist()
            raise FormatError(f"{label} have a value that is not a number at frame {frame}, joint {self.names[joint]}")

    def __len__(self) -> int:
        return len(self.angles)

    @property
    def duration(self) -> float:
        """Seconds; each frame is shown for 1/fps."""
        return len(self) / self.fps

    @property
    def times(self) -> Times:
        """(F,) seconds, the time of each frame from 0."""
        return np.arange(len(self)) / self.fps

    def of(self, joints: Sequence[str]) -> JointAngles:
        """The angles of some joints, in their order; a ``FormatError`` names those that are not there."""
        missing = [joint for joint in joints if joint not in self.names]
        if missing:
            raise FormatError(f"no joint {', '.join(missing[:5])} is there; there are {', '.join(self.names[:20])}")
        return replace(self, names=tuple(joints), angles=self.angles[:, [self.names.index(joint) for joint in joints]])
