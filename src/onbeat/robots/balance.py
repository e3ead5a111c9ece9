"""Balance: the hips are shifted so that the zero-moment point stays over the feet; the upper body keeps its angles.

The shift is the answer of a convex programme that is linear about the dance as it is (:mod:`onbeat.robots.shift`); the
legs are solved again for the shifted root, the point is found anew on the whole model, and so on until it is inside.
Where no shift is enough the dance itself is softened, for a moment and no more than it takes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from onbeat._shapes import Array, Bools, frozen
from onbeat.errors import BodyError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.gentle import Grid
from onbeat.robots.legs.ik import Legs
from onbeat.robots.legs.reach import reachable
from onbeat.robots.model import Robot
from onbeat.robots.shift import Feet, Programme, State
from onbeat.robots.state import configurations, motion_of

ENOUGH = 0.75
"""Part of the margin that is aimed at, at which the search ends."""
BETTER = 0.8
"""What an iteration has to leave at most of what was missing, or it is the last."""
BOUND, STRIDE = 0.08, 0.25
"""Metres by which the root is shifted at most along either axis: with feet planted, and stepping from foot to foot."""
KNOT = 0.02
"""Seconds between the knots of the shift."""
MOST = 6
"""Iterations on the whole model at most."""
SOFTENINGS = 3
"""How often the dance may be softened."""
SOFT, AROUND = 0.08, 0.25
"""Seconds: standard deviation of the smoothing where the dance is softened, and how far about what is outside."""


@dataclass(frozen=True, eq=False)
class Balanced:
    """A dance whose zero-moment point is over the feet.

    Parameters
    ----------
    motion : of the robot.
    zmp : (F, 2) metres on the floor.
    margin : (F,) metres by which it is inside the support polygon; negative outside.
    shift : (F, 2) metres by which the root was moved.
    softened : (F,) 0 where the upper body's angles are as they were, up to 1 where they are smoothed for balance.
    iterations : on the whole model.
    """

    motion: Motion
    zmp: Array
    margin: Array
    shift: Array
    softened: Array
    iterations: int

    def __post_init__(self) -> None:
        for key in ("zmp", "margin", "shift", "softened"):
            object.__setattr__(self, key, frozen(getattr(self, key)))


def balanced(
    motion: Motion, robot: Robot, standing: Bools, bound: float | None = None, soften: bool = True
) -> Balanced:
    """The dance with its hips shifted so that the zero-moment point is inside the support polygon.

    Parameters
    ----------
    motion : of the robot, with its feet where they are to be (:func:`onbeat.robots.legs.own.planted` or ``stepping``).
    robot : the model.
    standing : (F, 2) true where the left, right foot stands flat on the floor; at least one of them.
    bound : metres of the shift along either axis; without it :data:`BOUND`, and :data:`STRIDE` where there are steps.
    soften : whether angles of the upper body may change where no shift is enough; see :attr:`Balanced.softened`.

    Raises
    ------
    BodyError
        If the motion is not the robot's, it has not two legs, or on some frame no foot stands.
    """
    legs, qpos, fps = Legs.of(robot), configurations(robot, motion), motion.fps
    standing = checked_standing(standing, len(qpos))
    feet = Feet.of(legs, qpos, standing, fps)
    bound = bound or (BOUND if standing.all() else STRIDE)
    softened = np.zeros(len(qpos))
    best, shift, iterations = _settled(robot, legs, qpos, feet, fps, bound)
    for _ in range(SOFTENINGS if soften else 0):
        if best.margin.min() >= 0:
            break
        share = _near(best.margin < 0, fps)
        softened = np.maximum(softened, share)
        soft = _softer(qpos, legs, share, fps)
        qpos = reachable(legs, soft, qpos[:, :7], feet.places, feet.turns, fps)
        best, shift, more = _settled(robot, legs, qpos, feet, fps, bound)
        iterations += more
    return Balanced(motion_of(robot, best.qpos, fps, motion.name), best.zmp, best.margin, shift, softened, iterations)


def checked_standing(standing: Bools, frames: int) -> Bools:
    """The labels, if they are (frames, 2) and on each frame one foot stands; else a ``BodyError``."""
    labels = np.asarray(standing, np.bool_)
    if labels.shape != (frames, 2):
        raise BodyError(f"labels of standing feet of shape {labels.shape}; ({frames}, 2) is needed")
    if not labels.any(axis=1).all():
        frame = int(np.argmin(labels.any(axis=1)))
        raise BodyError(f"frame {frame}: no foot stands; balance needs one on the floor at all times")
    return labels


def _settled(robot: Robot, legs: Legs, qpos: Array, feet: Feet, fps: float, bound: float) -> tuple[State, Array, int]:
    """The best state that is found, its shift (F, 2), and after how many iterations."""
    grid = Grid(len(qpos), fps, KNOT)
    best = found = State.of(robot, qpos, feet, fps)
    shift = applied = np.zeros((len(qpos), 2))
    missing, iterations = _missing(best, feet), 0
    while iterations < MOST and missing > 0:
        programme = Programme.of(robot, legs, found, applied, feet, grid, bound)
        applied = programme.best(found, applied, feet)
        wanted = qpos.copy()
        wanted[:, :2] += applied
        # Unshifted the legs reach; what they do not reach after all is given up towards that.
        shifted = reachable(legs, wanted, qpos[:, :7], feet.places, feet.turns, fps)
        found = State.of(robot, shifted, feet, fps)
        iterations += 1
        now = _missing(found, feet)
        if now < missing:
            best, shift = found, applied
        if iterations > 1 and now > BETTER * missing:
            break
        missing = min(now, missing)
    return best, shift, iterations


def _missing(state: State, feet: Feet) -> float:
    """Metres by which the point is not as far inside as is enough, summed; what is outside counts ten times."""
    short = np.maximum(ENOUGH * feet.aim - state.margin, 0.0)
    return float(short.sum() + 10 * np.maximum(-state.margin, 0.0).sum())


def _near(bad: Bools, fps: float) -> Array:
    """(F,) 1 about the bad frames, smoothly to 0 farther away."""
    around = max(1, round(AROUND * fps))
    wide = maximum_filter1d(bad.astype(np.float64), 2 * around + 1)
    return gaussian_filter1d(wide, around / 3, truncate=3.0, mode="nearest")


def _softer(qpos: Array, legs: Legs, share: Array, fps: float) -> Array:
    """The configurations with a share (F,) of the root's turn and of all hinges but the legs' smoothed."""
    out = qpos.copy()
    turns = rot.continuous(qpos[:, 3:7])
    smooth = gaussian_filter1d(np.concatenate((turns, qpos[:, 7:]), axis=1), SOFT * fps, axis=0, mode="nearest")
    out[:, 3:7] = rot.slerp(turns, rot.normalise(smooth[:, :4]), share)
    legs_own = np.concatenate([leg.hinges for leg in legs.both])
    others = np.setdiff1d(np.arange(qpos.shape[1] - 7), legs_own)
    out[:, 7 + others] += share[:, None] * (smooth[:, 4 + others] - qpos[:, 7 + others])
    return out
