"""Frames of a dance that grows: the poses, and what has to be known of them to go on from any of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations, Times
from onbeat.dance.sources import FAR, Pose
from onbeat.motion import rotations as rot


@dataclass(frozen=True, eq=False)
class Frames:
    """F frames in a row at a steady rate.

    Parameters
    ----------
    first : number of the first of them; frame n shows second ``n / fps``.
    rotations : (F, J, 4) wxyz, local.
    roots : (F, 3) metres.
    contacts : (F, 2) true where the left, right foot is meant to rest.
    offsets : (F, 2, 6) from the blended ankles to where they are: metres, and a world rotation vector in radians.
    anchors : (F, 2, 4) how the clip's foot is moved on the floor where it rests: x, y, z = 0 and yaw.
    sinks : (F, 1) metres by which the pelvis is lowered.
    moves : (F,) number of the move shown.
    joining : (F,) true inside the window of a join.
    """

    first: int
    rotations: Rotations
    roots: Positions
    contacts: Bools
    offsets: Array
    anchors: Array
    sinks: Array
    moves: Ints
    joining: Bools

    @classmethod
    def none(cls, joints: int) -> Frames:
        """No frame yet of a body of so many joints."""
        feet = np.zeros((0, 2), bool), np.zeros((0, 2, 6)), np.zeros((0, 2, 4)), np.zeros((0, 1))
        return cls(0, np.zeros((0, joints, 4)), np.zeros((0, 3)), *feet, np.zeros(0, np.int64), np.zeros(0, bool))

    def __len__(self) -> int:
        return len(self.roots)

    @property
    def after(self) -> int:
        """Number of the frame after the last."""
        return self.first + len(self)

    def between(self, first: int, after: int) -> Frames:
        """Those with numbers from ``first`` to before ``after``, as far as there are any."""
        first = min(max(first, self.first), self.after)
        span = slice(first - self.first, max(after, first) - self.first)
        return self._each(lambda values: values[span], first)

    def followed_by(self, other: Frames) -> Frames:
        """These up to the first of the others, then the others."""
        before = self.between(self.first, other.first)
        kept = {field.name: getattr(other, field.name) for field in fields(other)[1:]}
        joined = {name: np.concatenate((getattr(before, name), values)) for name, values in kept.items()}
        return replace(other, first=before.first, **joined)

    def _each(self, part: Callable[[np.ndarray], np.ndarray], first: int) -> Frames:
        return Frames(first, *(part(getattr(self, field.name)) for field in fields(self)[1:]))

    def pose(self, frames: Array) -> Pose:
        """Poses at frame numbers (N,) that need not be whole: cubics through the four frames around (Catmull-Rom).

        Velocities are continuous. Each pose depends on its own four frames alone, to the bit.
        """
        at = np.clip(frames - self.first, 0.0, len(self) - 1.0)
        low = np.floor(at + 1e-9).astype(np.int64)
        near = np.clip(low[:, None] + np.arange(-1, 3), 0, len(self) - 1)
        part = np.maximum(at - low, 0.0)
        weights = _cubic(part)
        q = self.rotations[near]
        along = np.sum(q * q[:, 1:2], axis=-1)
        mixed = np.where(along < 0, -1.0, 1.0) * weights[:, :, None]
        rotations = rot.normalise(_sum(q, mixed[..., None]))
        far = np.abs(along).min(axis=1) < FAR  # there a cubic would overshoot
        if far.any():
            rotations[far] = rot.slerp(q[:, 1][far], q[:, 2][far], np.broadcast_to(part[:, None], far.shape)[far])
        return Pose(rotations, _sum(self.roots[near], weights[..., None]))

    def resting(self, frames: Array) -> Bools:
        """(N, 2) contacts of the nearest frames to frame numbers (N,)."""
        near = np.rint(frames - self.first).astype(np.int64)
        return self.contacts[np.clip(near, 0, len(self) - 1)]


def _cubic(u: Times) -> Array:
    """(N, 4) weights of the values at −1, 0, 1 and 2 for a cubic read at ``u`` (N,), without a matrix product.

    Those differ in the last bit with the number of rows, and a pose must not depend on which others are asked for.
    """
    columns = u * (u * (2 - u) - 1), u * u * (3 * u - 5) + 2, u * (u * (4 - 3 * u) + 1), u * u * (u - 1)
    return np.stack(columns, axis=-1) / 2


def _sum(values: Array, weights: Array) -> Array:
    """Of four, one after the other."""
    parts = values * weights
    return parts[:, 0] + parts[:, 1] + parts[:, 2] + parts[:, 3]
