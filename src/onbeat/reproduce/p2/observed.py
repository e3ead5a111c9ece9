"""What takes of a dance at several speeds show (2007, Sec. II-B): means, what is left of the layers, common valleys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array
from onbeat.reproduce.p2.takes import Takes
from onbeat.retime.attenuation import Attenuation, attenuation
from onbeat.retime.observe import Curves, Observation, observe
from onbeat.retime.takes import DENSITY, repetitions
from onbeat.retime.upper_body import named_joints, upper_body
from onbeat.retime.valleys import away, common_valleys, contrast, valleys

JOINT = "left_shoulder"
"""Whose curves the paper shows."""
COARSE = 2
"""Layers with knots on beats and half beats; the finer ones are details."""
TOLERANCE = 0.15
"""Beats by which a valley may be off a keypose."""
PHASES = 720
"""Even shifts of the valleys round the dance that tell what chance would find."""


@dataclass(frozen=True, eq=False)
class Observed:
    """Takes, and what was observed of them.

    Parameters
    ----------
    takes : the dance.
    found, layers : means and variances, and the layers' energies.
    joint : the name of the left shoulder.
    common : (V,) beats of the valleys that all curves of variance have.
    """

    takes: Takes
    found: Observation
    layers: Attenuation
    joint: str
    common: Array

    @property
    def place(self) -> int:
        """Of the left shoulder among the joints."""
        return self.found.repetitions.joints.index(self.joint)

    @property
    def keyposes(self) -> Array | None:
        """(K,) beats of a repetition, or None where they are not known."""
        if self.takes.keyposes is None:
            return None
        every, beats = self.found.repetitions, self.takes.keyposes - self.found.repetitions.first
        return np.clip(beats[(beats > -TOLERANCE) & (beats < every.beats[-1] + TOLERANCE)], 0.0, every.beats[-1])


def observed(takes: Takes, seed: int = 0) -> Observed:
    """Observe takes: the joints of the upper body, five layers from a knot a beat on.

    Examples
    --------
    >>> from onbeat.reproduce.p2.takes import troupe_takes
    >>> few = observed(troupe_takes(0, (1.0, 1.5), 2))
    >>> few.joint, bool(detail_left(few)[-1] < coarse_left(few)[-1])
    ('LeftArm', True)
    """
    skeleton = takes.takes[0].motion.skeleton
    joints = upper_body(skeleton)
    joint = named_joints(skeleton, [JOINT])[0]
    every = repetitions(takes.takes, joints, takes.cycle)
    found = observe(every)
    each = [valleys(every.beats, curves.pooled, every.cyclic) for curves in found.repeated]
    return Observed(
        takes,
        found,
        attenuation(every, np.random.default_rng(seed)),
        joint if joint in joints else joints[0],
        common_valleys(each, every.period),
    )


def coarse_left(seen: Observed) -> Array:
    """(S,) of the layers with knots on beats and half beats together, the rms at each speed by that at the base."""
    return _left(seen.layers, slice(0, COARSE))


def detail_left(seen: Observed) -> Array:
    """(S,) of the finer layers together, likewise."""
    return _left(seen.layers, slice(COARSE, None))


def _left(layers: Attenuation, which: slice) -> Array:
    own = np.sqrt(np.square(layers.rms[:, which]).sum(axis=1))
    return own / own[layers.base]


def difference(seen: Observed, curves: Curves, layers: int) -> float:
    """Degrees, root mean square, by which the left shoulder's mean rotation is not that at the slowest speed.

    Both are rebuilt of the coarsest ``layers``.
    """
    apart = curves.mean[layers - 1, :, seen.place] - seen.found.speeds[0].mean[layers - 1, :, seen.place]
    return float(np.degrees(2 * np.sqrt(np.square(apart).sum(axis=-1).mean())))


def likeness(seen: Observed, curves: Curves, layers: int) -> float:
    """Correlation of the left shoulder's mean rotation with that at the slowest speed, rebuilt of so many layers."""
    own, slow = (each.mean[layers - 1, :, seen.place] for each in (curves, seen.found.speeds[0]))
    own, slow = own - own.mean(axis=0), slow - slow.mean(axis=0)
    return float((own * slow).sum() / max(np.sqrt(np.square(own).sum() * np.square(slow).sum()), 1e-12))


def bends_left(seen: Observed, curves: Curves, layers: int) -> float:
    """How strongly the left shoulder's mean curve bends, by how it does at the slowest speed: under 1 it is smoother.

    Root mean square of the second derivative by beats.
    """

    def bend(own: Curves) -> float:
        second = np.diff(own.mean[layers - 1, :, seen.place], 2, axis=0) * DENSITY**2
        return float(np.sqrt(np.square(second).sum(axis=-1).mean()))

    return bend(curves) / max(bend(seen.found.speeds[0]), 1e-12)


@dataclass(frozen=True)
class Kept:
    """How the common valleys are keyposes.

    Parameters
    ----------
    valleys, keyposes : how many there are.
    precision, recall : shares of the valleys that are keyposes, and of the keyposes that are valleys.
    chance : the recall of the same valleys at every phase, the mean.
    contrast : variance of all takes at keyposes, by that at other times.
    """

    valleys: int
    keyposes: int
    precision: float
    recall: float
    chance: float
    contrast: float


def kept(seen: Observed) -> Kept | None:
    """The valleys held against the keyposes, within ``TOLERANCE``; None where these are not known."""
    keyposes, every = seen.keyposes, seen.found.repetitions
    if keyposes is None or not len(keyposes):
        return None
    length = float(every.beats[-1])
    shifts = np.arange(PHASES) / PHASES * length
    by_chance = [_near(keyposes, (seen.common + shift) % length, every.period) for shift in shifts.tolist()]
    return Kept(
        len(seen.common),
        len(keyposes),
        _near(seen.common, keyposes, every.period),
        _near(keyposes, seen.common, every.period),
        float(np.mean(by_chance)),
        contrast(every.beats, seen.found.all.pooled, keyposes, every.period),
    )


def _near(of: Array, others: Array, period: float) -> float:
    """Share of some beats that have one of the others within the tolerance, round the cycle where there is one."""
    if not len(of) or not len(others):
        return 0.0
    nearest = [float(np.abs(away(others, beat, period)).min()) for beat in of.tolist()]
    return float(np.mean(np.array(nearest) <= TOLERANCE + 1e-9))
