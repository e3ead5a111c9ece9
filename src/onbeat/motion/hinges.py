"""Robots: bodies whose joints are hinges, each turning about one fixed axis.

A robot's model gives every link a frame of its own, tilted against its parent's. Here all frames are turned to be the
root's in the zero configuration, so that the zero configuration is a rest pose like any other skeleton's. With
``W_j`` the orientation of link j's own frame in the zero configuration (``W_root = 1``, ``W_j = W_parent tilt_j``),

    offset_j = W_parent offset_own,   axis_j = W_j axis_own,   R_j,local = about(axis_j, q_j),

and the orientation of link j as the robot's model has it is ``R_j,world W_j``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations, frozen
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

OFF_AXIS_DEG = 0.5
"""How far a rotation may be from one about its hinge's axis."""
OFF_PLACE = 1e-3
"""Metres by which a joint may be away from where the robot has it."""


class Hinge(NamedTuple):
    """One hinge as a robot's model (URDF, MJCF) has it."""

    name: str
    parent: str
    """The hinge above it, or the root."""
    offset: tuple[float, float, float]
    """Metres, in the frame of the link above."""
    tilt: tuple[float, float, float]
    """Roll, pitch and yaw in radians of this link's frame in that of the link above (URDF's ``rpy``)."""
    axis: tuple[float, float, float]
    """In this link's frame."""
    low: float
    high: float
    """Limits of the angle in radians."""
    speed: float
    """Limit of the angular velocity in rad/s."""


class End(NamedTuple):
    """A point on a link: its name, the hinge (or root) that moves it, and metres in that link's frame."""

    name: str
    parent: str
    offset: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class HingeBody:
    """A robot: a skeleton that rests in the zero configuration, and what each of its n hinges can do.

    Parameters
    ----------
    name : what it is called in messages.
    skeleton : the root, the hinges in their own order, and end sites.
    joints : (n,) the joint of each hinge.
    axes : (n, 3) unit axes in the frame of the root in the zero configuration.
    low, high : (n,) limits of the angles in radians.
    speed : (n,) limits of the angular velocities in rad/s.
    links : (n, 4) wxyz, the orientation of each hinge's own link in the zero configuration.

    Examples
    --------
    >>> arm = HingeBody.of("arm", "base", [Hinge("elbow", "base", (0, 0, 1), (0, 0, 0), (0, 1, 0), -2, 2, 3)])
    >>> arm.names, arm.axes.tolist()
    (('elbow',), [[0.0, 1.0, 0.0]])
    """

    name: str
    skeleton: Skeleton
    joints: Ints
    axes: Array
    low: Array
    high: Array
    speed: Array
    links: Rotations

    @classmethod
    def of(cls, name: str, root: str, hinges: Sequence[Hinge], ends: Sequence[End] = ()) -> HingeBody:
        """The body of these hinges, parents first, with its frames turned to be the root's."""
        places: dict[str, tuple[int, Rotations]] = {root: (0, rot.IDENTITY)}
        parents, offsets, axes = [-1], [np.zeros(3)], list[Array]()
        for index, hinge in enumerate(hinges, 1):
            parent, above = places[hinge.parent]
            link = rot.multiply(above, rot.from_euler("ZYX", np.array(hinge.tilt[::-1])))
            places[hinge.name] = index, link
            parents.append(parent)
            offsets.append(rot.rotate(above, np.array(hinge.offset)))
            axes.append(rot.rotate(link, np.array(hinge.axis) / np.linalg.norm(hinge.axis)))
        for end in ends:
            parent, above = places[end.parent]
            parents.append(parent)
            offsets.append(rot.rotate(above, np.array(end.offset)))
        names = [*places, *(end.name for end in ends)]
        skeleton = Skeleton(names, parents, offsets, [n > len(hinges) for n in range(len(names))])
        low, high, speed = (frozen([getattr(hinge, key) for hinge in hinges]) for key in ("low", "high", "speed"))
        joints, links = frozen(range(1, len(hinges) + 1), np.int64), frozen([places[hinge.name][1] for hinge in hinges])
        return cls(name, skeleton, joints, frozen(axes), low, high, speed, links)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the hinges, in their order."""
        return tuple(self.skeleton.names[joint] for joint in self.joints)

    def found_in(self, skeleton: Skeleton) -> Ints:
        """Which joint of a skeleton each joint of the robot is; end sites, and the order of joints, may differ.

        Raises
        ------
        BodyError
            If a joint is missing, hangs elsewhere or stands more than a millimetre away from where the robot has it.
        """
        mine = [0, *self.joints.tolist()]
        missing = [name for j in mine if (name := self.skeleton.names[j]) not in skeleton.names]
        if missing:
            raise BodyError(f"it is not {self.name}: it has no joint {', '.join(missing[:4])}")
        found = np.array([skeleton.names.index(self.skeleton.names[j]) for j in mine])
        for j, k in zip(mine[1:], found[1:], strict=True):
            name, above = self.skeleton.names[j], self.skeleton.parents[j]
            if skeleton.parents[k] != found[mine.index(above)]:
                raise BodyError(f"it is not {self.name}: {name} is not below {self.skeleton.names[above]}")
            away = float(np.linalg.norm(skeleton.offsets[k] - self.skeleton.offsets[j]))
            if away > OFF_PLACE:
                raise BodyError(f"it is not {self.name}: {name} is {away * 1000:.1f} mm from its place")
        return found


def hinge_motion(
    body: HingeBody, root_positions: Positions, root_rotations: Rotations, angles: Array, fps: float, name: str = ""
) -> Motion:
    """What the robot does: its root's path (F, 3) in metres and turns (F, 4) wxyz, and its angles (F, n) in radians.

    Examples
    --------
    >>> arm = HingeBody.of("arm", "base", [Hinge("elbow", "base", (0, 0, 1), (0, 0, 0), (0, 1, 0), -2, 2, 3)])
    >>> bent = hinge_motion(arm, np.zeros((1, 3)), rot.IDENTITY[None], np.array([[0.5]]), fps=30)
    >>> hinge_angles(arm, bent).round(9).tolist()
    [[0.5]]
    """
    rotations = np.tile(rot.IDENTITY, (len(angles), len(body.skeleton), 1))
    rotations[:, 0] = root_rotations
    rotations[:, body.joints] = rot.about(body.axes, angles)
    return Motion(body.skeleton, rotations, root_positions, fps, name)


def hinge_angles(body: HingeBody, motion: Motion) -> Array:
    """The angles (F, n) in radians of a motion of the robot, each within π of the middle of its hinge's limits.

    Of a rotation ``(w, v)`` the part about the axis a is ``2 atan2(v·a, w)``; what is left is across the axis.

    Raises
    ------
    BodyError
        If the skeleton is not the robot's, or a rotation is more than 0.5° from one about its hinge's axis; the first
        such frame and its joint are named.
    """
    found = body.found_in(motion.skeleton)[1:]
    _check_lengths(body, motion, found)
    local = motion.rotations[:, found]
    along = np.sum(local[..., 1:] * body.axes, axis=-1)
    across = np.linalg.norm(local[..., 1:] - along[..., None] * body.axes, axis=-1)
    off = np.degrees(2 * np.arctan2(across, np.hypot(local[..., 0], along)))
    if (off > OFF_AXIS_DEG).any():
        frame, hinge = np.argwhere(off > OFF_AXIS_DEG)[0].tolist()
        raise BodyError(
            f"frame {frame}: {body.names[hinge]} is turned {off[frame, hinge]:.1f}° out of its hinge, "
            f"which turns about {body.axes[hinge].round(3).tolist()} only"
        )
    angles, middle = 2 * np.arctan2(along, local[..., 0]), (body.low + body.high) / 2
    return angles - 2 * np.pi * np.round((angles - middle) / (2 * np.pi))


def _check_lengths(body: HingeBody, motion: Motion, found: Ints) -> None:
    if motion.translations is None:
        return
    away = np.linalg.norm(motion.translations[:, found] - body.skeleton.offsets[body.joints], axis=-1)
    if (away > OFF_PLACE).any():
        frame, hinge = np.argwhere(away > OFF_PLACE)[0].tolist()
        raise BodyError(f"frame {frame}: {body.names[hinge]} is moved by {away[frame, hinge] * 1000:.1f} mm")


def hinge_speeds(angles: Array, fps: float) -> Array:
    """Angular velocities (F, n) in rad/s by central differences, one-sided at the ends; zero for a single frame."""
    return np.gradient(angles, 1 / fps, axis=0) if len(angles) > 1 else np.zeros_like(angles)


class Violations(NamedTuple):
    """The share of frames, 0 to 1, in which each of n hinges is past its limits."""

    names: tuple[str, ...]
    angle: Array
    speed: Array


def limit_violations(body: HingeBody, angles: Array, fps: float) -> Violations:
    """In which share of the frames each hinge is past the limits of its angle, and of its angular velocity.

    Examples
    --------
    >>> arm = HingeBody.of("arm", "base", [Hinge("elbow", "base", (0, 0, 1), (0, 0, 0), (0, 1, 0), -2, 2, 3)])
    >>> report = limit_violations(arm, np.array([[0.0], [0.0], [0.0], [2.1]]), fps=30)
    >>> report.angle.tolist(), report.speed.tolist()
    ([0.25], [0.5])
    """
    past = (angles < body.low - 1e-6) | (angles > body.high + 1e-6)
    fast = np.abs(hinge_speeds(angles, fps)) > body.speed * (1 + 1e-6)
    return Violations(body.names, past.mean(axis=0), fast.mean(axis=0))
