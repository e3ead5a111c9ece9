"""The legs' inverse kinematics: the hinges' angles that bring a foot to a place and a turn, for many frames.

Damped Gauss–Newton on the pose's error e = (place, rotation vector) in metres and radians,

    Δq = Jᵀ (J Jᵀ + λ 1)⁻¹ e,

with the geometric Jacobian J and a small λ; a hinge at its limit is held there. All frames start from one bent leg and
take the same way, so that neighbouring frames end in the same knee: what depends on the target smoothly stays smooth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numba
import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations, frozen
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.robots.engine import engine
from onbeat.robots.model import Robot

DAMPING = 1e-9
STEP = 0.4
"""Radians by which a hinge turns at most in one iteration."""
CLOSE = 1e-9
"""Metres and radians at which a pose is met."""
BENT = 0.7
"""Radians of the knee in the pose from which the search starts."""
MOST = 60
"""Iterations at most; six are usual."""
STRAIGHTEST = 0.12
"""Radians to which a knee stays bent: a straight one has to turn ever faster for the same way of the hip."""


class Solved(NamedTuple):
    """Angles (F, k) in radians, and how far the foot is from its target (F,), metres and radians together."""

    angles: Array
    away: Array


@dataclass(frozen=True, eq=False)
class Leg:
    """The k hinges from a robot's root down to a foot, in the root's frame.

    Parameters
    ----------
    side : left or right.
    hinges : (k,) their numbers among the robot's hinges.
    offsets : (k + 1, 3) metres from each hinge to the next, from the root first and to the foot's link last.
    axes : (k, 3) of the hinges in the zero configuration.
    low, high : (k,) radians.
    start : (k,) radians, the bent leg from which angles are searched.
    knee : which of the k is the knee.
    corners : (4, 3) metres, the sole's corners from the foot's link, as they are in the zero configuration.
    """

    side: str
    hinges: Ints
    offsets: Positions
    axes: Positions
    low: Array
    high: Array
    start: Array
    knee: int
    corners: Positions

    @classmethod
    def of(cls, robot: Robot, side: str) -> Leg:
        """The left or right leg of a robot.

        Raises
        ------
        BodyError
            If there is no such foot, fewer than six hinges lead to it, or which of them is the knee is not known.
        """
        if side not in robot.feet:
            raise BodyError(f"{robot.name} has no {side} foot; it has {', '.join(robot.feet) or 'none'}")
        mujoco, model, foot = engine(), robot.model, robot.feet[side]
        data = mujoco.MjData(model)
        data.qpos[:] = 0
        data.qpos[3] = 1
        mujoco.mj_kinematics(model, data)
        link = data.body(foot.link)
        joints = _joints_to(model, link.id)
        if len(joints) < 6:
            raise BodyError(
                f"{robot.name}: {len(joints)} hinges lead to {foot.link}, not counting any that only follow another; a "
                "foot needs 6 to stand flat wherever the hips are, so it cannot be put on its feet; a dance that is a "
                "table of its joint angles can be retimed: onbeat retime ANGLES.csv --limits FILE"
            )
        places = np.concatenate((np.zeros((1, 3)), data.xanchor[joints], link.xpos[None]))
        names = [model.joint(j).name for j in joints]
        hinges = np.array([robot.body.names.index(name) for name in names])
        low, high, axes = robot.body.low[hinges].copy(), robot.body.high[hinges].copy(), data.xaxis[joints]
        knee = _knee(robot, side, names)
        _keep_bent(low, high, knee)
        corners = rot.rotate(np.tile(link.xquat, (len(foot.corners), 1)), np.asarray(foot.corners, np.float64))
        return cls(
            side,
            frozen(hinges, np.int64),
            frozen(np.diff(places, axis=0)),
            frozen(axes),
            frozen(low),
            frozen(high),
            frozen(_bent(axes, low, high, knee)),
            knee,
            frozen(corners),
        )

    def within(self, guard: float) -> Leg:
        """The same leg whose hinges stay some radians inside their limits."""
        guards = np.minimum(guard, (self.high - self.low) / 4)
        return replace(self, low=frozen(self.low + guards), high=frozen(self.high - guards))

    @property
    def sole(self) -> Positions:
        """(3,) metres from the foot's link to the middle of its sole."""
        return self.corners.mean(axis=0)

    def pose(self, angles: Array) -> tuple[Positions, Rotations]:
        """Places (F, 3) and turns (F, 4) of the foot against the root, for angles (F, k)."""
        place, turn = np.zeros((len(angles), 3)), np.tile(rot.IDENTITY, (len(angles), 1))
        for n, axis in enumerate(self.axes):
            place = place + rot.rotate(turn, self.offsets[n])
            turn = rot.multiply(turn, rot.about(axis, angles[:, n]))
        return place + rot.rotate(turn, self.offsets[-1]), turn

    def solve(self, places: Positions, turns: Rotations, start: Array | None = None) -> Solved:
        """Angles that bring the foot to places (F, 3) and turns (F, 4) against the root, inside the limits.

        A target beyond reach is approached; :attr:`Solved.away` tells by how much it is missed.
        """
        first = np.broadcast_to(self.start if start is None else start, (len(places), len(self.axes)))
        chain = (np.asarray(self.offsets), np.asarray(self.axes), np.asarray(self.low), np.asarray(self.high))
        angles, away = _solve(places, rot.to_matrix(turns), np.array(first), *chain)
        return Solved(angles, away)


@dataclass(frozen=True, eq=False)
class Legs:
    """Both legs of a robot, left first."""

    both: tuple[Leg, Leg]

    @classmethod
    def of(cls, robot: Robot) -> Legs:
        """The legs of a robot; a ``BodyError`` where it does not stand on two feet, or its root is not the pelvis."""
        left, right = Leg.of(robot, "left"), Leg.of(robot, "right")
        shared = [robot.body.names[hinge] for hinge in left.hinges if hinge in right.hinges]
        if shared:
            raise BodyError(
                f"{robot.name}: {', '.join(shared)} {'are' if shared[1:] else 'is'} between its root, "
                f"{robot.body.skeleton.names[0]}, and both its legs; a file whose root is the pelvis is expected"
            )
        return cls((left, right))

    def feet(self, qpos: Array) -> tuple[Positions, Rotations]:
        """Places (F, 2, 3) and turns (F, 2, 4) of the feet in the world, of configurations (F, 7 + n)."""
        poses = [leg.pose(qpos[:, 7 + leg.hinges]) for leg in self.both]
        root = qpos[:, None, 3:7]
        places = qpos[:, None, :3] + rot.rotate(root, np.stack([place for place, _ in poses], axis=1))
        return places, rot.multiply(root, np.stack([turn for _, turn in poses], axis=1))

    def standing(self, qpos: Array, places: Positions, turns: Rotations, warm: bool = False) -> tuple[Array, Array]:
        """The configurations with the legs solved for feet at places and turns, and by how much they miss (F,).

        ``warm`` searches from the legs' angles as they are, which is quicker where they are nearly right.
        """
        out, away = qpos.copy(), np.zeros(len(qpos))
        back = rot.inverse(qpos[:, 3:7])
        for n, leg in enumerate(self.both):
            first = qpos[:, 7 + leg.hinges] if warm else None
            solved = leg.solve(rot.rotate(back, places[:, n] - qpos[:, :3]), rot.multiply(back, turns[:, n]), first)
            out[:, 7 + leg.hinges] = solved.angles
            away = np.maximum(away, solved.away)
        return out, away

    def within(self, guard: float) -> Legs:
        """The same legs whose hinges stay some radians inside their limits."""
        return Legs((self.both[0].within(guard), self.both[1].within(guard)))


def _knee(robot: Robot, side: str, names: list[str]) -> int:
    """Which of a leg's hinges is the knee."""
    knee = robot.roles.get(f"{side}_knee", "")
    if knee not in names[1:-1]:
        raise BodyError(
            f"{robot.name}: its {side} knee is {knee or 'not known'}; one of {', '.join(names[1:-1])} is expected; "
            f'tell it in {robot.name}.roles.toml beside its file: [joints] and a line like {side}_knee = "{names[3]}"'
        )
    return names.index(knee)


def _joints_to(model: Any, link: int) -> list[int]:
    joints = list[int]()
    while link > 0:
        if model.body_jntnum[link] == 1 and model.jnt_type[model.body_jntadr[link]] == 3:
            joints.insert(0, int(model.body_jntadr[link]))
        link = int(model.body_parentid[link])
    return joints


def _keep_bent(low: Array, high: Array, knee: int) -> None:
    if high[knee] > -low[knee]:
        low[knee] = max(low[knee], min(STRAIGHTEST, high[knee]))
    else:
        high[knee] = min(high[knee], max(-STRAIGHTEST, low[knee]))


def _bent(axes: Positions, low: Array, high: Array, knee: int) -> Array:
    """The knee bent to where it can, and a hinge above and one below that bend back half of it."""
    start = np.clip(np.zeros(len(axes)), low, high)
    along = axes @ axes[knee]
    start[knee] = BENT * np.sign(low[knee] + high[knee])
    for n in (int(np.argmax(np.abs(along[:knee]))), knee + 1 + int(np.argmax(np.abs(along[knee + 1 :])))):
        start[n] = -start[knee] / 2 * np.sign(along[n])
    return np.clip(start, low, high)


@numba.njit(cache=True, nogil=True)
def _turned(axis: Any, angle: float, out: Any) -> None:
    """Rodrigues' matrix."""
    x, y, z = axis
    s, c = np.sin(angle), np.cos(angle)
    d = 1 - c
    out[0, 0], out[0, 1], out[0, 2] = c + x * x * d, x * y * d - z * s, x * z * d + y * s
    out[1, 0], out[1, 1], out[1, 2] = y * x * d + z * s, c + y * y * d, y * z * d - x * s
    out[2, 0], out[2, 1], out[2, 2] = z * x * d - y * s, z * y * d + x * s, c + z * z * d


@numba.njit(cache=True, nogil=True)
def _forward(q: Any, offsets: Any, axes: Any, anchors: Any, world: Any, turn: Any, end: Any) -> None:
    """Anchors (k, 3) and axes (k, 3) of the hinges, and the place (3,) and turn (3, 3) of the end."""
    own = np.empty((3, 3))
    turn[:] = np.eye(3)
    end[:] = 0.0
    for n in range(len(q)):
        end += turn @ offsets[n]
        anchors[n] = end
        world[n] = turn @ axes[n]
        _turned(axes[n], q[n], own)
        turn[:] = turn @ own
    end += turn @ offsets[len(q)]


@numba.njit(cache=True, nogil=True)
def _rotation_vector(m: Any, out: Any) -> None:
    """The rotation vector of a matrix (3, 3), of less than half a turn."""
    out[0], out[1], out[2] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    size = np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)
    angle = np.arctan2(size, m[0, 0] + m[1, 1] + m[2, 2] - 1)
    out *= 0.5 if size < 1e-12 else angle / size


@numba.njit(cache=True, nogil=True)
def _solve(places: Any, turns: Any, angles: Any, offsets: Any, axes: Any, low: Any, high: Any) -> Any:
    frames, k = angles.shape
    away = np.empty(frames)
    anchors, world, turn, end = np.empty((k, 3)), np.empty((k, 3)), np.empty((3, 3)), np.empty(3)
    error, jacobian, step = np.empty(6), np.empty((6, k)), np.empty(k)
    for f in range(frames):
        q = angles[f]
        for iteration in range(MOST + 1):
            _forward(q, offsets, axes, anchors, world, turn, end)
            error[:3] = places[f] - end
            _rotation_vector(turns[f] @ turn.T, error[3:])
            away[f] = np.sqrt(np.sum(error**2))
            if away[f] < CLOSE or iteration == MOST:
                break
            for n in range(k):
                jacobian[:3, n] = np.cross(world[n], end - anchors[n])
                jacobian[3:, n] = world[n]
            for _ in range(k):
                step[:] = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + DAMPING * np.eye(6), error)
                held = False
                for n in range(k):
                    # A hinge at its limit is taken out, and the others turn without it.
                    over = (q[n] >= high[n] and step[n] > 0) or (q[n] <= low[n] and step[n] < 0)
                    if over and np.any(jacobian[:, n] != 0):
                        jacobian[:, n] = 0
                        held = True
                if not held:
                    break
            largest = np.max(np.abs(step))
            if largest > STEP:
                step *= STEP / largest
            if largest < 1e-12:
                break
            for n in range(k):
                q[n] = min(max(q[n] + step[n], low[n]), high[n])
    return angles, away
