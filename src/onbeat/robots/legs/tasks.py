"""What a dancer's legs do, as tasks: stand, squat, step with the left or the right foot (Nakaoka et al. 2005).

A foot steps while neither its heel nor its toes rest on the floor; the feet's places before and after are what the step
is for. A squat is a dip of the hips that comes back. All the rest is standing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.ndimage import gaussian_filter1d

from onbeat._shapes import Array, Bools, Positions
from onbeat.motion import rotations as rot
from onbeat.motion.contacts import SIDES, resting, runs
from onbeat.motion.motion import Motion
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot
from onbeat.robots.state import configurations

Kind = Literal["stand", "squat", "step"]

SMALLEST = 0.04
"""Metres: a foot that comes down nearer to where it stood, and was not lifted as high, has not stepped."""
TURNED = 0.2
"""Radians: a foot that comes down turned by more has stepped."""
DEEP = 0.08
"""Part of the upright hips' height: dips that are shallower are none."""
SMOOTHING = 0.1
"""Seconds, standard deviation of the smoothing of the hips' height."""


@dataclass(frozen=True)
class Task:
    """Something that the legs do.

    Parameters
    ----------
    kind : "stand", "squat" or "step".
    foot : "left" or "right" of a step, else "".
    start, end : seconds from the motion's start.
    place : of a step, metres (x, y) on the floor of the middle of the sole after it.
    heading : of a step, radians of the foot's turn after it; 0 along +X.
    height : metres, of a step by how much the sole is lifted, of a squat by how much the hips go down.
    """

    kind: Kind
    foot: str
    start: float
    end: float
    place: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0
    height: float = 0.0


@dataclass(frozen=True, eq=False)
class Footing:
    """Where a robot's soles are, frame by frame.

    Parameters
    ----------
    middles : (F, 2, 3) metres of the middle of the left and right sole.
    headings : (F, 2) radians, continuous.
    resting : (F, 2) true where the heel or the toes rest on the floor.
    floor : metres, where the soles rest.
    """

    middles: Positions
    headings: Array
    resting: Bools
    floor: float

    @classmethod
    def of(cls, legs: Legs, qpos: Array, fps: float) -> Footing:
        """The footing of configurations (F, 7 + n)."""
        places, turns = legs.feet(qpos)
        corners = np.stack([leg.corners for leg in legs.both])
        world = places[:, :, None] + rot.rotate(turns[:, :, None], corners[None])
        front = corners[0, :, 0] > corners[0, :, 0].mean()
        toes, toe_floor = resting(world[:, :, front].mean(axis=2), fps)
        heels, heel_floor = resting(world[:, :, ~front].mean(axis=2), fps)
        ahead = rot.rotate(turns, np.array([1.0, 0, 0]))
        headings = np.unwrap(np.arctan2(ahead[..., 1], ahead[..., 0]), axis=0)
        return cls(world.mean(axis=2), headings, toes | heels, min(toe_floor, heel_floor))


def tasks(motion: Motion, robot: Robot) -> list[Task]:
    """What the legs do, in order of time; steps and squats may overlap.

    Parameters
    ----------
    motion : of the robot.
    robot : the model.

    Raises
    ------
    BodyError
        If the motion is not the robot's, or it has not two legs of six hinges.
    """
    legs, qpos, fps = Legs.of(robot), configurations(robot, motion), motion.fps
    found = steps(Footing.of(legs, qpos, fps), fps) + squats(qpos[:, 2], fps)
    busy = np.zeros(len(qpos), np.bool_)
    for task in found:
        busy[round(task.start * fps) : round(task.end * fps) + 1] = True
    found += [Task("stand", "", first / fps, after / fps) for first, after in runs(~busy)]
    return sorted(found, key=lambda task: (task.start, task.end, task.foot))


def steps(footing: Footing, fps: float) -> list[Task]:
    """The steps of both feet, by their start."""
    found = list[Task]()
    for side, name in enumerate(SIDES):
        rests = footing.resting[:, side]
        stances = runs(rests)
        for (first, after), (_, later) in zip(runs(~rests), _stances_after(stances, runs(~rests)), strict=True):
            if first == 0 or after == len(rests):
                continue
            where = slice(after, later)
            place = np.median(footing.middles[where, side, :2], axis=0)
            heading = float(np.median(footing.headings[where, side]))
            lift = float(footing.middles[first:after, side, 2].max() - footing.floor)
            moved = float(np.linalg.norm(place - footing.middles[first - 1, side, :2]))
            turned = abs(heading - float(footing.headings[first - 1, side]))
            if moved > SMALLEST or turned > TURNED or lift > SMALLEST:
                ends = (first - 1) / fps, after / fps
                found.append(Task("step", name, *ends, (float(place[0]), float(place[1])), heading, lift))
    return sorted(found, key=lambda task: (task.start, task.foot))


def _stances_after(stances: list[tuple[int, int]], swings: list[tuple[int, int]]) -> list[tuple[int, int]]:
    begun = {first: (first, after) for first, after in stances}
    return [begun.get(after, (after, after + 1)) for _, after in swings]


def squats(heights: Array, fps: float) -> list[Task]:
    """The dips of the hips' height (F,) in metres below the upright stand, its 95th percentile."""
    smooth = gaussian_filter1d(heights, SMOOTHING * fps, mode="nearest")
    upright = float(np.percentile(smooth, 95))
    deep = smooth < upright * (1 - DEEP)
    down = smooth < upright * (1 - DEEP / 3)
    found = list[Task]()
    for first, after in runs(down):
        if deep[first:after].any():
            depth = upright - float(smooth[first:after].min())
            found.append(Task("squat", "", first / fps, (after - 1) / fps, height=depth))
    return found
