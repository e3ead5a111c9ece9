"""What repetitions at several speeds have in common, and where they differ (2007, Sec. II-B, Figs. 3 and 4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.errors import MetricError
from onbeat.retime.takes import Repetitions, Take, repetitions
from onbeat.retime.upper_body import upper_body

STIFF = 1e-9
"""Share of the largest variance under which a joint never differs, and of a joint's own under which it is none."""


@dataclass(frozen=True, eq=False)
class Curves:
    """Mean and variance of some repetitions, rebuilt of 1, 2, … layers.

    Parameters
    ----------
    speed : of all of them; 0 where they are of several speeds.
    count : how many repetitions.
    mean : (layers, G, J, 3) logarithms of quaternions (Eq. 8), row k of the coarsest k + 1 layers.
    variance : (layers, G, J) of Eq. 9, without unit; no numbers where there is one repetition alone.
    """

    speed: float
    count: int
    mean: Array
    variance: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "mean", frozen(self.mean))
        object.__setattr__(self, "variance", frozen(self.variance))

    @property
    def pooled(self) -> Array:
        """(G,) the variance of all layers, the geometric mean over the joints.

        So joints count alike, whatever the size of their variance: a hand that shakes does not cover the rest. Joints
        that never differ are left out.
        """
        own = self.variance[-1]
        top = own.max(axis=0)
        kept = top > STIFF * top.max(initial=0.0)
        return np.exp(np.log(np.maximum(own[:, kept], STIFF * top[kept])).mean(axis=-1)) if kept.any() else own[:, 0]


@dataclass(frozen=True, eq=False)
class Observation:
    """The curves of each speed, slowest first, and those of all repetitions together."""

    repetitions: Repetitions
    speeds: tuple[Curves, ...]
    all: Curves

    @property
    def repeated(self) -> tuple[Curves, ...]:
        """The curves of those speeds that have a variance, and those of all repetitions."""
        own = tuple(each for each in self.speeds if each.count > 1)
        return (*own, self.all) if len(self.speeds) > 1 else own


def observe(repeated: Repetitions) -> Observation:
    """Mean and variance at each speed and over all repetitions, layer by layer."""
    each = [repeated.logs(k + 1) for k in range(repeated.layers.shape[1])]
    speeds = np.unique(repeated.speeds).tolist()
    of = [_curves(speed, [logs[repeated.speeds == speed] for logs in each]) for speed in speeds]
    return Observation(repeated, tuple(of), _curves(0.0, each))


def observe_takes(takes: Sequence[Take], joints: Sequence[str] | None = None, cycle: int | None = None) -> Observation:
    """What takes of one dance have in common and where they differ, at each of their speeds.

    Parameters
    ----------
    takes : two or more, each with its beats and its speed; beat k is the same place of the dance in all of them.
    joints : names of those that are looked at; the upper body's without them.
    cycle : beats after which the dance repeats, to cut every take into its cycles.

    Raises
    ------
    MetricError
        If there are less than two takes or cycles, a joint is missing, or a take has too few beats.
    BodyError
        If no joints are named and the body's roles are not found.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clips = [perform(DANCERS[0], [FOLK_DANCE], speed, 1, np.random.default_rng(0)) for speed in (1.0, 1.2)]
    >>> takes = [Take(clip.motion, clip.beats[:9], clip.speed) for clip in clips]
    >>> found = observe_takes(takes, ["LeftArm", "RightArm"])
    >>> [one.speed for one in found.speeds], found.all.mean.shape
    ([1.0, 1.2], (5, 257, 2, 3))
    """
    if not takes:
        raise MetricError("no take to observe; give two of the same dance or more")
    names = upper_body(takes[0].motion.skeleton) if joints is None else joints
    return observe(repetitions(takes, names, cycle))


def _curves(speed: float, logs: Sequence[Array]) -> Curves:
    mean = np.stack([values.mean(axis=0) for values in logs])
    if len(logs[0]) < 2:
        return Curves(speed, 1, mean, np.full(mean.shape[:-1], np.nan))
    return Curves(speed, len(logs[0]), mean, np.stack([variance(values) for values in logs]))


def variance(logs: Array) -> Array:
    """Eq. 9: ``1/(N − 1) Σ_i (1 − h(v_i)·h(v̄))`` with ``h(a) = (a, 1)/|(a, 1)|``, of magnitude and direction at once.

    Parameters
    ----------
    logs : (N, ..., 3) logarithms of quaternions, half the angle.

    Raises
    ------
    MetricError
        If there are less than two.

    Examples
    --------
    >>> variance(np.array([[0.0, 0, 0], [0, 0, 0.2]])).round(5).tolist()
    0.00973
    """
    if len(logs) < 2:
        raise MetricError(f"{len(logs)} repetition; a variance needs two or more")
    mean = logs.mean(axis=0)
    along = 1.0 + np.sum(logs * mean, axis=-1)
    lengths = np.sqrt((1.0 + np.sum(logs**2, axis=-1)) * (1.0 + np.sum(mean**2, axis=-1)))
    return np.maximum(np.sum(1.0 - along / lengths, axis=0), 0.0) / (len(logs) - 1)
