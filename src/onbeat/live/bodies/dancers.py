"""Bodies that dance live: how a timeline's channels become the poses that leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from onbeat._shapes import Array, Float32, Ints, Rotations, Times
from onbeat.live.bodies.soles import Soles
from onbeat.live.bodies.turned import Turned
from onbeat.live.protocol import RATE, Pose, no_angles
from onbeat.motion import rotations as rot
from onbeat.motion.hinges import HingeBody, hinge_motion
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.skeleton import Skeleton
from onbeat.retime.stream import Bounds, Followed


class Dancer(Protocol):
    """A body on a timeline."""

    @property
    def followed(self) -> Followed:
        """Its channels."""
        ...

    @property
    def bounds(self) -> Bounds:
        """What they keep to."""
        ...

    def start(self, own: float) -> Array:
        """(n,) channels at a second of the timeline."""
        ...

    def poses(self, first: int, values: Array, own: Times) -> list[Pose]:
        """Poses with numbers from ``first`` on, of channels (N, n) at the timeline's seconds (N,)."""
        ...


@dataclass(frozen=True, eq=False)
class Character:
    """A character.

    Parameters
    ----------
    turned : its channels.
    skeleton : its bones.
    points : (P,) joints whose places are told.
    soles : its feet, which do not sink into the floor.
    """

    turned: Turned
    skeleton: Skeleton
    points: Ints
    soles: Soles

    @property
    def followed(self) -> Followed:
        """Rotation vectors of the joints above its legs."""
        return self.turned

    @property
    def bounds(self) -> Bounds:
        """As fast as its clips are, and some room."""
        return self.turned.bounds

    def start(self, own: float) -> Array:
        """(n,) channels at a second of the timeline."""
        return self.turned.start(own)

    def poses(self, first: int, values: Array, own: Times) -> list[Pose]:
        """Its rotations, its root's way, and the places of its joints."""
        rotations, roots = self.turned.made(values, own)
        places = forward_kinematics(self.skeleton, rotations, roots)[1]
        rotations, places = self.soles.pressed(rotations, roots, places)
        points = places[:, self.points].astype(np.float32)
        return _poses(first, roots, rotations, np.tile(no_angles(), (len(own), 1)), points)


class Hinged(Protocol):
    """A timeline of a robot's."""

    def angles(self, times: Times) -> Array:
        """(N, n) radians."""
        ...

    def root(self, times: Times) -> tuple[Array, Rotations]:
        """Positions (N, 3) and rotations (N, 4)."""
        ...


@dataclass(frozen=True, eq=False)
class Machine:
    """A robot.

    Parameters
    ----------
    line : its timeline.
    body : its hinges.
    bounds : what they keep to.
    drawn : its skeleton, and after that the ends of what it is drawn of.
    points : (P,) joints of that whose places are told.
    """

    line: Hinged
    body: HingeBody
    bounds: Bounds
    drawn: Skeleton
    points: Ints

    @property
    def followed(self) -> Followed:
        """Its hinges."""
        return self

    def values(self, own: Times, near: Array) -> Array:
        """(N, n) radians; hinges have ranges, and no branches."""
        del near
        return self.line.angles(own)

    def start(self, own: float) -> Array:
        """(n,) radians at a second of the timeline."""
        return self.line.angles(np.array([own]))[0]

    def poses(self, first: int, values: Array, own: Times) -> list[Pose]:
        """Its angles, its root's way, and the places of its joints."""
        roots, turns = self.line.root(own)
        points = points_of(self, roots, turns, values)
        return _poses(first, roots, turns[:, None], values, points)


def points_of(machine: Machine, roots: Array, turns: Rotations, angles: Array) -> Float32:
    """(N, P, 3) metres: the places that are told of a robot with hinges at angles (N, n)."""
    motion = hinge_motion(machine.body, roots, turns, angles, RATE)
    rotations = np.tile(rot.IDENTITY, (len(roots), len(machine.drawn), 1))
    rotations[:, : len(motion.skeleton)] = motion.rotations
    places = forward_kinematics(machine.drawn, rotations, roots)[1]
    return places[:, machine.points].astype(np.float32)


def _poses(first: int, roots: Array, rotations: Rotations, angles: Array, points: Float32) -> list[Pose]:
    turned = rot.normalise(rotations)
    return [Pose(first + k, (first + k) / RATE, roots[k], turned[k], angles[k], points[k]) for k in range(len(roots))]
