"""What of a motion is retimed inside limits: hinge angles of a robot, rotation vectors of a character's joints.

A character's joint is the rotation vector (3 numbers, radians: twice the quaternion's logarithm of 2007) that takes its
mean rotation in the dance to the present one. Near the mean the vector's speed is the joint's angular speed;
elsewhere it is more, never less (the Jacobian of the exponential map shrinks), so what bounds it bounds the joint's.
Vectors go on through π: of all that mean the same rotation, φ + 2πk φ/|φ|, the one nearest to the last is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Rotations, frozen
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion


@dataclass(frozen=True, eq=False)
class Turning:
    """Some joints of a motion as rotation vectors about their means.

    Parameters
    ----------
    joints : (k,) their places in the skeleton.
    means : (k, 4) wxyz, the rotation that each one's vector is counted from.
    vectors : (F, k, 3) radians.
    """

    joints: Ints
    means: Rotations
    vectors: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints, np.int64))
        object.__setattr__(self, "means", frozen(self.means))
        object.__setattr__(self, "vectors", frozen(self.vectors))

    @classmethod
    def of(cls, motion: Motion, joints: Sequence[int]) -> Turning:
        """The vectors of some joints of a motion.

        Examples
        --------
        >>> from onbeat.motion import Skeleton
        >>> turns = rot.about(np.array([0.0, 0, 1]), np.linspace(0, 7, 50))[:, None]
        >>> spin = Motion(Skeleton(("top",), [-1], [[0, 0, 0]]), turns, np.zeros((50, 3)), 30)
        >>> path = Turning.of(spin, [0]).vectors[:, 0, 2]
        >>> float((path[-1] - path[0]).round(6))
        7.0
        """
        rotations = motion.rotations[:, list(joints)]
        means = (
            np.stack([mean_rotation(rotations[:, k]) for k in range(len(joints))]) if len(joints) else np.zeros((0, 4))
        )
        vectors = rot.log(rot.multiply(rot.inverse(means), rotations))
        for k in np.flatnonzero(whole_turns(vectors[1:], vectors[:-1]).any(axis=0)).tolist():
            vectors[:, k] = unwrapped(vectors[:, k])
        return cls(np.asarray(joints, dtype=np.int64), means, vectors)

    def rotations(self, vectors: Array) -> Rotations:
        """The joints' rotations (N, k, 4) with other vectors (N, k, 3)."""
        return rot.multiply(self.means, rot.exp(vectors))


def mean_rotation(rotations: Rotations) -> Rotations:
    """The mean of rotations (F, 4): the main axis of Σ q qᵀ, for which signs do not matter."""
    return rot.normalise(np.linalg.eigh(rotations.T @ rotations)[1][:, -1])


def unwrapped(vectors: Array) -> Array:
    """Rotation vectors (F, 3) of which each is, of all that mean its rotation, the one nearest to the last."""
    out = np.array(vectors, dtype=np.float64)
    for frame in range(1, len(out)):
        turns = float(whole_turns(out[frame], out[frame - 1]))
        if turns:
            out[frame] += 2 * np.pi * turns * _axis(out[frame], out[frame - 1])
    return out


def whole_turns(vectors: Array, last: Array) -> Array:
    """By how many whole turns about their own axes vectors (…, 3) come nearest to the last."""
    length = np.linalg.norm(vectors, axis=-1)
    return np.round((np.sum(_axis(vectors, last) * last, axis=-1) - length) / (2 * np.pi))


def _axis(vectors: Array, last: Array) -> Array:
    """Unit axes of vectors (…, 3); no rotation has the axis of the last, for a whole turn is none."""
    own = np.where(np.linalg.norm(vectors, axis=-1, keepdims=True) < 1e-9, last, vectors)
    return own / np.maximum(np.linalg.norm(own, axis=-1, keepdims=True), 1e-300)
