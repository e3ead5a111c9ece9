"""What repetitions at several speeds have in common, and where they differ (2007, Sec. II-B, Figs. 3 and 4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, frozen
from onbeat.errors import MetricError
from onbeat.retime.takes import Repetitions

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


def observe(repetitions: Repetitions) -> Observation:
    """Mean and variance at each speed and over all repetitions, layer by layer."""
    each = [repetitions.logs(k + 1) for k in range(repetitions.layers.shape[1])]
    speeds = np.unique(repetitions.speeds).tolist()
    of = [_curves(speed, [logs[repetitions.speeds == speed] for logs in each]) for speed in speeds]
    return Observation(repetitions, tuple(of), _curves(0.0, each))


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
