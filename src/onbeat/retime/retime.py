"""Faster or slower music, the same dance, inside the body's limits: all steps from a dance to the retimed one."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import PlanError
from onbeat.limits.limits import Limits
from onbeat.motion.joint_angles import JointAngles
from onbeat.motion.motion import Motion
from onbeat.retime.bspline import Spline
from onbeat.retime.demand import Answer, Demand, Progress, silent
from onbeat.retime.lock import TimeMap, lock
from onbeat.retime.measures import Measures, measure
from onbeat.retime.methods import METHODS
from onbeat.retime.sources import Source

TO_SPEED = 0.05
"""Seconds from rest to full speed: the acceleration limit where none is known. A joint's servo takes about as long."""
FASTEST = 10_000.0
"""Frames a second at most."""
LONGEST = 3600.0
"""Seconds that are retimed at most."""


@dataclass(frozen=True, eq=False)
class Retimed:
    """A retimed dance, and all that it was made of.

    Parameters
    ----------
    dance : the motion, or the table of angles; its frame 0 is at second ``start`` of the music.
    start : seconds.
    warp : the music's seconds to the dance's own.
    beats : seconds of the music at which the dance's beats are now.
    source, limits, demand, answer, measures : see there.
    method : its name.
    seconds : that the method took.
    """

    dance: Motion | JointAngles
    start: float
    warp: TimeMap
    beats: Times
    source: Source
    limits: Limits
    demand: Demand
    answer: Answer
    measures: Measures
    method: str
    seconds: float


def demand_of(
    source: Source,
    warp: TimeMap,
    limits: Limits,
    beats: Times,
    keyposes: Times,
    fps: float | None = None,
    until: float = np.inf,
) -> Demand:
    """What is asked of a method when a dance is to be in another time.

    Parameters
    ----------
    source : the dance.
    warp : the music's seconds to the dance's own.
    limits : of all its joints.
    beats, keyposes : on the dance's own clock, in seconds.
    fps : frames a second of the music; the dance's own without it.
    until : second of the music at which it ends at the latest.

    Raises
    ------
    PlanError
        If the dance has no time in the music, or an hour or more.
    """
    if fps is not None and not 0 < fps <= FASTEST:
        raise PlanError(f"{fps} frames a second; a number above 0, and at most {FASTEST:.0f}, is needed")
    rate = fps or round(1 / source.curve.knots.step, 9)
    start, end = warp.inverse(np.array([source.curve.knots.start, source.curve.knots.end]))
    first = int(np.ceil(max(float(start), 0.0) * rate - 1e-6))
    last = int(np.floor(min(float(end), until) * rate + 1e-6))
    name = source.name or "the dance"
    if last <= first:
        raise PlanError(f"{name} has no time in the music: it would be from {start:.2f} to {end:.2f} s")
    if (last - first) / rate > LONGEST:
        raise PlanError(f"{name} would last {(last - first) / rate:.0f} s; {LONGEST:.0f} is the most")
    times = np.arange(first, last + 1) / rate
    wish = Spline.through(source.curve(warp(times)), rate, first / rate)
    mine = limits.of(source.joints).with_acceleration(TO_SPEED)
    each = [np.repeat(getattr(mine, key), source.size) for key in ("low", "high", "acceleration", "jerk")]
    rhythm = lock(warp.inverse(beats), np.arange(len(beats), dtype=np.float64))
    return Demand(wish, each[0], each[1], source.speed(mine, wish), each[2], each[3], warp.inverse(keyposes), rhythm)


def retime(
    source: Source,
    warp: TimeMap,
    limits: Limits,
    beats: Times,
    keyposes: Times,
    method: str = "qp",
    fps: float | None = None,
    until: float = np.inf,
    progress: Progress = silent,
) -> Retimed:
    """A dance in another time, inside limits.

    Parameters are those of :func:`demand_of`; ``method`` is a name of ``METHODS``.

    Raises
    ------
    PlanError
        If there is no such method, or see there.

    Examples
    --------
    >>> from onbeat.retime.sources import Table
    >>> swing = np.sin(np.arange(0, 4, 1 / 60) * 2 * np.pi)[:, None]
    >>> arm = Table(JointAngles(("elbow",), swing, 60))
    >>> slow = Limits("arm", ("elbow",), [-2], [2], [7.0])
    >>> faster = retime(arm, TimeMap.steady(1.2), slow, np.arange(0, 4, 0.5), np.array([0.25, 0.75]))
    >>> faster.measures.violations, len(faster.dance)
    ((0, 0), 200)
    """
    if method not in METHODS:
        raise PlanError(f"no method {method!r}; there are {', '.join(METHODS)}")
    demand = demand_of(source, warp, limits, beats, keyposes, fps, until)
    began = time.process_time()
    answer = METHODS[method](demand, progress)
    seconds = time.process_time() - began
    knots = demand.wish.knots
    dance = source.made(answer.trajectory.samples, _own(source, warp, knots.times), round(1 / knots.step, 9))
    measures = measure(demand, answer.trajectory)
    return Retimed(
        dance, knots.start, warp, warp.inverse(beats), source, limits, demand, answer, measures, method, seconds
    )


def _own(source: Source, warp: TimeMap, times: Times) -> Array:
    return np.clip(warp(times), source.curve.knots.start, source.curve.knots.end)
