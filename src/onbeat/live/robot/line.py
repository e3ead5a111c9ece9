"""The line of a robot's dances: stretches one after the other, each going over into the next, on planted legs.

About a join both dances go on, and the robot goes from one to the other: w(t) is a polynomial of the fifth degree from
0 to 1 whose speed and acceleration are zero at both ends,

    q(t) = (1 − w) q₁(t) + w q₂(t),

for the hinges above the legs and for the root, whose turn goes along the arc. Mixtures of angles inside their ranges
are inside them. The legs are solved for feet that are where they always are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from onbeat._shapes import Array, Positions, Rotations, Times
from onbeat.errors import PlanError
from onbeat.live.robot.dance import PACE, STANCE, RobotDance
from onbeat.live.robot.path import Path
from onbeat.motion import rotations as rot
from onbeat.robots.legs.ik import Legs
from onbeat.robots.model import Robot

SHORTEST, LONGEST = 0.5, 2.0
"""Seconds of a join."""
TURN, PUSH = 40.0, 1.0
"""rad/s² of a hinge and m/s² of the root that a join may add at :data:`PACE`: half of what limits and balance allow."""
SPEED = 0.5
"""Part of a hinge's speed that a join may add at that pace."""
APART = 2e-3
"""Metres by which the feet of two dances may differ."""
SLOWEST, QUICKEST = 0.25, 4.0
"""Rates at which a dance may be on the line."""
_PEAKS = (1.875, 5.7735)
"""The greatest speed and acceleration of w, over its time and the square of it."""


@dataclass(frozen=True)
class Move:
    """A stretch of a dance on the line.

    Parameters
    ----------
    dance : its number.
    start : second of the line at which it begins.
    second : of the dance, there.
    rate : seconds of the dance to one of the line.
    begins, ends : seconds of the line between which the last move goes over into it.
    """

    dance: int
    start: float
    second: float
    rate: float
    begins: float
    ends: float

    def own(self, times: Times) -> Times:
        """Seconds of the dance at seconds (N,) of the line."""
        return self.second + (times - self.start) * self.rate

    def weight(self, times: Times) -> Array:
        """(N,) 0 before the move is gone over into, 1 when it is."""
        if self.ends <= self.begins:
            return np.ones(len(times))
        u = np.clip((times - self.begins) / (self.ends - self.begins), 0.0, 1.0)
        return u**3 * (10 - 15 * u + 6 * u**2)


class RobotLine:
    """A robot's own time, which grows at its end while its beginning is danced.

    Parameters
    ----------
    dances : prepared; all of this robot.
    robot : the model.

    Raises
    ------
    PlanError
        If there is no dance, or one whose feet are elsewhere.

    Examples
    --------
    >>> from onbeat.live.robot.rest import resting
    >>> from onbeat.robots.model import robot_named
    >>> g1 = robot_named("g1")
    >>> line = RobotLine([resting(g1)], g1)
    >>> line.add(0, 0.0, 12.0)
    >>> line.add(0, 0.0, 4.0)
    >>> line.end, line.angles(np.array([11.9, 12.1])).shape, line.showing(13.0)
    (16.0, (2, 29), (0, 1.0))
    """

    def __init__(self, dances: Sequence[RobotDance], robot: Robot) -> None:
        if not dances:
            raise PlanError("a line of no dances cannot be; one is needed")
        self.dances, self.robot = tuple(dances), robot
        self._paths = [Path(dance, robot) for dance in dances]
        self._legs = Legs.of(robot)
        self._places, self._turns = STANCE.feet(self._legs)
        self._fast = SPEED * np.asarray(robot.body.speed) / PACE
        self._moves: list[Move] = []
        self._end = self._settled = 0.0
        for number, path in enumerate(self._paths):
            away = float(np.abs(self._legs.feet(path(np.zeros(1)))[0] - self._places).max())
            if not away < APART:
                name = dances[number].name or f"dance {number}"
                raise PlanError(f"the feet of {name} are {1000 * away:.0f} mm from where those of all dances are")

    @property
    def moves(self) -> tuple[Move, ...]:
        """Those that are remembered, in their order."""
        return tuple(self._moves)

    @property
    def end(self) -> float:
        """Seconds that are known; behind them the last dance goes on by itself."""
        return self._end

    @property
    def settled(self) -> float:
        """Second before which nothing changes any more."""
        return self._settled

    @property
    def margin(self) -> float:
        """Seconds after what is settled from which on a cut may well lie: half of a short join."""
        return SHORTEST / 2

    def settle(self, before: float) -> None:
        """Nothing before this second changes any more; where the line is shorter, its last dance goes on so far."""
        self._settled = max(self._settled, _number(before, "a second"))
        self._end = max(self._end, self._settled)

    def add(self, clip: int, from_s: float, to_s: float, rate: float = 1.0) -> None:
        """Put seconds ``from_s`` to ``to_s`` of a dance, told by its number, at the end of the line.

        Where they go on with what is there, that is made longer; else the one goes over into the other, half of the
        time before the end, but nothing that is settled.

        Raises
        ------
        PlanError
            If there is no such dance, or no such seconds of it.
        """
        self._check(clip, from_s, to_s, rate)
        last = self._moves[-1] if self._moves else None
        if last is None:
            self._moves.append(Move(clip, self._end, from_s, rate, -np.inf, -np.inf))
        elif not self._goes_on(last, clip, from_s, rate):
            self._moves.append(self._joined(Move(clip, self._end, from_s, rate, self._end, self._end)))
        self._end += (to_s - from_s) / rate

    def _check(self, dance: int, from_s: float, to_s: float, rate: float) -> None:
        if not 0 <= dance < len(self.dances):
            raise PlanError(f"there is no dance {dance}; there are {len(self.dances)}, from 0 on")
        most = self.dances[dance].duration
        if not 0 <= from_s < to_s <= most + 0.05:
            raise PlanError(
                f"seconds {from_s:g} to {to_s:g} of {self.dances[dance].name or 'a dance'} cannot be; "
                f"rising ones from 0 to {most:.2f} are expected"
            )
        if not SLOWEST <= rate <= QUICKEST:
            raise PlanError(f"a rate of {rate:g} cannot be danced; {SLOWEST:g} to {QUICKEST:g} are expected")

    def _goes_on(self, last: Move, dance: int, from_s: float, rate: float) -> bool:
        there = float(last.own(np.array([self._end]))[0])
        return last.dance == dance and last.rate == rate and abs(there - from_s) < 1e-6

    def _joined(self, move: Move) -> Move:
        """The move with the time that the way to it takes."""
        times = move.start + np.linspace(-0.5, 0.5, 11)
        before, after = self._mixed(times), self._paths[move.dance](move.own(times))
        hinges = np.abs(after - before)[:, 7:].max(axis=0)
        root = float(np.linalg.norm(after[:, :3] - before[:, :3], axis=1).max())
        seconds = max(
            SHORTEST,
            float((_PEAKS[0] * hinges / self._fast).max()),
            PACE * float(np.sqrt(_PEAKS[1] * hinges.max() / TURN)),
            PACE * float(np.sqrt(_PEAKS[1] * root / PUSH)),
        )
        seconds = min(seconds, LONGEST)
        begins = max(self._settled, move.start - seconds / 2)
        return replace(move, begins=begins, ends=begins + seconds)

    def cut(self, at: float) -> None:
        """Forget what comes behind a second; a join of which something is settled is gone through all the same.

        Raises
        ------
        PlanError
            If it is settled already.
        """
        if _number(at, "a second") < self._settled:
            raise PlanError(f"second {at:.3f} cannot be cut at: it is settled up to {self._settled:.3f}")
        while len(self._moves) > 1 and self._moves[-1].start >= at and self._moves[-1].begins >= self._settled:
            self._moves.pop()
        self._end = min(self._end, at)

    def forget(self, before: float) -> None:
        """Drop what is over before a second; nothing of it is read any more."""
        over = [k for k, move in enumerate(self._moves) if move.ends <= before]
        del self._moves[: over[-1] if over else 0]

    def showing(self, time: float) -> tuple[int, float]:
        """The dance at a second of the line, and its own second there.

        Raises
        ------
        PlanError
            If nothing is on the line.
        """
        moves = self._known()
        now = next((move for move in reversed(moves) if move.start <= time), moves[0])
        return now.dance, float(now.own(np.array([time]))[0])

    def configurations(self, times: Times) -> Array:
        """(N, 7 + n) of the robot at seconds (N,) of the line.

        Raises
        ------
        PlanError
            If nothing is on the line.
        """
        times = np.asarray(times, np.float64)
        out = self._mixed(times)
        joining = np.zeros(len(times), np.bool_)
        for move in self._moves:
            joining = (joining & (times < move.ends)) | ((times > move.begins) & (times < move.ends))
        if joining.any():
            count = int(joining.sum())
            places, turns = np.tile(self._places, (count, 1, 1)), np.tile(self._turns, (count, 1, 1))
            out[joining] = self._legs.standing(out[joining], places, turns, warm=True)[0]
        return out

    def angles(self, times: Times) -> Array:
        """(N, n) radians of the hinges at seconds (N,) of the line."""
        return self.configurations(times)[:, 7:]

    def root(self, times: Times) -> tuple[Positions, Rotations]:
        """(N, 3) metres and (N, 4) wxyz of the root at seconds (N,) of the line."""
        mixed = self._mixed(np.asarray(times, np.float64))
        return mixed[:, :3], mixed[:, 3:7]

    def _mixed(self, times: Times) -> Array:
        """(N, 7 + n) before the legs are solved: each time's dances, one going over into the next."""
        moves = self._known()
        earliest = times.min(initial=np.inf)
        first = max(k for k, move in enumerate(moves) if k == 0 or move.ends <= earliest)
        out = self._paths[moves[first].dance](moves[first].own(times))
        for move in moves[first + 1 :]:
            on = times > move.begins
            if on.any():
                after = self._paths[move.dance](move.own(times[on]))
                out[on] = _between(out[on], after, move.weight(times[on]))
        return out

    def _known(self) -> list[Move]:
        if not self._moves:
            raise PlanError("nothing is on the line yet; add a dance")
        return self._moves


def _between(before: Array, after: Array, weight: Array) -> Array:
    out = before + weight[:, None] * (after - before)
    out[:, 3:7] = rot.slerp(before[:, 3:7], after[:, 3:7], weight)
    # What is over is not to the last bit what it is where nothing came before, unless it is taken as it is.
    return np.where(weight[:, None] < 1, out, after)


def _number(value: float, what: str) -> float:
    if not np.isfinite(value):
        raise PlanError(f"{what} of {value} cannot be; a number is expected")
    return float(value)
