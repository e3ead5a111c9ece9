"""Motions of few dimensions, by keyposes and by uniform sampling, and how they compare (keyposes 2009, Sec. 4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Times
from onbeat.errors import MetricError
from onbeat.keyposes.held_out import HeldOut, Taught, Unseen, held_out, spaces
from onbeat.keyposes.judging import SPACES
from onbeat.keyposes.lessons import lesson
from onbeat.keyposes.playable import playable
from onbeat.keyposes.space import KeyposeSpace
from onbeat.keyposes.unnatural import Natural, Unnatural
from onbeat.keyposes.vectors import PoseVectors, pose_vectors
from onbeat.motion.motion import Motion

MOST = 8
"""Dimensions up to which errors are told, if the spaces have as many."""


@dataclass(frozen=True, eq=False)
class LowDimensional:
    """Some people's dances in two spaces.

    Parameters
    ----------
    motions : the originals.
    taught, tested : of each, what taught and what is unseen.
    spaces : by name: "keyposes", and "uniform" at phase 0 as in the paper.
    dims : K′.
    frames : errors on unseen frames of the same people; dances of a single cycle count only if all are.
    people : errors on people who did not teach; None where there is but one.
    natural : what is natural, learned from the originals.
    """

    motions: tuple[Motion, ...]
    taught: tuple[Taught, ...]
    tested: tuple[Unseen, ...]
    spaces: dict[str, KeyposeSpace]
    dims: int
    frames: HeldOut
    people: HeldOut | None
    natural: Natural

    @property
    def between(self) -> bool:
        """Whether ``frames`` tells but of what lies between the taught poses, for no dance is more than a cycle."""
        return all(one.between for one in self.tested)

    @property
    def vectors(self) -> tuple[PoseVectors, ...]:
        """The poses of each motion."""
        return tuple(one.vectors for one in self.taught)

    def poses(self, which: int, space: str, dims: int | None = None) -> np.ndarray:
        """(F, 3N) the poses of a motion in a space, in K′ dimensions or others."""
        return self.spaces[space].reduced(self.vectors[which].values, self.dims if dims is None else dims)

    def motion(self, which: int, space: str, dims: int | None = None) -> Motion:
        """A motion in a space, playable; see :func:`onbeat.keyposes.playable.playable`."""
        dims = self.dims if dims is None else dims
        name = f"{self.taught[which].person}_{space}_{dims}d"
        return playable(self.poses(which, space, dims), self.vectors[which], self.motions[which], name)

    def unnatural(self, which: int, space: str, dims: int | None = None, *, played: bool = False) -> Unnatural:
        """How unnatural the poses of a motion are in a space: as points, or as the motion that is ``played``."""
        vectors, poses = self.vectors[which], self.poses(which, space, dims)
        if played:  # distances and angles are the same in any frame
            made = self.motion(which, space, dims).positions[:, vectors.joints]
            poses = made.reshape(len(made), -1) / vectors.size
        return self.natural.judge(poses, vectors, self.motions[which])


def low_dimensional(
    motions: Sequence[Motion],
    keyposes: Sequence[Times],
    names: Sequence[str],
    *,
    dims: int = 3,
    rho: float | None = None,
    cycle: int | None = None,
) -> LowDimensional:
    """Make the spaces of some people's dances, and measure them.

    Parameters
    ----------
    motions : one of each person.
    keyposes : seconds of each motion's keyposes.
    names : of the people.
    dims : K′; three suffice to look right (Sec. 4.2).
    rho : if it is given, K′ is as many dimensions as hold this share of the keyposes' variance.
    cycle : keyposes in a cycle of the dance, see :func:`onbeat.keyposes.lessons.lesson`.

    Raises
    ------
    MetricError
        If someone has too few keyposes, or the spaces have fewer dimensions than are asked for.
    BodyError
        If a body lacks a role that every body needs.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> rng = np.random.default_rng(0)
    >>> clips = [perform(dancer, [FOLK_DANCE], 1.0, 2, rng, 30) for dancer in DANCERS[:3]]
    >>> made = low_dimensional(
    ...     [clip.motion for clip in clips], [clip.keyposes for clip in clips], [clip.person for clip in clips], cycle=8
    ... )
    >>> bool(made.frames.ratio[2, 2] < 0.9)  # on unseen keyposes, in three dimensions
    True
    """
    if len(set(names)) < len(names) or not len(motions) == len(keyposes) == len(names):
        raise MetricError(
            f"{len(motions)} motions, {len(keyposes)} lists of keyposes and the names {', '.join(names)}; "
            "give one of each for a motion, no name twice"
        )
    vectors = pose_vectors(motions)
    lessons = [lesson(*given, cycle) for given in zip(names, vectors, keyposes, strict=True)]
    taught, tested = tuple(one[0] for one in lessons), tuple(one[1] for one in lessons)
    ours, theirs = spaces(taught, 1)
    chosen = dims if rho is None else ours.dims_for(rho)
    most = min(len(ours), len(theirs[0]))
    if not 1 <= chosen <= most:
        raise MetricError(
            f"{chosen} dimensions of a space that has {most}: {sum(len(one.keyposes) for one in taught)} keyposes of "
            f"{people_told(len(taught))} span no more; give 1 to {most}, or more people"
        )
    up_to = min(max(MOST, chosen), most)
    return LowDimensional(
        tuple(motions), taught, tested, dict(zip(SPACES, (ours, theirs[0]), strict=True)), chosen,
        held_out(taught, [one for one in tested if not one.between] or tested, up_to),
        held_out(taught, tested, up_to, strangers=True) if len(taught) > 1 else None,
        Natural.of(vectors),
    )  # fmt: skip


def people_told(count: int) -> str:
    """How many people, in words: ``1 person``, ``2 people``."""
    return f"{count} {'person' if count == 1 else 'people'}"
