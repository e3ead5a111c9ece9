"""A dance with both feet planted for all of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Positions, Rotations, frozen
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.gentle import Bounds, gentle
from onbeat.robots.legs.contacts import Danced
from onbeat.robots.legs.hips import (
    CROUCHED,
    GUARD,
    PUSH,
    SPIN,
    TWIST,
    bounded,
    feet_below,
    hip_heights,
    hips_apart,
    leaning,
    standing_height,
    yaw_of,
)
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.reach import reachable
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations, motion_of
from onbeat.robots.zmp import centres_of_mass

DRIFT = 1.0
"""Seconds, standard deviation: what the root does more slowly than that is travelling and turning, not dancing."""
SWAY = 0.06
"""Metres by which the hips leave the middle at most where the feet are planted."""
APART = (0.9, 1.4)
"""How far apart the feet are planted: the dance's own median, within these parts of the hips' width."""
TOES_OUT = 0.2
"""Radians by which planted feet turn out at most."""
FORWARD = frozen(rot.yaw(np.pi / 2))
"""From facing +X, as robots' models do, to +Y, as dances begin."""


@dataclass(frozen=True)
class Stance:
    """Where feet are planted about the origin: facing +Y, so many times the hips' width apart, turned out by radians.

    Examples
    --------
    >>> from onbeat.robots.model import robot_named
    >>> places, _ = Stance().feet(Legs.of(robot_named("g1")))
    >>> bool(places[0, 0] < 0 < places[1, 0]), places[:, 1].round(2).tolist()
    (True, [-0.03, -0.03])
    """

    apart: float = 1.2
    out: float = 0.1

    def own_feet(self, legs: Legs) -> tuple[Positions, Rotations]:
        """Places (2, 3) and turns (2, 4) of the left and right foot, facing +X."""
        return feet_below(legs, self.apart * hips_apart(legs), self.out)

    def feet(self, legs: Legs) -> tuple[Positions, Rotations]:
        """Places (2, 3) and turns (2, 4) of the left and right foot, facing +Y."""
        places, turns = self.own_feet(legs)
        return rot.rotate(FORWARD, places), rot.multiply(FORWARD, turns)


def planted(motion: Motion, robot: Robot, stance: Stance | None = None) -> Danced:
    """The dance with both feet flat on the floor at fixed places, and as far as the legs reach the hips as they were.

    Of the root's path its travelling and turning (slower than :data:`DRIFT`) is left out; what is left of it is bent
    into ``±SWAY`` and ``±TWIST``. Hips go down as far as the dancer's do, from a stand with bent knees.

    Parameters
    ----------
    motion : of the robot, on whatever legs.
    robot : the model.
    stance : where the feet are; without it as the dance has them on the whole, where it began.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or the robot has not two legs of six hinges.
    """
    legs, qpos, fps = Legs.of(robot).within(GUARD), configurations(robot, motion), motion.fps
    places, turns = _planted_feet(legs, qpos) if stance is None else stance.own_feet(legs)
    wanted = qpos.copy()
    yaw, tilt = leaning(qpos[:, 3:7], fps)
    twist = gentle(bounded(yaw - _drift(yaw, fps), TWIST), fps, Bounds(acceleration=SPIN))
    wanted[:, 3:7] = rot.multiply(rot.yaw(twist), tilt)
    wanted[:, :2] = _swaying(qpos[:, :2], yaw, fps)
    wanted[:, 2] = hip_heights(legs, qpos[:, 2], fps)
    frames = (len(qpos), 1, 1)
    places, turns = np.tile(places, frames), np.tile(turns, frames)
    ease = np.tile(np.array([0, 0, standing_height(legs, CROUCHED), 1.0, 0, 0, 0]), (len(qpos), 1))
    # The mean of the centre of mass comes to the middle of the feet.
    first = legs.standing(wanted, places, turns)[0]
    away = centres_of_mass(robot, first)[:, :2].mean(axis=0) - wanted[:, :2].mean(axis=0)
    wanted[:, :2] -= away
    ease[:, :2] -= away
    done = reachable(legs, wanted, ease, places, turns, fps)
    done = _where_it_began(done, qpos, yaw) if stance is None else _facing_forward(done)
    return Danced(motion_of(robot, done, fps, motion.name), np.ones((len(qpos), 2), np.bool_))


def _where_it_began(done: Array, qpos: Array, yaw: Array) -> Array:
    """The configurations turned to the dance's first heading and moved to the middle of its root's path."""
    turn = rot.yaw(yaw[:1])
    out = done.copy()
    out[:, :3] = rot.rotate(turn, done[:, :3])
    out[:, :2] += np.median(qpos[:, :2], axis=0)
    out[:, 3:7] = rot.multiply(turn, done[:, 3:7])
    return out


def _facing_forward(done: Array) -> Array:
    out = done.copy()
    out[:, :3] = rot.rotate(FORWARD, done[:, :3])
    out[:, 3:7] = rot.multiply(FORWARD, done[:, 3:7])
    return out


def _planted_feet(legs: Legs, qpos: Array) -> tuple[Positions, Rotations]:
    """Where the feet are planted, (2, 3) and (2, 4): as far apart and turned out as in the dance, within bounds."""
    found, turned = legs.feet(qpos)
    across = rot.rotate(rot.inverse(qpos[:, 3:7]), found[:, 0] - found[:, 1])[:, 1]
    hips = hips_apart(legs)
    apart = float(np.clip(np.median(across), APART[0] * hips, APART[1] * hips))
    out = yaw_of(rot.multiply(rot.inverse(turned[:, 1]), turned[:, 0]))
    return feet_below(legs, apart, float(np.clip(np.median(out) / 2, 0, TOES_OUT)))


def _drift(values: Array, fps: float) -> Array:
    return gaussian_filter1d(values, DRIFT * fps, axis=0, mode="nearest")


def _swaying(path: Array, yaw: Array, fps: float) -> Array:
    """The root's way (F, 2) about its own slow path, as seen by one who turns with it slowly, within ±SWAY."""
    away = path - _drift(path, fps)
    heading = _drift(yaw, fps)
    c, s = np.cos(heading), np.sin(heading)
    turned = np.stack((c * away[:, 0] + s * away[:, 1], -s * away[:, 0] + c * away[:, 1]), axis=1)
    return np.stack([gentle(bounded(each, SWAY), fps, Bounds(acceleration=PUSH)) for each in turned.T], axis=1)
