"""A dance on a robot's legs that steps where the dancer steps."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.gentle import Bounds, gentle
from onbeat.robots.legs.contacts import Danced
from onbeat.robots.legs.footfalls import Stand, footfalls
from onbeat.robots.legs.hips import (
    CROUCHED,
    GUARD,
    PUSH,
    SPIN,
    TWIST,
    bounded,
    hip_heights,
    hips_apart,
    leaning,
    standing_height,
)
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.reach import reachable
from onbeat.robots.legs.tasks import Footing, steps
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations, motion_of

FOLLOWING = 0.25
"""Seconds, standard deviation: how smoothly the root follows the middle of the feet."""
SWAY = 0.08
"""Metres by which the hips leave the middle of the feet at most."""


def stepping(motion: Motion, robot: Robot) -> Danced:
    """The dance with the dancer's steps: feet flat and still while they stand, lifted and set down flat between.

    Parameters
    ----------
    motion : of the robot, on whatever legs.
    robot : the model.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or the robot has not two legs of six hinges.
    """
    legs, qpos, fps = Legs.of(robot).within(GUARD), configurations(robot, motion), motion.fps
    footing = Footing.of(legs, qpos, fps)
    first = Stand(footing.middles[0, :, :2], footing.headings[0])
    falls = footfalls(first, steps(footing, fps), hips_apart(legs), motion.duration)
    middles, headings, standing = falls.paths(len(qpos), fps)
    turns = rot.yaw(headings)
    soles = np.stack([leg.sole for leg in legs.both])
    places = middles - rot.rotate(turns, np.broadcast_to(soles, middles.shape))
    centre = gaussian_filter1d(middles.mean(axis=1)[:, :2], FOLLOWING * fps, axis=0, mode="nearest")
    heading = gaussian_filter1d(headings.mean(axis=1), FOLLOWING * fps, mode="nearest")
    wanted = _root(legs, qpos, footing, centre, heading, fps)
    ease = np.zeros((len(qpos), 7))
    ease[:, :2], ease[:, 2] = centre, standing_height(legs, CROUCHED)
    ease[:, 3:] = rot.yaw(heading)
    done = reachable(legs, wanted, ease, places, turns, fps)
    return Danced(motion_of(robot, done, fps, motion.name), standing)


def _root(legs: Legs, qpos: Array, footing: Footing, centre: Array, heading: Array, fps: float) -> Array:
    """The configurations with the root over its own feet as the dancer's is over theirs."""
    wanted = qpos.copy()
    yaw, tilt = leaning(qpos[:, 3:7], fps)
    twist = yaw - footing.headings.mean(axis=1)
    twist = gaussian_filter1d(twist - 2 * np.pi * np.round(np.median(twist) / (2 * np.pi)), 0.1 * fps, mode="nearest")
    turn = gentle(heading + bounded(twist, TWIST), fps, Bounds(acceleration=SPIN))
    wanted[:, 3:7] = rot.multiply(rot.yaw(turn), tilt)
    away = qpos[:, :2] - gaussian_filter1d(footing.middles.mean(axis=1)[:, :2], FOLLOWING * fps, axis=0, mode="nearest")
    size = np.linalg.norm(away, axis=1, keepdims=True)
    away = away * (bounded(size, SWAY) / np.maximum(size, 1e-9))
    wanted[:, :2] = np.stack([gentle(each, fps, Bounds(acceleration=PUSH)) for each in (centre + away).T], axis=1)
    wanted[:, 2] = hip_heights(legs, qpos[:, 2], fps)
    return wanted
