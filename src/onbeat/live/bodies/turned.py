"""A growing dance of a character as channels: rotation vectors of the joints above its legs.

A joint's vector is counted from its mean rotation in all clips, so that each clip's is small, and goes on from one
sample to the next without a jump of a whole turn. Legs and root have no channels: they go with the time alone, so that
feet stay where they are planted.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from onbeat._shapes import Array, Ints, Rotations, Times
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.retime.channels import mean_rotation, unwrapped, whole_turns
from onbeat.retime.stream import Bounds
from onbeat.retime.upper_body import above_the_legs

ROOM = 1.3
"""How much faster, and how much quicker in changing that, a joint may turn than it ever does in the clips."""
LEAST_SPEED, LEAST_ACCELERATION = 0.5, 10.0
"""rad/s and rad/s² that every component may have."""
MOST_SPEED, MOST_ACCELERATION = 25.0, 500.0
"""rad/s and rad/s² that none may have, whatever a bad frame of a capture does."""
LASTING, PEAK = 3, 1.5
"""Frames that a speed has to last, and how far the highest speed of a swing is over that."""
READ = 60.0
"""Hz at which the clips are read for what they reach."""


class Posed(Protocol):
    """Whatever has poses over time."""

    def pose(self, times: Times) -> tuple[Rotations, Array]:
        """Rotations (N, J, 4) and root positions (N, 3) at seconds (N,)."""
        ...


class Turned:
    """The joints above the legs of a line of clips.

    Parameters
    ----------
    line : whose poses are asked.
    clips : of one skeleton, all that the line may show: means and bounds are theirs.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> clips = embedded_motions()[:1]
    >>> class Shown:
    ...     def pose(self, times):
    ...         shown = clips[0].at(times)
    ...         return shown.rotations, shown.root_positions
    >>> turned = Turned(Shown(), clips)
    >>> times = np.arange(0, 2, 0.01)
    >>> values = turned.values(times, turned.start(0.0))
    >>> rotations = turned.made(values, times)[0]
    >>> bool(np.allclose(np.abs(np.sum(rotations * clips[0].at(times).rotations, axis=-1)), 1))
    True
    """

    def __init__(self, line: Posed, clips: Sequence[Motion]) -> None:
        self.line = line
        self.joints = np.asarray(above_the_legs(clips[0].skeleton), dtype=np.int64)
        read = [clip.resampled(READ) if clip.fps > READ else clip for clip in clips]
        chosen = [clip.rotations[:, self.joints] for clip in read]
        self.means = _means(np.concatenate(chosen), self.joints)
        self.bounds = _bounds([self._vectors(part) for part in chosen], [clip.fps for clip in read])

    def _vectors(self, rotations: Rotations, near: Array | None = None) -> Array:
        """(N, 3k) of rotations (N, k, 4), without jumps."""
        vectors = rot.log(rot.multiply(rot.inverse(self.means), rotations))
        last = vectors[:1] if near is None else near.reshape(1, -1, 3)
        turned = np.concatenate((last, vectors))
        for k in np.flatnonzero(whole_turns(turned[1:], turned[:-1]).any(axis=0)).tolist():
            turned[:, k] = unwrapped(turned[:, k])
        return turned[1:].reshape(len(vectors), -1)

    def start(self, own: float) -> Array:
        """(3k,) at one second."""
        return self._vectors(self.line.pose(np.array([own]))[0][:, self.joints])[0]

    def values(self, own: Times, near: Array) -> Array:
        """(N, 3k) at rising own seconds, beginning on the branch of ``near`` (3k,)."""
        return self._vectors(self.line.pose(own)[0][:, self.joints], near)

    def made(self, values: Array, own: Times) -> tuple[Rotations, Array]:
        """Rotations (N, J, 4) with these vectors (N, 3k), and root positions, the rest as at own seconds (N,)."""
        rotations, roots = self.line.pose(own)
        rotations = np.array(rotations)
        rotations[:, self.joints] = rot.multiply(self.means, rot.exp(values.reshape(len(values), -1, 3)))
        return rotations, roots


def _means(rotations: Rotations, joints: Ints) -> Rotations:
    return np.stack([mean_rotation(rotations[:, k]) for k in range(len(joints))])


def _bounds(vectors: Sequence[Array], fps: Sequence[float]) -> Bounds:
    """Bounds of each component: what it reaches in the clips and lasts, for captures jump, and some room."""
    speeds, quick = list[Array](), list[Array]()
    for part, rate in zip(vectors, fps, strict=True):
        lasting = np.abs(part[LASTING:] - part[:-LASTING]).max(axis=0, initial=0.0) * rate / LASTING
        speeds.append(np.minimum(np.abs(np.diff(part, axis=0)).max(axis=0, initial=0.0) * rate, PEAK * lasting))
        quick.append(np.abs(np.diff(part, 2, axis=0)).max(axis=0, initial=0.0) * rate**2)
    speed = np.clip(ROOM * np.max(speeds, axis=0), LEAST_SPEED, MOST_SPEED)
    acceleration = np.clip(ROOM * np.max(quick, axis=0), LEAST_ACCELERATION, MOST_ACCELERATION)
    free = np.full(len(speed), np.inf)
    return Bounds(-free, free, speed, acceleration, free)
