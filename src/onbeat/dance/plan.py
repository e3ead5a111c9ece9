"""The plan of a dance: which stretch of which clip is danced when.

A plan is made of moves. Move k shows its clip from ``from_s`` on, at ``rate`` clip seconds a second, from ``at_s``
until the next move begins. A join lies at each ``at_s`` but the first: there the dance leaves one clip at its
``to_s`` and enters the next at its ``from_s``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Times
from onbeat.errors import PlanError


@dataclass(frozen=True)
class Move:
    """One stretch of one clip.

    Parameters
    ----------
    clip : index of the clip in the library.
    from_s, to_s : seconds in the clip where it is entered and left.
    at_s : seconds in the dance where it begins.
    rate : clip seconds per dance second.
    """

    clip: int
    from_s: float
    to_s: float
    at_s: float
    rate: float = 1.0


@dataclass(frozen=True)
class DancePlan:
    """Moves in order, filling ``duration`` seconds without a gap.

    Examples
    --------
    >>> plan = DancePlan((Move(0, 1.0, 3.0, 0.0), Move(2, 5.0, 6.0, 2.0)), duration=3.0)
    >>> [a.tolist() for a in plan.clip_times(np.array([0.5, 2.5]))]
    [[0, 1], [1.5, 5.5]]
    """

    moves: tuple[Move, ...]
    duration: float

    def __post_init__(self) -> None:
        if not self.moves or self.moves[0].at_s != 0.0:
            raise PlanError("a dance plan needs a move that begins at 0 s")
        ends = [move.at_s for move in self.moves[1:]] + [self.duration]
        for move, end in zip(self.moves, ends, strict=True):
            if end <= move.at_s or abs((move.to_s - move.from_s) - move.rate * (end - move.at_s)) > 1e-6:
                raise PlanError(f"move at {move.at_s} s does not last until {end} s: {move}")

    @property
    def join_times(self) -> Times:
        """Seconds in the dance at which one move gives way to the next."""
        return np.array([move.at_s for move in self.moves[1:]])

    def clip_times(self, times: Times) -> tuple[Ints, Array]:
        """For dance times (N,): the index of the move shown and the second in its clip."""
        starts = np.array([move.at_s for move in self.moves])
        which = np.clip(np.searchsorted(starts, times + 1e-9, side="right") - 1, 0, len(starts) - 1)
        froms = np.array([move.from_s for move in self.moves])
        rates = np.array([move.rate for move in self.moves])
        return which, froms[which] + rates[which] * (times - starts[which])
