"""The fair measure of a keypose space: how far off it rebuilds poses that it was not made of.

The variance that a space covers (Fig. 11) is that of its own poses, other poses for each sampling. Here both spaces
rebuild the same unseen poses at the same number of dimensions: other cycles of the same people, or people of whom the
space knows nothing. Uniform sampling takes as many poses of the same cycles, at several phases, and is their mean.

Three errors are told, for they differ. Over *all* frames uniform sampling is hard to beat: it is a fair sample of
just these frames, and principal components are what rebuilds a sample best. Keyposes are where a body rests and is
looked at: *rest* is the half of the frames in which it moves least, *keyposes* are unseen keyposes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from onbeat._shapes import Array, Times, frozen
from onbeat.errors import MetricError
from onbeat.keyposes.space import KeyposeSpace, uniform_times
from onbeat.keyposes.vectors import PoseVectors

RATE = 30.0
"""Hz at which unseen frames are looked at, whatever the motion's rate."""
PHASES = 8
"""How many phases of uniform sampling are tried."""
MEASURES = ("all", "rest", "keyposes")
"""Of which unseen poses an error is."""


@dataclass(frozen=True, eq=False)
class Taught:
    """What a space learns from one person.

    Parameters
    ----------
    person : the name.
    vectors : the motion's poses.
    keyposes : (K,) seconds of the keyposes, those of one cycle.
    start, end : seconds, the cycle; uniform sampling takes K poses of it.
    """

    person: str
    vectors: PoseVectors
    keyposes: Times
    start: float
    end: float


@dataclass(frozen=True, eq=False)
class Unseen:
    """What of one person a space is tested on.

    Parameters
    ----------
    person : the name.
    vectors : the motion's poses.
    spans : seconds from and to of the unseen stretches.
    keyposes : (K,) seconds of unseen keyposes; there may be none.
    between : the stretches are those that taught, and only what lies between the taught poses is unseen.
    """

    person: str
    vectors: PoseVectors
    spans: tuple[tuple[float, float], ...]
    keyposes: Times
    between: bool = False


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Errors in metres, the mean distance of rebuilt points from the true ones, people alike weighted.

    Parameters
    ----------
    dims : (D,) numbers of dimensions K′.
    keypose : (3, D) of the keypose space, by ``MEASURES``; NaN where there is nothing of a kind.
    uniform : (P, 3, D) of uniform sampling at P phases.
    """

    dims: np.ndarray
    keypose: Array
    uniform: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "dims", frozen(self.dims, np.int64))
        for name in ("keypose", "uniform"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def uniform_mean(self) -> Array:
        """(3, D) metres, over the phases."""
        return self.uniform.mean(axis=0)

    @property
    def ratio(self) -> Array:
        """(3, D) the keypose space's error over uniform sampling's; below 1 keyposes are better."""
        mean = self.uniform_mean
        return np.divide(self.keypose, mean, out=np.full_like(mean, np.nan), where=mean > 1e-12)


def spaces(taught: Sequence[Taught], phases: int = PHASES) -> tuple[KeyposeSpace, list[KeyposeSpace]]:
    """The keypose space of some people, and those of uniform sampling at several phases, of as many poses each.

    Raises
    ------
    MetricError
        If nobody is taught by, someone has no keypose, or the poses span no space.
    """
    if not taught or not all(len(one.keyposes) for one in taught):
        bare = [one.person for one in taught if not len(one.keyposes)]
        who = f"{', '.join(bare)} has no keypose" if bare else "there are no people"
        raise MetricError(f"{who} to make a space of; give motions with keyposes")
    ours = KeyposeSpace.of(np.concatenate([one.vectors.at(one.keyposes) for one in taught]))
    return ours, [uniform_space(taught, phase) for phase in np.arange(phases) / phases]


def uniform_space(taught: Sequence[Taught], phase: float = 0.0) -> KeyposeSpace:
    """Eqs. 10–11: of as many poses of each person's cycle, at equal distances in time."""
    return KeyposeSpace.of(
        np.concatenate([one.vectors.at(uniform_times(one.start, one.end, len(one.keyposes), phase)) for one in taught])
    )


def held_out(
    taught: Sequence[Taught], tested: Sequence[Unseen], dims: int, *, strangers: bool = False, phases: int = PHASES
) -> HeldOut:
    """Errors on unseen poses at 1…``dims`` dimensions.

    Parameters
    ----------
    taught : who teaches.
    tested : whose unseen poses are rebuilt.
    dims : the most dimensions; no more than the spaces have.
    strangers : leave out of the teachers whoever is tested: unseen people rather than unseen frames.
    phases : of uniform sampling.

    Raises
    ------
    MetricError
        If nothing is left to teach by or to test.
    """
    if not tested or dims < 1 or phases < 1:
        raise MetricError(f"{len(tested)} tests, {dims} dimensions, {phases} phases: one of each is needed at least")
    errors: list[Array] = []
    made: dict[str, list[KeyposeSpace]] = {}
    with threadpool_limits(1, "blas"):  # matrices so small are slower on more threads
        for one in tested:
            key = one.person if strangers else ""
            if key not in made:
                teachers = [teacher for teacher in taught if not strangers or teacher.person != one.person]
                ours, theirs = spaces(teachers, phases)
                made[key] = [ours, *theirs]
            poses = _unseen(one)
            errors.append(np.array([[_errors(space, p, one, dims) for p in poses] for space in made[key]]))
    most = min(len(space) for all_ in made.values() for space in all_)
    mean = _mean(np.array(errors))[..., : min(dims, most)]
    return HeldOut(np.arange(1, mean.shape[-1] + 1), mean[0], mean[1:])


def _unseen(one: Unseen) -> list[Array]:
    """The unseen poses by ``MEASURES``."""
    times = np.concatenate(
        [
            np.zeros(0),
            *(np.arange(np.ceil(a * RATE - 1e-6), np.floor(b * RATE + 1e-6) + 1) / RATE for a, b in one.spans),
        ]
    )
    times = times[(times >= 0) & (times <= one.vectors.duration + 1e-6)]
    if not len(times):
        raise MetricError(f"nothing of {one.person} is unseen: give a motion of more than one cycle, or more takes")
    speeds = one.vectors.speeds(times)
    return [one.vectors.at(t) for t in (times, times[speeds <= np.median(speeds)], np.asarray(one.keyposes))]


def _errors(space: KeyposeSpace, poses: Array, one: Unseen, dims: int) -> Array:
    """(dims,) metres; NaN beyond the space's dimensions and where there are no poses."""
    errors = np.full(dims, np.nan)
    if len(poses):
        off = poses - space.mean
        for number, axis in enumerate(space.axes[:dims]):
            off = off - np.outer(off @ axis, axis)  # what this dimension rebuilds
            squares = (off**2).reshape(-1, 3) @ np.ones(3)
            errors[number] = np.sqrt(squares).mean() * one.vectors.size
    return errors


def _mean(errors: Array) -> Array:
    """The mean over the first axis, of what is no NaN; NaN where all are."""
    known = np.isfinite(errors)
    total, count = np.where(known, errors, 0.0).sum(axis=0), known.sum(axis=0)
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)
