"""A dance followed as its music happens: beats go in, poses come out, inside the limits.

What is pushed in is which beat of the dance is expected when; between two such beats the dance goes at an even pace.
The clock, the dance's own second now, is itself planned within limits (:class:`onbeat.retime.horizon.Horizon`): it goes
between 0.4 and 1.6 times as fast as the music's, does not jump when a prediction changes, and is on the beats where it
cannot be on all between. Channels then follow the clock, two seconds ahead. The dance may grow meanwhile.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.limits.limits import Limits
from onbeat.retime.bspline import Spline
from onbeat.retime.horizon import Horizon
from onbeat.retime.sources import Source

PACE = 0.6
"""By how much the clock's rate may differ from the music's."""
QUICKLY = 4.0
"""Per second, how fast the rate may change."""
SAME = 0.001
"""Seconds by which what is expected may change before plans are made anew."""
BLOCK = 5
"""Knots that are danced before the next plan: a tenth of a second."""


class Followed(Protocol):
    """A dance as channels over its own seconds."""

    def values(self, own: Times, near: Array) -> Array:
        """(N, n) at rising own seconds (N,); angles that go round begin on the branch of ``near`` (n,)."""
        ...


@dataclass(frozen=True)
class Bounds:
    """Bounds (n,) of the values of channels and of their first three derivatives, infinite where there is none."""

    low: Array
    high: Array
    speed: Array
    acceleration: Array
    jerk: Array

    @classmethod
    def of(cls, limits: Limits) -> Bounds:
        """Of joints with a channel each."""
        return cls(limits.low, limits.high, limits.speed, limits.acceleration, limits.jerk)


@dataclass(frozen=True, eq=False)
class Whole:
    """A dance that is there from its beginning to its end."""

    curve: Spline

    def values(self, own: Times, near: Array) -> Array:
        """The curve, whichever branch it is on."""
        del near
        return self.curve(own)


class Follower:
    """A dance that follows beats.

    Parameters
    ----------
    dance : as channels.
    bounds : of the channels.
    start : (n,) values at which it rests at first.
    keyposes : (K,) seconds of the dance's own; may be set anew at any time.
    at : second of the dance from which it starts, at second ``since`` of the music.
    since : seconds of the music.

    Examples
    --------
    >>> from onbeat.motion.joint_angles import JointAngles
    >>> from onbeat.retime.sources import Table
    >>> swing = Table(JointAngles(("elbow",), np.sin(np.arange(0, 12, 1 / 60))[:, None], 60))
    >>> follower = Follower.of(swing, Limits("arm", ("elbow",), [-2], [2], [7.0], [60.0]))
    >>> follower.push(np.array([0.0, 0.5, 1.0]), np.array([0.0, 0.55, 1.1]))
    >>> poses = follower.pull(np.arange(0, 2, 0.01))
    >>> poses.shape, bool(abs(follower.own(np.array([1.9]))[0] - 2.09) < 0.01)
    ((200, 1), True)
    """

    def __init__(
        self,
        dance: Followed,
        bounds: Bounds,
        start: Array,
        keyposes: Times | None = None,
        at: float = 0.0,
        since: float = 0.0,
    ) -> None:
        self.dance = dance
        self.keyposes = np.zeros(0) if keyposes is None else np.asarray(keyposes, dtype=np.float64)
        free = np.array([np.inf])
        self.clock = Horizon(-free, free, np.array([PACE]), np.array([QUICKLY]), free, np.array([at - since]), since)
        self.body = Horizon(
            bounds.low, bounds.high, bounds.speed, bounds.acceleration, bounds.jerk, np.asarray(start), since
        )
        self._expected = (np.array([since, since + 1.0]), np.array([at, at + 1.0]))
        self._planned = False
        self._changed = True

    @classmethod
    def of(cls, source: Source, limits: Limits, keyposes: Times | None = None, at: float = 0.0) -> Follower:
        """A whole dance, its joints inside their limits.

        Raises
        ------
        PlanError
            If it is a character's, whose joints have three channels each.
        LimitError
            If a joint has no limits.
        """
        mine = limits.of(source.joints)
        if source.size != 1:
            raise PlanError("a character's dance has no angles of hinges; retarget it to a robot")
        return cls(Whole(source.curve), Bounds.of(mine), source.curve(np.array([at]))[0], keyposes, at)

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
        ahead = self.body.knots.times
        before = self.expected(ahead)
        self._expected = music, dance
        self._changed |= bool(np.abs(self.expected(ahead) - before).max() > SAME)

    def renew(self) -> None:
        """The dance is another one from now on, further than it was planned: plan all of it anew."""
        self._changed = True

    def expected(self, times: Times) -> Array:
        """(N,) seconds of the dance at which it should be, at the music's seconds (N,)."""
        music, dance = self._expected
        rates = np.diff(dance) / np.diff(music)
        out = np.interp(times, music, dance)
        return out + rates[0] * np.minimum(times - music[0], 0.0) + rates[-1] * np.maximum(times - music[-1], 0.0)

    def own(self, times: Times) -> Array:
        """(N,) seconds of the dance at which it is, at times within the plan."""
        return times + self.clock.values(times)[:, 0]

    @property
    def planned(self) -> float:
        """Second of the music up to which what is danced will not change any more."""
        return self._until if self._planned else self.body.knots.start

    def pull(self, times: Times) -> Array:
        """Poses (N, n) at times (N,) of the music that rise from call to call.

        Raises
        ------
        PlanError
            If a time lies before what has been danced already.
        """
        times = np.asarray(times, dtype=np.float64)
        out = np.empty((len(times), len(self.body.bounds[0])))
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
        knots = self.body.knots.times
        beats = self._expected[0]
        met = beats[(beats >= knots[0]) & (beats <= knots[-1])]
        self.clock.plan(lambda times: (self.expected(times) - times)[:, None], met, self._changed)
        keyposes = np.interp(self.keyposes, self.own(knots), knots, np.nan, np.nan)
        near = self.body.controls[1]  # of which the first plan's are the start

        def wish(times: Times) -> Array:
            return self.dance.values(self.own(times), near)

        self.body.plan(wish, keyposes[np.isfinite(keyposes)], self._changed)
        self._planned, self._changed = True, False
