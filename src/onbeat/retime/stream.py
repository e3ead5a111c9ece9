"""A dance followed as its music happens: beats go in, poses come out, inside the limits.

What is pushed in is which beat of the dance is expected when; between two such beats the dance goes at an even pace.
The clock, the dance's own second now, is itself planned within limits (:class:`onbeat.retime.horizon.Horizon`): it goes
between 0.4 and 1.6 times as fast as the music's and does not jump when a prediction changes. Channels then follow the
clock, two seconds ahead.
"""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.limits.limits import Limits
from onbeat.retime.horizon import Horizon
from onbeat.retime.sources import Source

PACE = 0.6
"""By how much the clock's rate may differ from the music's."""
QUICKLY = 4.0
"""Per second, how fast the rate may change."""
BLOCK = 5
"""Knots that are danced before the next plan: a tenth of a second."""


class Follower:
    """A dance that follows beats.

    Parameters
    ----------
    source : the dance.
    limits : of its joints.
    keyposes : (K,) seconds of the dance's own.
    at : second of the dance from which it starts, at second 0 of the music.

    Examples
    --------
    >>> from onbeat.motion.joint_angles import JointAngles
    >>> from onbeat.retime.sources import Table
    >>> swing = Table(JointAngles(("elbow",), np.sin(np.arange(0, 12, 1 / 60))[:, None], 60))
    >>> follower = Follower(swing, Limits("arm", ("elbow",), [-2], [2], [7.0], [60.0]))
    >>> follower.push(np.array([0.0, 0.5, 1.0]), np.array([0.0, 0.55, 1.1]))
    >>> poses = follower.pull(np.arange(0, 2, 0.01))
    >>> poses.shape, bool(abs(follower.own(np.array([1.9]))[0] - 2.09) < 0.01)
    ((200, 1), True)
    """

    def __init__(self, source: Source, limits: Limits, keyposes: Times | None = None, at: float = 0.0) -> None:
        mine = limits.of(source.joints)
        if source.size != 1:
            raise PlanError("characters are not followed yet; retarget the dance to a robot")
        self.curve = source.curve
        self.keyposes = np.zeros(0) if keyposes is None else np.asarray(keyposes, dtype=np.float64)
        free = np.array([np.inf])
        self.clock = Horizon(-free, free, np.array([PACE]), np.array([QUICKLY]), free, np.array([at]))
        bounds = (mine.low, mine.high, mine.speed, mine.acceleration, mine.jerk)
        self.body = Horizon(*bounds, self.curve(np.array([at]))[0])
        self._expected = (np.array([0.0, 1.0]), np.array([at, at + 1.0]))
        self._planned = False
        self._changed = True

    def push(self, music: Times, dance: Times) -> None:
        """From now on the dance's seconds (B,) are expected at the music's seconds (B,); both rising, two or more.

        Before the first and after the last it goes at the pace of the nearest two.

        Raises
        ------
        PlanError
            If they are not such seconds; what was pushed before stays.
        """
        music, dance = np.asarray(music, dtype=np.float64), np.asarray(dance, dtype=np.float64)
        if len(music) != len(dance) or len(music) < 2:
            raise PlanError(f"{len(music)} seconds of the music and {len(dance)} of the dance; as many, 2+, are needed")
        if not (np.isfinite(music).all() and np.isfinite(dance).all()):
            raise PlanError("a second that is pushed is not a number")
        if (np.diff(music) <= 0).any() or (np.diff(dance) <= 0).any():
            raise PlanError("seconds that are pushed have to rise")
        self._expected, self._changed = (music, dance), True

    def expected(self, times: Times) -> Array:
        """(N,) seconds of the dance at which it should be, at the music's seconds (N,)."""
        music, dance = self._expected
        rates = np.diff(dance) / np.diff(music)
        out = np.interp(times, music, dance)
        return out + rates[0] * np.minimum(times - music[0], 0.0) + rates[-1] * np.maximum(times - music[-1], 0.0)

    def own(self, times: Times) -> Array:
        """(N,) seconds of the dance at which it is, at times within the plan."""
        return times + self.clock.values(times)[:, 0]

    def pull(self, times: Times) -> Array:
        """Poses (N, n) at times (N,) of the music that rise from call to call.

        Raises
        ------
        PlanError
            If a time lies before what has been danced already.
        """
        times = np.asarray(times, dtype=np.float64)
        out = np.empty((len(times), self.curve.channels))
        if len(times) and times[0] < self.body.knots.start - 1e-9:
            raise PlanError(f"{times[0]:.3f} s is over: the dance is at {self.body.knots.start:.3f} s")
        done = 0
        while done < len(times):
            # What is being danced is never planned again: a push counts from the next tenth of a second on.
            while not self._planned or times[done] >= self._until - 1e-9:
                self._plan(float(times[done]))
            some = int(np.searchsorted(times, self._until - 1e-9))
            out[done:some] = self.body.values(times[done:some])
            done = some
        return out

    @property
    def _until(self) -> float:
        return self.body.knots.start + BLOCK * self.body.knots.step

    def _plan(self, time: float) -> None:
        """Go on to the tenth of a second that a time is in, and plan from there."""
        if self._planned:
            blocks = max(int((time - self.body.knots.start + 1e-9) / (BLOCK * self.body.knots.step)), 1)
            self.clock.advance(blocks * BLOCK)
            self.body.advance(blocks * BLOCK)
        self.clock.plan(lambda times: (self.expected(times) - times)[:, None], changed=self._changed)
        knots = self.body.knots.times
        keyposes = np.interp(self.keyposes, self.own(knots), knots, np.nan, np.nan)
        self.body.plan(lambda times: self.curve(self.own(times)), keyposes[np.isfinite(keyposes)], self._changed)
        self._planned, self._changed = True, False
