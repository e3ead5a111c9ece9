"""Where a captured body leaps: joints that are elsewhere from one frame to the next, as nobody can move.

Markers that are taken for each other, frames that were lost and takes that were put together all do it. Speed alone
does not tell them from a kick: a kick gathers speed over some frames, a leap has it for one. What counts is how much
faster a joint is in a frame than just before and after. Dances, kicks and runs stay below 6 m/s of that at 30 frames a
second, and the less the more frames there are; knees that a capture put on the wrong side have 9 to 50.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from onbeat._shapes import Array, Bools, Positions
from onbeat.motion.body import Body
from onbeat.motion.held import held_poses
from onbeat.motion.motion import Motion
from onbeat.motion.runs import runs

LEAP = 8.0
"""m/s by which a joint that leaps is faster than just before and after."""
STEP = 1 / 120
"""Seconds over which speeds are read at least: the jitter of faster cameras is no leap."""
COARSE = 24.0
"""Frames a second below which steps are so long that dancers gather speed within one."""
RIM = 0.05
"""Seconds before and after a leap that are as bad: captures go astray over some frames."""
SHORT = 0.5
"""Seconds between two leaps under which what lies there is no movement by itself."""
FROZEN = 0.005
"""m/s: a body of which no joint is faster stands as no living one does."""
ENDS = ("hand", "toe")
"""Parts whose leaps bar nothing: fingers and toes are small, and captures have them wrong most often."""


def leap_speeds(positions: Positions, fps: float) -> Array:
    """(F − 1, J) m/s by which points (F, J, 3) are faster from one frame to the next than just before and after.

    Examples
    --------
    >>> path = np.zeros((60, 1, 3))
    >>> path[30:] = 0.5
    >>> speeds = leap_speeds(path, 60)
    >>> np.flatnonzero(speeds[:, 0] > LEAP).tolist(), round(float(speeds.max()))
    ([28, 29, 30], 52)
    """
    stride = max(round(fps * STEP), 1)
    if len(positions) <= stride:
        return np.zeros((max(len(positions) - 1, 0), positions.shape[1]))
    steps = (positions[stride:] - positions[:-stride]) * (fps / stride)
    padded = np.pad(steps, ((stride, stride), (0, 0), (0, 0)), mode="edge")
    surplus = np.linalg.norm(steps - (padded[: -2 * stride] + padded[2 * stride :]) / 2, axis=-1)
    surplus *= min(fps / COARSE, 1.0) ** 2
    around = np.pad(surplus, ((stride - 1, stride - 1), (0, 0)))  # a frame is within several steps
    return sliding_window_view(around, stride, axis=0).max(axis=-1)


def body_leaps(motion: Motion, body: Body) -> Array:
    """(F − 1, roles) as :func:`leap_speeds`, of the joints that :func:`leaping_joints` names.

    A pose of reference in front or at the end (see ``held``) is no part of the movement: it does not leap from there.
    """
    held, joints = held_poses(motion), leaping_joints(body)
    moving = slice(held.first, len(motion) - held.last)
    found = np.zeros((len(motion) - 1, len(joints)))
    found[moving.start : moving.stop - 1] = leap_speeds(motion.positions[moving, joints], motion.fps)
    return found


def leaping_joints(body: Body) -> list[int]:
    """The joints that are looked at: those that play a role, but for fingers and toes."""
    return sorted({joint for role, joint in body.joints.items() if not role.endswith(ENDS)})


def frames_to_use(positions: Positions, fps: float, leaps: Bools) -> Bools:
    """(F,) false at leaps (F − 1,) of points (F, J, 3), close to them, and where there is nothing but leaps around.

    What was lost or put in front by an exporter (zeros, a T-pose) lies frozen between leaps, or is short, and is left
    out with them.

    Examples
    --------
    >>> path = np.random.default_rng(0).normal(0, 0.001, (240, 1, 3))
    >>> path[100:115] = -0.9
    >>> good = frames_to_use(path, 60, (leap_speeds(path, 60) > LEAP).any(axis=1))
    >>> np.flatnonzero(~good)[[0, -1]].tolist()
    [95, 119]
    """
    good = np.ones(len(positions), np.bool_)
    at = np.flatnonzero(leaps).tolist()
    if not at:
        return good
    rim = round(RIM * fps)
    for frame in at:
        good[max(frame - rim, 0) : frame + 2 + rim] = False
    for first, last in runs(good):
        if last - first < SHORT * fps and first > 0 and last < len(good):
            good[first:last] = False
    speeds = np.linalg.norm(np.diff(positions, axis=0), axis=-1).max(axis=1) * fps
    for first, last in runs(speeds < FROZEN):  # frames first … last are alike
        if leaps[max(first - 1, 0)] or leaps[min(last, len(leaps) - 1)]:
            good[first : last + 1] = False
    return good
