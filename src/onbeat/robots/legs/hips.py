"""The hips of a robot that dances: how high they are, how they lean, sway and twist, as far as a robot's legs do."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.robots.gentle import Bounds, gentle
from onbeat.robots.legs.ik import Leg, Legs

FALL, PUSH, SPIN = 2.5, 2.0, 15.0
"""m/s² up and down, m/s² along the floor and rad/s² of turning: what the root is accelerated with at most."""
TWIST = 0.5
"""Radians by which the hips turn against the feet at most."""
UPRIGHT, CROUCHED = 0.4, 0.9
"""Radians of the knees where the dancer stands upright, and where a robot stands at ease."""
LOWEST = 0.62
"""Part of the upright height below which the hips do not go."""
HIGH = 95.0
"""Part (%) of the frames on which the hips are lower than where the dancer stands upright."""
GUARD = 0.05
"""Radians by which the legs stay inside their limits, so that balance can still move the hips."""


def bounded(values: Array, bound: float) -> Array:
    """Values bent smoothly into ``±bound``; small ones stay as they are.

    Examples
    --------
    >>> bounded(np.array([0.01, 10.0]), 0.5).round(3).tolist()
    [0.01, 0.5]
    """
    return bound * np.tanh(values / bound)


def hips_apart(legs: Legs) -> float:
    """Metres between the legs, from hip to hip."""
    return float(sum(abs(leg.offsets[: leg.knee + 1, 1].sum()) for leg in legs.both))


def feet_below(legs: Legs, apart: float, out: float) -> tuple[Positions, Rotations]:
    """Places (2, 3) and turns (2, 4) of feet on the floor about the origin: metres apart, turned out by radians."""
    turns = rot.yaw(np.array([out, -out]))
    height = [-float(leg.corners[:, 2].min()) for leg in legs.both]
    soles = rot.rotate(turns, np.stack([leg.sole for leg in legs.both]))
    places = np.array([[0, apart / 2, height[0]], [0, -apart / 2, height[1]]])
    places[:, 0] -= soles[:, 0].mean()
    return places, turns


def standing_height(legs: Legs, knee: float) -> float:
    """Metres of the root over the floor where both feet stand flat below the hips with knees bent by an angle."""
    heights = np.linspace(0.3, 1.0, 281) * _longest(legs.both[0])
    root = np.zeros((len(heights), 7))
    root[:, 2], root[:, 3] = heights, 1
    n = 7 + max(int(leg.hinges.max()) for leg in legs.both) + 1
    qpos = np.concatenate((root, np.zeros((len(heights), n - 7))), axis=1)
    places, turns = feet_below(legs, hips_apart(legs), 0.0)
    frames = (len(heights), 1, 1)
    solved, away = legs.standing(qpos, np.tile(places, frames), np.tile(turns, frames))
    left = legs.both[0]
    bend = np.abs(solved[:, 7 + left.hinges[left.knee]])
    good = (away < 1e-6) & (bend >= knee)
    return float(heights[good].max(initial=heights[0]))


def _longest(leg: Leg) -> float:
    """Metres from the root down to the sole with the leg straight."""
    offsets, corners = leg.offsets, leg.corners
    return float(-offsets[:, 2].sum() - corners[:, 2].min())


def yaw_of(q: Rotations) -> Array:
    """Turns about the vertical in radians, −π…π, of the front."""
    front = rot.rotate(q, np.array([1.0, 0, 0]))
    return np.arctan2(front[..., 1], front[..., 0])


def leaning(turns: Rotations, fps: float) -> tuple[Array, Rotations]:
    """The heading (F,), continuous, and what is left of the turns (F, 4) without it."""
    yaw = np.unwrap(yaw_of(turns))
    lean = rot.log(rot.continuous(rot.multiply(rot.yaw(-yaw), turns)))
    limits = Bounds(acceleration=SPIN / 2)
    return yaw, rot.exp(np.stack([gentle(each, fps, limits) for each in lean.T], axis=1))


def hip_heights(legs: Legs, heights: Array, fps: float) -> Array:
    """Heights (F,) of the root: the dancer's, with upright at the robot's stand, and no deeper than it can."""
    upright = standing_height(legs, UPRIGHT)
    deep = (1 - LOWEST) * upright
    down = np.maximum(np.percentile(heights, HIGH) - heights, 0.0)
    return gentle(upright - bounded(down, deep), fps, Bounds(upright - deep, upright, acceleration=FALL))
