"""How one move becomes the next inside the window of a join.

Every method is a function ``(sources, windows, join, times) → Pose``, chosen by its name in ``BLENDS``: for dance times
(N,), each inside the window of its ``join`` (N,), the blended poses. At the edges of the window pose and velocity are
those of the sources. All work on whole arrays of frames of many joins.

How to choose: ``inertial``, the default, keeps what both clips do inside the window, their stops on the beat above all.
``hermite2006`` is smoother (on motion capture about a sixth less jerk than the clips' own) but wipes out stops near
joins; ``crossfade`` needs the clips to go on past their joins and gains nothing by it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Times
from onbeat.dance.sources import Pose, Sources
from onbeat.motion import rotations as rot

STEP = 1 / 60
"""Seconds over which velocities at a join are measured."""


@dataclass(frozen=True)
class Windows:
    """The windows of K joins on the dance's clock.

    Parameters
    ----------
    centres : (K,) seconds of the joins; join k is between moves k and k+1.
    spans : (K,) seconds each window lasts, centred on its join.
    """

    centres: Times
    spans: Array

    @property
    def starts(self) -> Times:
        """(K,) seconds at which the windows begin."""
        return self.centres - self.spans / 2

    @property
    def ends(self) -> Times:
        """(K,) seconds at which the windows end."""
        return self.centres + self.spans / 2

    def join_at(self, times: Times) -> Ints:
        """(N,) the join in whose window each time lies, -1 where it lies in none."""
        if not len(self.centres):
            return np.full(len(times), -1, np.int64)
        join = np.clip(np.searchsorted(self.ends, times, side="left"), 0, len(self.centres) - 1)
        inside = (times > self.starts[join] + 1e-9) & (times < self.ends[join] - 1e-9)
        return np.where(inside, join, -1)


Blend = Callable[[Sources, Windows, Ints, Times], Pose]


def hermite2006(sources: Sources, windows: Windows, join: Ints, times: Times) -> Pose:
    """Shiratori 2006, Eq. 10: a cubic from the pose at the window's start to that at its end, velocities matched.

    The paper's cubic of unit link directions leaves twist open; the same cubic on unit quaternions, renormalised, fixes
    it. The root's path is the cubic too, so that height and tilt arrive at the destination's.
    """
    first, first_rate = _with_rates(sources, np.arange(len(windows.centres)), windows.starts)
    last, last_rate = _with_rates(sources, np.arange(1, len(windows.centres) + 1), windows.ends)
    flip = np.sum(first.rotations * last.rotations, axis=-1, keepdims=True) < 0
    span = windows.spans[join]
    f = (times - windows.starts[join]) / span

    def cubic(start: Array, start_rate: Array, end: Array, end_rate: Array) -> Array:
        u, t = (np.reshape(v, (-1,) + (1,) * (start.ndim - 1)) for v in (f, span))
        at_start, at_end = 2 * u**3 - 3 * u**2 + 1, 3 * u**2 - 2 * u**3
        blended = at_start * start[join] + at_end * end[join]
        return blended + t * ((u**3 - 2 * u**2 + u) * start_rate[join] + (u**3 - u**2) * end_rate[join])

    rotations = cubic(
        first.rotations,
        first_rate.rotations,
        np.where(flip, -last.rotations, last.rotations),
        np.where(flip, -last_rate.rotations, last_rate.rotations),
    )
    return Pose(rot.normalise(rotations), cubic(first.roots, first_rate.roots, last.roots, last_rate.roots))


def inertial(sources: Sources, windows: Windows, join: Ints, times: Times) -> Pose:
    """Each side goes on as itself while the offset between them is eased from one to the other.

    Before the join at s the dance shows A(t) + D·S(t) and after it B(t) − D·(1−S(t)), where D = B(s) − A(s) and S is
    the quintic from 0 to 1 over the window: the offset has no velocity and no acceleration at the edges, and what
    each clip does inside the window (a stop on the beat, a step) is kept. The difference of velocities at s, halved
    to both sides, is taken up by a quartic that is zero at the edge and at s.
    """
    before, after = np.arange(len(windows.centres)), np.arange(1, len(windows.centres) + 1)
    a, spin_a, speed_a = _with_spins(sources, before, windows.centres, -STEP)
    b, spin_b, speed_b = _with_spins(sources, after, windows.centres, STEP)
    apart = rot.log(rot.multiply(rot.inverse(a.rotations), b.rotations))
    half_way = rot.exp(apart / 2)
    spin_gap = rot.rotate(half_way, spin_b) - rot.rotate(rot.inverse(half_way), spin_a)

    later = times >= windows.centres[join]
    shown = sources.pose(join + later, times)
    share = quintic((times - windows.starts[join]) / windows.spans[join]) - later
    half = windows.spans[join] / 2
    u = np.clip(1 - np.abs(times - windows.centres[join]) / half, 0.0, 1.0)
    bump = half * (u**4 - u**3) / 2
    eased = rot.exp(apart[join] * share[:, None, None])
    pulled = rot.exp(spin_gap[join] * bump[:, None, None])
    rotations = rot.multiply(shown.rotations, rot.multiply(eased, pulled))
    roots = shown.roots + (b.roots - a.roots)[join] * share[:, None] + (speed_b - speed_a)[join] * bump[:, None]
    return Pose(rotations, roots)


def crossfade(sources: Sources, windows: Windows, join: Ints, times: Times) -> Pose:
    """The plain cross-fade, for comparison: both clips play on through the window and are mixed by a quintic weight."""
    a, b = sources.pose(join, times), sources.pose(join + 1, times)
    weight = quintic((times - windows.starts[join]) / windows.spans[join])
    mixed = a.roots * (1 - weight[:, None]) + b.roots * weight[:, None]
    return Pose(rot.slerp(a.rotations, b.rotations, weight[:, None]), mixed)


BLENDS: Mapping[str, Blend] = {"inertial": inertial, "hermite2006": hermite2006, "crossfade": crossfade}


def quintic(u: Array) -> Array:
    """``6u⁵ − 15u⁴ + 10u³``: from 0 to 1 without velocity or acceleration at either end."""
    u = np.clip(u, 0.0, 1.0)
    return u**3 * (u * (6 * u - 15) + 10)


def _with_rates(sources: Sources, moves: Ints, times: Times) -> tuple[Pose, Pose]:
    """Poses at K times and how they change a second (central differences of quaternions and root positions)."""
    here = sources.pose(moves, times)
    early, late = sources.pose(moves, times - STEP / 2), sources.pose(moves, times + STEP / 2)
    q_early, q_late = (
        np.where(np.sum(p.rotations * here.rotations, axis=-1, keepdims=True) < 0, -p.rotations, p.rotations)
        for p in (early, late)
    )
    return here, Pose((q_late - q_early) / STEP, (late.roots - early.roots) / STEP)


def _with_spins(sources: Sources, moves: Ints, times: Times, step: float) -> tuple[Pose, Array, Positions]:
    """Poses at K times, angular velocities (K, J, 3) in each joint's own frame and root velocities, read one-sided."""
    here, there = sources.pose(moves, times), sources.pose(moves, times + step)
    spins = rot.log(rot.multiply(rot.inverse(here.rotations), there.rotations)) / step
    return here, spins, (there.roots - here.roots) / step
