"""Pose vectors (keyposes 2009, Eq. 3): a pose as 3N numbers that compare bodies of any size, and the way back.

A pose is the N points' places in the body-centre frame in units of the body's size, so that neither where a dancer is,
nor where to it faces, nor how tall it is, is in it. The points are the joints with a role that all the people's bodies
have, and the crown of the head; fingers and a skirt's bones do not outvote the body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations, Times, frozen
from onbeat.errors import BodyError, MetricError
from onbeat.motion import rotations as rot
from onbeat.motion.body import ROLES, Body, body_frames
from onbeat.motion.motion import Motion

CROWN = "crown"
"""The point at the end of the head's bone, which has no role."""
_LEAST, _MOST, _FAR = 1e-3, 1e4, 1e9  # metres of a body, and of where it can be
_SIDES = ("left", "right")
_CHAINS = (("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist"))


@dataclass(frozen=True, eq=False)
class PoseVectors:
    """The poses of one person's motion as vectors.

    Parameters
    ----------
    values : (F, 3N) x, y, z of the first point, of the second, …; in body sizes.
    points : N names: roles, and ``CROWN``.
    joints : (N,) the skeleton's joint that each point is.
    size : metres, the body's size: an arm, a leg and the trunk, see :func:`body_size`.
    frames, origins : (F, 4) wxyz and (F, 3) metres, the body-centre frame of each frame.
    fps : frames per second.
    name : of the motion.
    """

    values: Array
    points: tuple[str, ...]
    joints: Ints
    size: float
    frames: Rotations
    origins: Positions
    fps: float
    name: str = ""

    def __post_init__(self) -> None:
        for name, kind in (("values", np.float64), ("joints", np.int64), ("frames", np.float64)):
            object.__setattr__(self, name, frozen(getattr(self, name), kind))
        object.__setattr__(self, "origins", frozen(self.origins))

    def __len__(self) -> int:
        return len(self.values)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) / self.fps

    def at(self, times: Times) -> Array:
        """(T, 3N) the poses at any seconds, linear between frames; those outside are the first and the last."""
        frames = np.clip(np.asarray(times, np.float64) * self.fps, 0, len(self) - 1)
        low = np.minimum(frames.astype(np.int64), max(len(self) - 2, 0))
        part = (frames - low)[:, None]
        return self.values[low] * (1 - part) + self.values[np.minimum(low + 1, len(self) - 1)] * part

    def speeds(self, times: Times, step: float = 0.05) -> Array:
        """(T,) metres per second, the mean of the points' speeds in the body-centre frame about some seconds."""
        times = np.asarray(times, np.float64)
        moved = (self.at(times + step) - self.at(times - step)).reshape(len(times), -1, 3)
        return np.linalg.norm(moved, axis=-1).mean(axis=-1) * self.size / (2 * step)

    def world(self, values: Array | None = None) -> Positions:
        """(F, N, 3) metres in the world: of these poses, or of others (F, 3N) in their stead, frame by frame."""
        values = self.values if values is None else values
        if values.shape != self.values.shape:
            raise MetricError(f"{values.shape} poses cannot stand for the {self.values.shape} of {self.name!r}")
        inside = values.reshape(len(values), -1, 3) * self.size
        return rot.rotate(self.frames[:, None], inside) + self.origins[:, None]


def pose_vectors(motions: Sequence[Motion]) -> list[PoseVectors]:
    """The motions' poses by the same points, one ``PoseVectors`` each.

    Raises
    ------
    BodyError
        If a body lacks a role that every body needs; the motion is named.
    MetricError
        If there is no motion, or a body has no size.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> still = [Motion(Build(tall).skeleton, np.tile([1.0, 0, 0, 0], (2, 26, 1)), np.zeros((2, 3)), 30)
    ...          for tall in (1.5, 1.9)]
    >>> small, tall = pose_vectors(still)
    >>> bool(np.allclose(small.values, tall.values)), round(tall.size / small.size, 3)
    (True, 1.267)
    """
    if not motions:
        raise MetricError("no motion to take poses of; give one at least")
    bodies = [_body(motion) for motion in motions]
    names = tuple(role for role in ROLES if all(role in body for body in bodies))
    crowns = [_crown(motion, body) for motion, body in zip(motions, bodies, strict=True)]
    with_crown = all(crown is not None for crown in crowns)
    made: list[PoseVectors] = []
    for motion, body, crown in zip(motions, bodies, crowns, strict=True):
        joints = body.indices(*names)
        if with_crown and crown is not None:
            joints = np.append(joints, crown)
        made.append(_vectors(motion, body, (*names, CROWN) if with_crown else names, joints))
    return made


def body_size(motion: Motion, body: Body) -> float:
    """Metres: hip to ankle and shoulder to wrist along the bones (mean of both sides), and hips to shoulders.

    The median over the frames, for some files stretch their bones.
    """
    p = np.clip(motion.positions, -_FAR, _FAR)  # damaged files have places whose squares are beyond all numbers
    shoulders = p[:, body.indices("left_shoulder", "right_shoulder")].mean(axis=1)
    total = np.linalg.norm(shoulders - p[:, body["hips"]], axis=-1)
    for side in _SIDES:
        for chain in _CHAINS:
            bones = np.diff(p[:, body.indices(*(f"{side}_{role}" for role in chain))], axis=1)
            total = total + np.linalg.norm(bones, axis=-1).sum(axis=1) / 2
    return float(np.median(total))


def _body(motion: Motion) -> Body:
    try:
        return Body.of(motion.skeleton)
    except BodyError as error:
        raise BodyError(f"{motion.name}: {error}" if motion.name else str(error)) from None


def _crown(motion: Motion, body: Body) -> int | None:
    """The end of the head's bone; None where the head is a leaf or its bone has no length."""
    if "head" not in body:
        return None
    tips = motion.skeleton.children[body["head"]]
    bones = [float(np.linalg.norm(motion.positions[0, tip] - motion.positions[0, body["head"]])) for tip in tips]
    return tips[int(np.argmax(bones))] if bones and max(bones) > 0.02 else None


def _vectors(motion: Motion, body: Body, names: tuple[str, ...], joints: Ints) -> PoseVectors:
    size = body_size(motion, body)
    if not _LEAST < size < _MOST:
        raise MetricError(
            f"the body of {motion.name or 'the motion'} is {size:.2g} m from hand to foot; "
            f"{_LEAST:g} to {_MOST:g} m are expected: is the unit right?"
        )
    frames, origins = body_frames(motion, body)
    inside = rot.rotate(rot.inverse(frames)[:, None], motion.positions[:, joints] - origins[:, None])
    return PoseVectors(
        inside.reshape(len(motion), -1) / size, names, joints, size, frames, origins, motion.fps, motion.name
    )
