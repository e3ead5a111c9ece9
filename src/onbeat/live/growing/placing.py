"""Where on the floor each move of a growing dance begins, and which way it faces.

As in :mod:`onbeat.dance.sources`, but nothing is known of what will come after the move: facing and the standing foot
go on, and the join turns the move a little so that the dancer keeps to the stage.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.dance.plan import DancePlan, Move
from onbeat.dance.sources import PATH_STEP, Sources, on_ground, pivots, placed, sample, standing_at
from onbeat.dance.stage import CALM, MOST, steering
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.motion import Motion

TAIL = 0.2
"""Seconds of the last move that are looked at where it is left."""
TRAVELS = 0.15
"""Metres; a move that covers less ground is not turned for the sake of the stage."""
NUDGE = 0.03
"""Metres that a move begins nearer to the middle of the stage, where a foot is in the air in the join."""
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Placed:
    """A move that has its place.

    Parameters
    ----------
    number : counts all moves of the dance.
    move : on the dance's own clock.
    turn : radians about the vertical.
    shift : (3,) metres on the floor, after the turn.
    """

    number: int
    move: Move
    turn: float
    shift: Array

    @property
    def end(self) -> float:
        """Second of the dance at which it ends."""
        return self.move.at_s + (self.move.to_s - self.move.from_s) / self.move.rate

    def second(self, time: float) -> float:
        """Second of its clip at a second of the dance."""
        return self.move.from_s + self.move.rate * (time - self.move.at_s)

    def until(self, time: float) -> Placed:
        """The same move, left at another second of the dance."""
        return replace(self, move=replace(self.move, to_s=self.second(time)))

    def goes_on_as(self, move: Move) -> bool:
        """Whether a move shows what this one would show if it went on."""
        mine = self.move
        return (mine.clip, mine.rate) == (move.clip, move.rate) and abs(mine.to_s - move.from_s) < _SAME


@dataclass(frozen=True, eq=False)
class Dancers:
    """The clips and what is known of them.

    Parameters
    ----------
    clips : of one skeleton.
    body : its roles.
    standing : for each clip, (F, 2) true where the left, right foot rests.
    peaks : (J,) rad/s, the fastest each joint's bone may turn in a join.
    """

    clips: Sequence[Motion]
    body: Body
    standing: Sequence[Bools]
    peaks: Array

    def first(self, move: Move) -> Placed:
        """The move with which all begins: facing +Y, the hips above the origin."""
        length = (move.to_s - move.from_s) / move.rate
        sources = Sources.of(self.clips, DancePlan((replace(move, at_s=0.0),), length))
        sources = placed(sources, self.body, self.standing)
        return Placed(0, move, float(sources.turns[0]), sources.shifts[0])

    def next(self, last: Placed, move: Move, number: int) -> Placed:
        """A move that goes on from where the last one ends."""
        tail = min(TAIL, last.end - last.move.at_s)
        before = replace(last.move, from_s=last.second(last.end - tail), at_s=0.0)
        length = (move.to_s - move.from_s) / move.rate
        plan = DancePlan((before, replace(move, at_s=tail)), tail + length)
        sources = Sources.of(self.clips, plan)
        turns, shifts = np.array([last.turn, 0.0]), np.stack((last.shift, np.zeros(3)))
        sources = replace(sources, turns=turns, shifts=shifts)
        gaps, left, entered = pivots(sources, self.body, self.standing)
        turn = float(gaps[0])
        turn += self._steered(move, turn, left, entered)
        if not standing_at(sources, self.standing, np.arange(2), np.full(2, tail)).all():
            left = left - _aside(left)
        return Placed(number, move, turn, on_ground(left - rot.rotate(rot.yaw(turn), entered))[0])

    def _steered(self, move: Move, turn: float, left: Array, entered: Array) -> float:
        """Radians by which the join turns the move more, so that it keeps to the stage."""
        times = np.arange(0.0, (move.to_s - move.from_s) / move.rate, PATH_STEP)
        roots = sample(self.clips, np.full(len(times), move.clip), move.from_s + move.rate * times).roots
        if np.linalg.norm(np.ptp(roots[:, :2], axis=0)) < TRAVELS:
            return 0.0  # who stays where they are gets nowhere by turning
        path = rot.rotate(rot.yaw(turn), roots - entered) + left
        return float(steering(left, np.zeros(1), path, times, MOST)[0])


def _aside(here: Array) -> Array:
    """(1, 3) metres from the middle of the stage outwards, ``NUDGE`` long at twice ``CALM`` from it; none within it."""
    out = on_ground(here)
    away = float(np.linalg.norm(out))
    return out / max(away, CALM) * NUDGE * min(max(away / CALM - 1.0, 0.0), 1.0)
