"""Repetitions of one dance on musical time, each in its layers (2007, Sec. II-A).

All of them count a joint's rotation from one reference, its mean over all takes, so that they can be averaged, and on
one branch: a joint that goes through π does so in every take by the same turns. A take is decomposed as a whole, its
layers having their knots on the beats, and cut into cycles afterwards, so that cuts have no ends of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Ints, Rotations, Times, frozen
from onbeat.errors import MetricError, PlanError
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.retime.bspline import Spline
from onbeat.retime.channels import unwrapped
from onbeat.retime.demand import silent
from onbeat.retime.hierarchy import LAYERS, SPACING, decompose
from onbeat.retime.lock import BEYOND, TimeMap, lock

DENSITY = 32
"""Points a beat at which layers are looked at: two between the knots of the finest."""
MOST = 2e8
"""Numbers that all repetitions may hold together (1.6 GB)."""
NEAR_PI = 2.6
"""Radians past which a joint may be on its way through half a turn in one of the takes."""
EDGE = 1.0
"""Beats by which a take is made to go on past its ends."""
_EVERYWHERE = 0.5  # beats between the places about which decompose samples densely


@dataclass(frozen=True, eq=False)
class Take:
    """A recording of the dance.

    Parameters
    ----------
    motion : what was recorded.
    beats : (B,) seconds of the motion; beat k is the same place of the dance in every take.
    speed : how fast, 1 for the original speed.
    """

    motion: Motion
    beats: Times
    speed: float

    @property
    def label(self) -> str:
        """Its name, for messages."""
        return self.motion.name or "a take"


@dataclass(frozen=True, eq=False)
class Repetitions:
    """N repetitions of a dance (takes, or cycles of them) on the same beats.

    Parameters
    ----------
    beats : (G,) from 0, the repetition's first beat.
    joints : names of the J joints.
    layers : (N, layers, G, J, 3) radians, what each layer adds to the rotation vectors; the coarsest first.
    speeds : (N,) of each repetition.
    takes : (N,) number of the take that each is of.
    first : beat of the takes with which the first repetition begins.
    cyclic : whether the dance goes on at the end of ``beats`` as at its beginning.
    """

    beats: Array
    joints: tuple[str, ...]
    layers: Array
    speeds: Array
    takes: Ints
    first: int
    cyclic: bool = False

    def __post_init__(self) -> None:
        for name in ("beats", "layers", "speeds"):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        object.__setattr__(self, "takes", frozen(self.takes, np.int64))

    def __len__(self) -> int:
        return len(self.layers)

    @property
    def period(self) -> float:
        """Beats after which the dance begins again; 0 where it does not."""
        return float(self.beats[-1]) if self.cyclic else 0.0

    def logs(self, layers: int) -> Array:
        """(N, G, J, 3) logarithms of the quaternions, half the angle, rebuilt of the coarsest ``layers``."""
        return self.layers[:, :layers].sum(axis=1) / 2


def repetitions(
    takes: Sequence[Take],
    joints: Sequence[str],
    cycle: int | None = None,
    layers: int = LAYERS,
    spacing: float = SPACING,
    progress: Callable[[float], None] = silent,
) -> Repetitions:
    """Takes on musical time, in layers.

    Parameters
    ----------
    takes : two repetitions or more; their skeletons have joints of the same names and the same pose of rest.
    joints : names of the joints that are looked at.
    cycle : beats after which the dance repeats, to cut every take into its cycles; without it a take is one repetition,
        and all are as long as the shortest.
    layers, spacing : how many, and beats between the knots of the coarsest.
    progress : told the share that is done.

    Raises
    ------
    MetricError
        If there are less than two repetitions, a joint is missing, or a take has too few beats or a speed that is none.
    """
    if cycle is not None and cycle < 1:
        raise MetricError(f"a cycle of {cycle} beats cannot be; give 1 or more")
    places = _places(takes, joints)
    first, last = _shared(takes)
    ends = [last if cycle is None else _end(take) for take in takes]
    length = max(last - first, 0) if cycle is None else cycle
    starts = [np.arange(first, end - length + 1, max(length, 1)) for end in ends]
    _check(takes, starts, length, cycle)
    _check_size(starts, length, layers * len(joints))
    rhythms = [rhythm_of(take) for take in takes]
    vectors = _vectors(takes, places, rhythms, first)
    grid = np.arange(DENSITY * length + 1) / DENSITY
    out = list[Array]()
    for number, (take, rhythm, turns) in enumerate(zip(takes, rhythms, vectors, strict=True)):
        progress(number / len(takes))
        curve = _curve(turns.reshape(len(turns), -1), take)
        dense = np.arange(rhythm(curve.knots.times[:1])[0], rhythm(curve.knots.times[-1:])[0] + EDGE, _EVERYWHERE)
        found = decompose(curve, rhythm, dense, layers, spacing, still=0.0)
        out += [found(start + grid).reshape(layers, len(grid), len(joints), 3) for start in starts[number].tolist()]
    progress(1.0)
    counts = [len(each) for each in starts]
    speeds = np.repeat([take.speed for take in takes], counts)
    numbers = np.repeat(np.arange(len(takes)), counts)
    return Repetitions(grid, tuple(joints), np.stack(out), speeds, numbers, first, cycle is not None)


def _curve(values: Array, take: Take) -> Spline:
    """Channels (F, n) over the take's seconds, turned about their ends to go on past them: a fit needs both sides."""
    period = float(np.median(np.diff(take.beats)))
    more = min(round(EDGE * period * take.motion.fps), len(values) - 1)
    return Spline.through(
        np.pad(values, ((more, more), (0, 0)), "reflect", reflect_type="odd"), take.motion.fps, -more / take.motion.fps
    )


def _places(takes: Sequence[Take], joints: Sequence[str]) -> list[list[int]]:
    """Of each take the joints' places in its skeleton."""
    if not takes or not joints:
        raise MetricError(f"{len(takes)} takes and {len(joints)} joints; two takes or more and a joint are needed")
    for take in takes:
        names = take.motion.skeleton.names
        missing = [joint for joint in joints if joint not in names]
        if missing:
            raise MetricError(f"{take.label} has no joint {', '.join(missing[:5])}; it has {', '.join(names[:60])}")
        if not (np.isfinite(take.speed) and take.speed > 0):
            raise MetricError(f"{take.label} has the speed {take.speed}; one above 0 is needed, 1 for the original")
        if not (len(take.beats) > 1 and np.isfinite(take.beats).all() and (np.diff(take.beats) > 0).all()):
            raise MetricError(f"{take.label} has {len(take.beats)} beats; two or more seconds that rise are needed")
    return [[take.motion.skeleton.names.index(joint) for joint in joints] for take in takes]


def _end(take: Take) -> int:
    """The last beat that is inside of the motion; half a frame past its end still is."""
    return int(np.searchsorted(take.beats, (len(take.motion) - 0.5) / take.motion.fps)) - 1


def _shared(takes: Sequence[Take]) -> tuple[int, int]:
    """The first and the last beat that are inside of every take."""
    first = max(int(np.searchsorted(take.beats, -0.5 / take.motion.fps)) for take in takes)
    return first, min(_end(take) for take in takes)


def _check(takes: Sequence[Take], starts: Sequence[Ints], length: int, cycle: int | None) -> None:
    for take, begins in zip(takes, starts, strict=True):
        if length < 1 or not len(begins):
            wanted = f"a cycle of {cycle} beats is" if cycle else "two beats or more that all takes share are"
            within = f"{len(take.beats)} beats, {take.beats[0]:.2f} to {take.beats[-1]:.2f} s, "
            raise MetricError(f"{take.label}: {within}on a motion of {take.motion.duration:.2f} s; {wanted} needed")
    total = sum(len(each) for each in starts)
    if total < 2:
        raise MetricError(f"{total} repetition of the dance; give two or more takes, or the beats of its cycle")


def _check_size(starts: Sequence[Ints], length: int, channels: int) -> None:
    count = sum(len(each) for each in starts)
    numbers = count * length * DENSITY * channels * 3
    if numbers > MOST:
        raise MetricError(
            f"{count} repetitions of {length} beats are {numbers:.1e} numbers, over {MOST:.0e}; "
            "look at fewer joints or takes, and check that the beats are not too dense"
        )


def rhythm_of(take: Take) -> TimeMap:
    """The map of a take's seconds to beats, made of those that are near the motion.

    Raises
    ------
    MetricError
        If no smooth map meets them.
    """
    begin = max(int(np.searchsorted(take.beats, 0.0)) - BEYOND, 0)
    places = np.arange(begin, min(_end(take) + 1 + BEYOND, len(take.beats)))
    try:
        return lock(take.beats[places], places.astype(np.float64))
    except PlanError as error:
        raise MetricError(f"{take.label}: {error}") from None


def _vectors(takes: Sequence[Take], places: Sequence[list[int]], rhythms: Sequence[TimeMap], first: int) -> list[Array]:
    """Of each take the rotation vectors (F, J, 3) from the joints' mean rotations, all on one branch."""
    rotations = [take.motion.rotations[:, place] for take, place in zip(takes, places, strict=True)]
    means = _means(rotations)
    out = [rot.log(rot.multiply(rot.inverse(means), each)) for each in rotations]
    far = np.max([np.linalg.norm(each, axis=-1).max(axis=0) for each in out], axis=0) > NEAR_PI
    moments = [rhythm.inverse(np.array([float(first)]))[0] for rhythm in rhythms]
    frames = [
        int(np.clip(round(moment * take.motion.fps), 0, len(take.motion) - 1))
        for moment, take in zip(moments, takes, strict=True)
    ]
    for joint in np.flatnonzero(far).tolist():
        anchor = out[0][frames[0], joint]
        for each, frame in zip(out, frames, strict=True):
            each[:, joint] = branch(each[:, joint], frame, anchor)
    return out


def branch(vectors: Array, frame: int, anchor: Array) -> Array:
    """Rotation vectors (F, 3) that go on through π, on the branch that is nearest to ``anchor`` (3,) at a frame.

    Examples
    --------
    >>> turns = np.array([[3.0, 0, 0], [-3.0, 0, 0]])  # both about half a turn
    >>> branch(turns, 0, np.array([3.0, 0, 0])).round(2)[:, 0].tolist()
    [3.0, 3.28]
    >>> branch(turns, 0, np.array([-3.2, 0, 0])).round(2)[:, 0].tolist()
    [-3.28, -3.0]
    """
    after = unwrapped(np.concatenate((anchor[None], vectors[frame:])))[1:]
    before = unwrapped(np.concatenate((after[:1], vectors[:frame][::-1])))[1:]
    return np.concatenate((before[::-1], after))


def _means(rotations: Sequence[Rotations]) -> Rotations:
    """(J, 4) the mean of each joint's rotations over all takes: the main axis of Σ q qᵀ, each take counting as one."""
    total = sum(np.einsum("fja,fjb->jab", each, each) / len(each) for each in rotations)
    return rot.normalise(np.linalg.eigh(total)[1][:, :, -1])
