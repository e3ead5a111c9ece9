"""Dances as channels and back: robots by their hinges, characters by rotation vectors, tables of angles by themselves.

Whatever has no limits goes with the time alone: the root's path, a character's legs (their feet stay where they are
planted, for poses are the same ones, only at other times).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import BodyError, PlanError
from onbeat.limits.limits import Limits
from onbeat.motion.hinges import HingeBody, hinge_angles, hinge_motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton
from onbeat.motion.unitree_g1 import G1
from onbeat.retime.bspline import Spline
from onbeat.retime.channels import Turning
from onbeat.retime.upper_body import above_the_legs

FLOOR = 0.2
"""Least share of a joint's speed that each of its three components may have, beside what the dance gives it."""
LASTING = 0.1
"""Seconds over which the direction is taken in which a joint turns."""


@dataclass(frozen=True, eq=False)
class Table:
    """A table of angles.

    All sources have a ``name``, ``joints`` that have limits with ``size`` channels each, a ``curve`` of these channels
    over the dance's own seconds (its knots are the frames), the ``speed`` that bounds their velocity, and ``made``.
    """

    angles: JointAngles
    size: int = 1

    @property
    def name(self) -> str:
        """The file's."""
        return self.angles.name

    @property
    def joints(self) -> tuple[str, ...]:
        """All of them."""
        return self.angles.names

    @cached_property
    def curve(self) -> Spline:
        """Through its rows."""
        return Spline.through(self.angles.angles, self.angles.fps)

    def speed(self, limits: Limits, wish: Spline) -> Array:
        """(controls − 1, channels) bounds for a wish that is the curve in another time: the same at all times."""
        return np.broadcast_to(limits.speed, (len(wish.controls) - 1, len(limits)))

    def made(self, values: Array, times: Times, fps: float) -> JointAngles:
        """A table of values (N, channels); what else there is to the dance is as at own times (N,)."""
        del times
        return JointAngles(self.joints, values, fps, self.name)


@dataclass(frozen=True, eq=False)
class Robot:
    """A motion of a robot whose hinges are known."""

    motion: Motion
    body: HingeBody
    size: int = 1

    @property
    def name(self) -> str:
        """The motion's."""
        return self.motion.name

    @property
    def joints(self) -> tuple[str, ...]:
        """All hinges."""
        return self.body.names

    @cached_property
    def curve(self) -> Spline:
        """Through the angles of its frames."""
        return Spline.through(hinge_angles(self.body, self.motion), self.motion.fps)

    def speed(self, limits: Limits, wish: Spline) -> Array:
        """The same at all times."""
        return np.broadcast_to(limits.speed, (len(wish.controls) - 1, len(limits)))

    def made(self, values: Array, times: Times, fps: float) -> Motion:
        """The robot with these angles on the path of its own times."""
        along = self.motion.at(times)
        return hinge_motion(self.body, along.root_positions, along.rotations[:, 0], values, fps, self.name)


@dataclass(frozen=True, eq=False)
class Character:
    """A motion whose chosen joints turn freely about three axes."""

    motion: Motion
    chosen: tuple[int, ...]
    size: int = 3

    @property
    def name(self) -> str:
        """The motion's."""
        return self.motion.name

    @property
    def joints(self) -> tuple[str, ...]:
        """The chosen ones."""
        return tuple(self.motion.skeleton.names[joint] for joint in self.chosen)

    @cached_property
    def turning(self) -> Turning:
        """Their rotation vectors."""
        return Turning.of(self.motion, self.chosen)

    @cached_property
    def curve(self) -> Spline:
        """Through the vectors' components."""
        return Spline.through(self.turning.vectors.reshape(len(self.motion), 3 * len(self.chosen)), self.motion.fps)

    def speed(self, limits: Limits, wish: Spline) -> Array:
        """A box about each joint's velocity that has its far corner at the joint's speed, in the direction it turns.

        A vector inside is never longer than the speed; one that keeps the direction may be nearly as long.
        """
        squares = np.square(wish.differences(1)).reshape(-1, len(limits), 3)
        wide = max(round(LASTING / wish.knots.step), 1)
        summed = np.cumsum(np.pad(squares, ((wide + 1, wide), (0, 0), (0, 0)), mode="edge"), axis=0)
        mean = np.maximum(summed[2 * wide + 1 :] - summed[: -2 * wide - 1], 0.0) + 1e-12
        shares = np.sqrt(mean / mean.sum(axis=2, keepdims=True) + FLOOR**2)
        shares /= np.linalg.norm(shares, axis=2, keepdims=True)
        return (shares * limits.speed[:, None]).reshape(len(squares), -1)

    def made(self, values: Array, times: Times, fps: float) -> Motion:
        """The character with these vectors, the rest of it as at its own times."""
        along = self.motion.at(times)
        rotations = along.rotations.copy()
        rotations[:, list(self.chosen)] = self.turning.rotations(values.reshape(len(values), -1, 3))
        return along.replace(rotations=rotations, fps=fps)


Source = Table | Robot | Character
"""A dance that can be retimed."""


def source_of(dance: Motion | JointAngles, joints: Sequence[str] | None = None) -> Source:
    """The dance as channels.

    Parameters
    ----------
    dance : a table of a robot's angles, a motion of the Unitree G1, or any other motion: a character.
    joints : of a character those that are to be inside limits; all but the legs and what carries them without it.

    Raises
    ------
    PlanError
        If a joint is not in the skeleton or has no rotation of its own, there is none, or joints are told of a robot.
    """
    if isinstance(dance, JointAngles) or is_g1(dance):
        if joints is not None:
            raise PlanError("all hinges of a robot are inside its limits; joints are told of characters alone")
        return Table(dance) if isinstance(dance, JointAngles) else Robot(dance, G1)
    chosen = _told(dance.skeleton, joints) if joints is not None else above_the_legs(dance.skeleton)
    if not chosen:
        raise PlanError(
            f"{dance.name or 'the dance'} has no joint but its root and legs to keep inside limits; tell some"
        )
    return Character(dance, chosen)


def is_g1(motion: Motion) -> bool:
    """Whether a motion's skeleton is the Unitree G1."""
    try:
        G1.found_in(motion.skeleton)
    except BodyError:
        return False
    return True


def _told(skeleton: Skeleton, joints: Sequence[str]) -> tuple[int, ...]:
    out = list[int]()
    for name in joints:
        joint = skeleton.index(name)
        if skeleton.end_sites[joint]:
            raise PlanError(f"{name} is the end of a bone and has no rotation of its own")
        out.append(joint)
    return tuple(dict.fromkeys(out))
