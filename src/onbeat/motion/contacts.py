"""When each foot stands on the floor.

A point of the foot (toe or ankle) touches while it is both slow and low. The floor is found in each clip, so that a
capture whose floor is a few centimetres off is read right; frames in which the feet leap elsewhere and back, as lost
ones do, have no say in it. All thresholds are in metres and seconds: the same clip at 30, 60 or 120 frames per second
gives the same contacts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d, label

from onbeat._shapes import Array, Bools, Positions, Rotations
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.leaps import LEAP, frames_to_use, leap_speeds
from onbeat.motion.motion import Motion
from onbeat.motion.runs import runs as runs  # asked for here by most who read contacts

SIDES = ("left", "right")
SMOOTHING = 0.025
"""Seconds, standard deviation of the smoothing of foot paths before their speed is read."""
SLOW, SLOWER = 0.55, 0.3
"""m/s: a contact lasts while the point is slower than the first, if it is ever slower than the second."""
LOW, LOWER = 0.07, 0.04
"""Metres above the floor: a contact lasts while the point is under the first, if it is ever under the second."""
UNDER = 0.15
"""Metres: nothing rests further than this under the floor."""
SHORTEST = 0.1
"""Seconds: shorter contacts are none, and shorter gaps inside one are filled."""
FLOOR_PERCENTILE = 2.0
"""Part (%) of the heights of a point that may lie under its floor."""
GOOD = 0.5
"""Part of the frames that must be free of leaps for the others to be left out."""


@dataclass(frozen=True)
class Contacts:
    """Which part of which foot touches the floor.

    Parameters
    ----------
    toes, heels : (F, 2) true where the toe, the ankle of the left and right foot rests.
    toe_floor, heel_floor : metres, the height of toes and ankles when they rest.
    """

    toes: Bools
    heels: Bools
    toe_floor: float
    heel_floor: float

    @property
    def feet(self) -> Bools:
        """(F, 2) true where any part of the left, right foot rests."""
        return self.toes | self.heels


def foot_contacts(motion: Motion, body: Body | None = None) -> Contacts:
    """Contacts of both feet with the floor; a body without toes is read by its ankles alone."""
    body = Body.of(motion.skeleton) if body is None else body
    ankles = motion.positions[:, body.indices("left_ankle", "right_ankle")]
    heels, heel_floor = resting(ankles, motion.fps)
    if "left_toe" not in body or "right_toe" not in body:
        return Contacts(np.zeros_like(heels), heels, heel_floor, heel_floor)
    toes, toe_floor = resting(motion.positions[:, body.indices("left_toe", "right_toe")], motion.fps)
    return Contacts(toes, heels, toe_floor, heel_floor)


def resting(paths: Positions, fps: float) -> tuple[Bools, float]:
    """Where points (F, P, 3) of one kind rest, (F, P), and the height in metres at which they do.

    Slow and low, with hysteresis: a stretch under the loose thresholds counts if part of it is under the tight ones.

    Examples
    --------
    >>> still = np.zeros((60, 1, 3))
    >>> rests, floor = resting(still, 60)
    >>> bool(rests.all()), floor
    (True, 0.0)
    """
    heights = paths[..., 2]
    leaps = np.asarray((leap_speeds(paths, fps) > LEAP).any(axis=1))
    good = frames_to_use(paths, fps, leaps)
    good |= good.mean() < GOOD  # of noise alone nothing can be told apart
    floor = float(np.percentile(heights[good], FLOOR_PERCENTILE, axis=0).min())
    speeds = point_speeds(paths, fps)
    loose = (speeds < SLOW) & (heights < floor + LOW) & (heights > floor - UNDER)
    tight = (speeds < SLOWER) & (heights < floor + LOWER)
    rests = np.stack([_settled(loose[:, p], tight[:, p], fps) for p in range(paths.shape[1])], axis=1)
    return rests, floor


def point_speeds(paths: Positions, fps: float) -> Array:
    """Speeds in m/s (F, P) of lightly smoothed paths (F, P, 3)."""
    if len(paths) < 2:
        return np.zeros(paths.shape[:-1])
    smooth = gaussian_filter1d(paths, SMOOTHING * fps, axis=0, mode="nearest")
    return np.linalg.norm(np.gradient(smooth, axis=0), axis=-1) * fps


def twist(a: Rotations, b: Rotations) -> float:
    """Radians about the vertical by which ``b`` (4,) is turned against ``a`` (4,), −π…π."""
    turn = rot.multiply(b, rot.inverse(a))
    return float(np.angle(np.exp(2j * np.arctan2(turn[3], turn[0]))))


def _settled(loose: Bools, tight: Bools, fps: float) -> Bools:
    stretches, _ = label(loose)  # pyright: ignore[reportGeneralTypeIssues]
    rests = loose & np.isin(stretches, np.unique(stretches[tight]))
    frames = len(rests)
    for first, last in runs(~rests):
        if last - first < SHORTEST / 2 * fps and first > 0 and last < frames:
            rests[first:last] = True
    for first, last in runs(rests):
        if last - first < SHORTEST * fps and first > 0 and last < frames:
            rests[first:last] = False
    return rests
