"""Markers on a skeleton: where they are in a pose, how they move when joints turn, and what a body does not do."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton

MARKER_SIGMA = 0.005
"""Metres by which a marker is usually off: skin moves on bone."""


class Pose(NamedTuple):
    """Poses of F frames: (F, J, 4) local rotations wxyz and (F, 3) metres, the root's place."""

    rotations: Rotations
    root: Positions

    def chosen(self, frames: Ints | slice | Bools) -> Pose:
        """Some of the frames."""
        return Pose(self.rotations[frames], self.root[frames])


class Bend(NamedTuple):
    """What a joint is unlikely to do: ``c = n · R m``, a normal ``n`` of the parent and an axis ``m`` of the joint.

    Without a bound c should be 0; with one it should not be below.
    """

    joint: int
    normal: Array
    axis: Array
    sigma: float
    bound: float | None = None


class Placed(NamedTuple):
    """F poses worked out: (F, J, 3, 3) world rotations, (F, J, 3) joint and (F, M, 3) marker positions."""

    turns: Array
    joints: Positions
    markers: Positions


@dataclass(frozen=True, eq=False)
class Model:
    """A skeleton with M markers.

    Parameters
    ----------
    skeleton : J joints.
    segments, anchors : (M,) the joint whose rotation carries each marker, and the one from which its offset is told.
    offsets : (M, 3) metres, in the segment's frame.
    """

    skeleton: Skeleton
    segments: Ints
    anchors: Ints
    offsets: Array

    @cached_property
    def moving(self) -> Ints:
        """(K,) the joints that turn."""
        return np.flatnonzero(~self.skeleton.end_sites)

    @cached_property
    def above(self) -> Bools:
        """(J, J) whether the second joint is the first or above it."""
        s = self.skeleton
        above = np.eye(len(s), dtype=bool)
        for joint in range(1, len(s)):
            above[joint] |= above[s.parents[joint]]
        return above

    @cached_property
    def pairs(self) -> tuple[Ints, Ints]:
        """The markers and, as indices of :attr:`moving`, the joints that move them."""
        pairs = np.argwhere(self.above[self.segments][:, self.moving])
        return pairs[:, 0], pairs[:, 1]

    @cached_property
    def looseness(self) -> Array:
        """(K,) radians, how far each joint usually is from the rest pose; infinite for the root."""
        return np.array([_LOOSE[_bare(self.skeleton.names[joint])] for joint in self.moving])

    @cached_property
    def bends(self) -> tuple[Bend, ...]:
        """How elbows and knees bend."""
        found: list[Bend] = []
        x, y, z = np.eye(3)
        for side, sign in (("Left", -1.0), ("Right", 1.0)):
            elbow, knee = self.skeleton.index(f"{side}ForeArm"), self.skeleton.index(f"{side}Leg")
            found += [Bend(elbow, z, x * sign, 0.08), Bend(elbow, y, x * sign, 0.08, -0.05)]
            found += [Bend(knee, x, z, 0.05), Bend(knee, x, y, 0.12), Bend(knee, -y, -z, 0.08, -0.05)]
        return tuple(found)

    def placed(self, pose: Pose) -> Placed:
        """Where joints and markers are."""
        world, joints = forward_kinematics(self.skeleton, pose.rotations, pose.root)
        turns = rot.to_matrix(world)
        markers = joints[:, self.anchors] + np.einsum("fmij,mj->fmi", turns[:, self.segments], self.offsets)
        return Placed(turns, joints, markers)

    def jacobian(self, placed: Placed) -> Array:
        """(F, 3M, 3 + 3K) how the markers move with the root and with turns of the joints in the world.

        A joint at p that turns by ω moves a marker at x by ``ω × (x − p)`` (Lu and O'Connor 1999, by geometry).
        """
        frames, count = placed.markers.shape[:2]
        j = np.zeros((frames, count, 3, 3 + 3 * len(self.moving)))
        j[:, :, [0, 1, 2], [0, 1, 2]] = 1.0
        m, k = self.pairs
        arm = placed.markers[:, m] - placed.joints[:, self.moving[k]]
        at = 3 + 3 * k
        for row, column, axis, sign in (
            (0, 1, 2, 1),
            (0, 2, 1, -1),
            (1, 2, 0, 1),
            (1, 0, 2, -1),
            (2, 0, 1, 1),
            (2, 1, 0, -1),
        ):
            j[:, m, row, at + column] = sign * arm[..., axis]
        return j.reshape(frames, 3 * count, -1)

    def turned(self, pose: Pose, placed: Placed, step: Array) -> Pose:
        """The poses after a step (F, 3 + 3K): metres of the root, then turns of the joints in the world."""
        omega = step[:, 3:].reshape(len(step), -1, 3)
        local = np.einsum("fkji,fkj->fki", self.parent_turns(placed), omega)
        rotations = pose.rotations.copy()
        rotations[:, self.moving] = rot.normalise(rot.multiply(rot.exp(local), rotations[:, self.moving]))
        return Pose(rotations, pose.root + step[:, :3])

    def parent_turns(self, placed: Placed) -> Array:
        """(F, K, 3, 3) world rotations of the frames in which the moving joints' rotations are told."""
        turns = placed.turns[:, self.skeleton.parents[self.moving]]
        turns[:, 0] = np.eye(3)
        return turns

    def habits(self, pose: Pose, placed: Placed, reference: Pose) -> tuple[Array, Array, Array]:
        """What the poses are unlikely to be: (F,) cost, its gradient (F, 3 + 3K) and Hessian blocks (F, K, 3, 3).

        Each joint stays near the reference (½|log(q r⁻¹)|²/σ²), elbows and knees bend as hinges (:class:`Bend`).
        """
        k = len(self.moving)
        away = rot.log(rot.multiply(pose.rotations[:, self.moving], rot.inverse(reference.rotations[:, self.moving])))
        weight = 1.0 / self.looseness**2
        cost = 0.5 * np.sum(weight[:, None] * away**2, axis=(1, 2))
        parents = self.parent_turns(placed)
        turn = weight[:, None] * np.einsum("fkij,fkj->fki", parents, away)
        blocks = np.tile(weight[:, None, None] * np.eye(3), (len(pose.root), 1, 1, 1))
        for bend in self.bends:
            at = int(np.searchsorted(self.moving, bend.joint))
            normal, axis = parents[:, at] @ bend.normal, placed.turns[:, bend.joint] @ bend.axis
            c = np.sum(normal * axis, axis=1) - (bend.bound or 0.0)
            c = c if bend.bound is None else np.minimum(c, 0.0)
            slope = np.cross(axis, normal) / bend.sigma
            slope = slope if bend.bound is None else slope * (c < 0)[:, None]
            cost += 0.5 * (c / bend.sigma) ** 2
            turn[:, at] += slope * (c / bend.sigma)[:, None]
            blocks[:, at] += slope[:, :, None] * slope[:, None, :]
        drift = (pose.root - reference.root) / _ROOT_M**2
        cost += 0.5 * np.sum(drift * (pose.root - reference.root), axis=1)
        return cost, np.concatenate((drift, turn.reshape(-1, 3 * k)), axis=1), blocks


_ROOT_M = 1.0
_LOOSE = {
    "Hips": 10.0,
    "Spine": 0.4,
    "Chest": 0.4,
    "Neck": 0.5,
    "Head": 0.5,
    "Shoulder": 0.3,
    "Arm": 1.5,
    "ForeArm": 1.5,
    "Hand": 0.6,
    "UpLeg": 2.0,
    "Leg": 1.5,
    "Foot": 0.7,
    "ToeBase": 0.3,
}


def _bare(name: str) -> str:
    return name.removeprefix("Left").removeprefix("Right")
