"""Footfalls that a robot can do: the dancer's steps, as long, as wide and as quick as its legs allow.

Between two steps both feet stand for :data:`BOTH` seconds, and a step takes :data:`QUICKEST` at least; a step for which
there is no time is left out, and the foot's next one makes up for it. Where a foot comes down is limited against the
other one, which stands.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.motion.contacts import SIDES
from onbeat.robots.legs.tasks import Task

BOTH = 0.2
"""Seconds for which both feet stand between steps."""
QUICKEST, SLOWEST = 0.36, 0.8
"""Seconds of a step."""
CLEARANCE, HIGHEST = 0.04, 0.08
"""Metres by which a stepping foot is lifted at least and at most."""
NEAREST, WIDEST = 0.8, 1.15
"""Parts of the hips' width by which the feet are apart; on one foot, the other's ankle has to roll for more."""
LONGEST = 0.22
"""Metres by which a foot comes down before or behind the other at most."""
TOES_IN, TOES_OUT = 0.1, 0.5
"""Radians by which a foot is turned in, out against the other."""
NOTHING = 0.02
"""Metres, and tenths of a radian: a step that is shortened to less is left out."""


@dataclass(frozen=True)
class Stand:
    """Where the soles' middles are (2, 2) in metres and how the feet are turned (2,) in radians."""

    middles: Array
    headings: Array

    def moved(self, side: int, middle: Array, heading: float) -> Stand:
        """The same with one foot elsewhere."""
        middles, headings = self.middles.copy(), self.headings.copy()
        middles[side], headings[side] = middle, heading
        return Stand(middles, headings)

    def within(self, side: int, hips: float) -> Stand:
        """The same with one foot brought to where it may be against the other."""
        other, sign = 1 - side, (1.0, -1.0)[side]
        turn = sign * (self.headings[side] - self.headings[other])
        heading = self.headings[other] + sign * float(np.clip(turn, -TOES_IN, TOES_OUT))
        facing = (heading + self.headings[other]) / 2
        c, s = np.cos(facing), np.sin(facing)
        axes = np.array([[c, s], [-s, c]])
        ahead, across = axes @ (self.middles[side] - self.middles[other])
        ahead = float(np.clip(ahead, -LONGEST, LONGEST))
        across = sign * float(np.clip(sign * across, NEAREST * hips, WIDEST * hips))
        return self.moved(side, self.middles[other] + np.array([ahead, across]) @ axes, heading)


@dataclass(frozen=True, eq=False)
class Footfalls:
    """A stand, and the steps (with their places) that follow."""

    first: Stand
    steps: tuple[Task, ...]

    def paths(self, frames: int, fps: float) -> tuple[Array, Array, Bools]:
        """The soles' middles (F, 2, 3), the feet's headings (F, 2), and which of them stand (F, 2)."""
        times = np.arange(frames) / fps
        middles = np.zeros((frames, 2, 3))
        middles[..., :2] = self.first.middles
        headings, standing = np.tile(self.first.headings, (frames, 1)), np.ones((frames, 2), np.bool_)
        for step in self.steps:
            side = SIDES.index(step.foot)
            part = np.clip((times - step.start) / (step.end - step.start), 0, 1)
            share = part**3 * (10 - 15 * part + 6 * part**2)
            middles[:, side, :2] += share[:, None] * (np.array(step.place) - middles[-1, side, :2])
            headings[:, side] += share * (step.heading - headings[-1, side])
            middles[:, side, 2] += step.height * (4 * part * (1 - part)) ** 3
            standing[:, side] &= (times <= step.start) | (times >= step.end)
        return middles, headings, standing


def footfalls(first: Stand, steps: list[Task], hips: float, duration: float) -> Footfalls:
    """What a robot makes of a dancer's steps.

    Parameters
    ----------
    first : how the dancer stands at first.
    steps : the dancer's, by their start.
    hips : metres between the robot's legs.
    duration : seconds of the dance.
    """
    stand = start = first.within(1, hips)
    done = list[Task]()
    free = BOTH
    for step in _timed(steps, duration):
        side = SIDES.index(step.foot)
        after = stand.moved(side, np.array(step.place), step.heading).within(side, hips)
        way = np.linalg.norm(after.middles[side] - stand.middles[side])
        if step.start < free or (way < NOTHING and abs(after.headings[side] - stand.headings[side]) < 10 * NOTHING):
            continue
        height = float(np.clip(step.height, CLEARANCE, HIGHEST))
        place = (float(after.middles[side, 0]), float(after.middles[side, 1]))
        done.append(replace(step, place=place, heading=float(after.headings[side]), height=height))
        stand, free = after, step.end + BOTH
    return Footfalls(start, tuple(done))


def _timed(steps: list[Task], duration: float) -> list[Task]:
    """The steps with the time that a robot needs, about the middle of the dancer's own; of two at once the longer."""
    out = list[Task]()
    for step in steps:
        long = float(np.clip(step.end - step.start, QUICKEST, SLOWEST))
        middle = (step.start + step.end) / 2
        timed = replace(step, start=middle - long / 2, end=middle + long / 2)
        if timed.start < BOTH or timed.end > duration - BOTH:
            continue
        out.append(timed)
    return sorted(out, key=lambda step: step.start)
