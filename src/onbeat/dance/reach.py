"""From which frames, at which moment of the song, a dance can still come to its end with all that is kept in it.

Without anything kept this does not depend on the moment (``lookahead.Roads.survival``); with it, it does. It is the
value to go of a dance in which nothing is worth anything.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Bools
from onbeat.dance.optimal import BARRED, Problem, ValueToGo


@dataclass(frozen=True, eq=False)
class Reach:
    """Ways to the song's end.

    Parameters
    ----------
    value : 0 where there is one, far below where there is none.
    must : (T,) the frame to show at each song frame, −1 where any may be.
    hold : song frames danced at least after a join.
    """

    value: ValueToGo
    must: NDArray[np.int32]
    hold: int

    @classmethod
    def of(cls, problem: Problem) -> Reach:
        """Look at all frames of a problem; a ``PlanError`` says if there is no way at all."""
        laid, music = problem.frames, problem.music
        nothing = np.zeros(len(laid), np.float32)
        plain = replace(
            problem,
            frames=replace(laid, stop_worth=nothing, intensity=nothing, idle=nothing),
            music=replace(music, beat_worth=music.beat_worth * 0, intensity=music.intensity * 0),
            join_costs=problem.join_costs * 0,
            seams=None,
        )
        return cls(ValueToGo(plain), problem.must, problem.hold)

    def ahead(self, t: int) -> Bools:
        """(hold + 1, M) row x: whether the dance can be about to show a frame at song frame t + x.

        It has run through x frames of its clip since t, all of which may be shown, and can be danced to the end.
        """
        begin, _, rows = self.value.stretch(min(t, self.value.total - 1))
        out = np.ones((self.hold + 1, rows.shape[1]), bool)
        came = np.ones(rows.shape[1], bool)
        for x, row in enumerate(out):
            if x:
                came = self._next(t + x - 1, came)
            if t + x < self.value.total:
                row[:] = rows[t + x - begin] > BARRED / 2
            row &= came
        return out

    def free(self, t: int, frame: int, most: int) -> int:
        """How many frames of its clip can be shown from ``frame`` on before another must be; up to ``most``."""
        must = self.must[t : t + most]
        barred = np.flatnonzero((must >= 0) & (must != frame + np.arange(len(must))))
        return int(barred[0]) if len(barred) else most

    def _next(self, t: int, came: Bools) -> Bools:
        """Where those that are about to show a frame at t are a frame later."""
        later = np.zeros(len(came), bool)
        if t < len(self.must) and self.must[t] >= 0:
            later[self.must[t] + 1] = came[self.must[t]]
        else:
            later[1:] = came[:-1]
        return later
