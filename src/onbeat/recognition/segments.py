"""Segments: stretches of dances of one length and one body, so that they compare number by number.

Every segment is read at evenly spaced moments from its start to its end, at the points that all bodies share, in units
of the body's size. Where the dancer stands and faces is taken out: places are seen from the hips at the segment's
start, front along +Y (``frame="start"``: steps and turns stay in), from the hips of every moment, upright with the
trunk (``frame="body"``: only the pose stays), or from the ground below the hips of every moment (``frame="ground"``:
leaning and height stay in, where the dancer goes and turns does not). Left and right steps are different unless they
are joined (:mod:`onbeat.recognition.mirroring`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, frozen
from onbeat.errors import MetricError
from onbeat.keyposes.vectors import CROWN, PoseVectors, pose_vectors
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames, facing
from onbeat.motion.motion import Motion

MOMENTS = 32
"""How many evenly spaced moments a segment is read at."""
FRAMES = ("start", "body", "ground")
"""What places are seen from: the body at the segment's start, at each moment, or the ground below it then."""
_FEET = ("left_ankle", "right_ankle", "left_toe", "right_toe")
_SHORTEST = 3  # frames of a segment: two speeds, so that it can turn back
_FARTHEST = 1e6  # body sizes: farther is damage, and squares of it lose what is near
_BRIEFEST, _LONGEST = 1e-4, 1e6  # seconds, and metres
_CENTRE_LINKS = {"hips": 0, "spine": 1, "chest": 2, "neck": 3, "head": 4, CROWN: 5}
_SIDE_LINKS = {"hip": 1, "knee": 2, "ankle": 3, "toe": 4, "collar": 3, "shoulder": 4, "elbow": 5, "wrist": 6, "hand": 7}


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments of dances, with what is known of each.

    Parameters
    ----------
    positions : (S, T, E, 3) body sizes: S segments at T moments, E elements (points of the body).
    durations : (S,) seconds.
    task, person : of each segment, "" where it is not known.
    cycle : (S,) which repetition of the dance each is from.
    elements : E names of points: roles, and the crown of the head.
    links : (E,) how many links away from the body's centre each element is.
    sizes : (S,) metres of a body size; 1 where nothing else is said.

    Raises
    ------
    MetricError
        If shapes disagree, there are fewer than 3 moments or no element, or a value is no number or beyond all bodies.

    Examples
    --------
    >>> some = Segments(np.zeros((2, 8, 1, 3)), [1.0, 2.0], ("bow", "turn"), ("Aiko", ""), [0, 1], ("hips",), [0])
    >>> len(some), some[[1]].task, some.velocities.shape
    (2, ('turn',), (2, 8, 1, 3))
    """

    positions: Positions
    durations: Array
    task: tuple[str, ...]
    person: tuple[str, ...]
    cycle: Ints
    elements: tuple[str, ...]
    links: Ints
    sizes: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        for name, kind in (("positions", np.float64), ("durations", np.float64), ("cycle", np.int64)):
            set_(self, name, frozen(getattr(self, name), kind))
        for name in ("task", "person", "elements"):
            set_(self, name, tuple(getattr(self, name)))
        set_(self, "links", frozen(self.links, np.int64))
        set_(self, "sizes", frozen(self.sizes if len(self.sizes) else np.ones(len(self.positions))))
        self._check()

    def _check(self) -> None:
        shape, elements = self.positions.shape, len(self.elements)
        if len(shape) != 4 or shape[2:] != (elements, 3) or not elements or shape[1] < _SHORTEST:
            raise MetricError(
                f"segments of shape {shape} found; (segments, {_SHORTEST} moments or more, {elements or 'some'} "
                "elements, 3) is needed"
            )
        counts = {n: len(getattr(self, n)) for n in ("durations", "task", "person", "cycle", "sizes")}
        wrong = {name: count for name, count in counts.items() if count != shape[0]}
        if wrong or len(self.links) != elements:
            raise MetricError(
                f"{shape[0]} segments of {elements} elements have {wrong or {'links': len(self.links)}}; "
                "one each is needed"
            )
        # NaN is neither below nor above anything.
        near = (np.abs(self.positions) <= _FARTHEST).all(axis=(1, 2, 3))
        for good, what in (
            (near, f"a place that is not a number or beyond {_FARTHEST:g} body sizes"),
            ((self.durations >= _BRIEFEST) & (self.durations <= _LONGEST), f"no duration from {_BRIEFEST:g} s"),
            ((self.sizes >= _BRIEFEST) & (self.sizes <= _LONGEST), "no body size in metres"),
        ):
            if not good.all():
                first = int(np.argmin(good))
                who = f"segment {first} ({self.task[first]!r} by {self.person[first]!r})"
                raise MetricError(f"{who} has {what}; leave it out or put it right")

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def velocities(self) -> Array:
        """(S, T, E, 3) body sizes per second."""
        seconds = self.durations / (self.positions.shape[1] - 1)
        return np.gradient(self.positions, axis=1) / seconds[:, None, None, None]

    def __getitem__(self, chosen: Bools | Ints | Sequence[int] | slice) -> Segments:
        """Some of the segments, by mask, indices or slice; an empty choice is allowed."""
        index = chosen if isinstance(chosen, slice) else np.asarray(chosen)
        at = np.arange(len(self))[index if isinstance(index, slice) or index.size else slice(0)]
        task, person = (tuple(names[i] for i in at.tolist()) for names in (self.task, self.person))
        of = (self.positions[at], self.durations[at], task, person, self.cycle[at])
        return Segments(*of, self.elements, self.links, self.sizes[at])


def segments_of(
    motions: Sequence[Motion],
    spans: Sequence[tuple[float, float]],
    tasks: Sequence[str],
    persons: Sequence[str],
    cycles: Sequence[int],
    *,
    frame: str = "start",
    moments: int = MOMENTS,
) -> Segments:
    """Segments of motions, one each from a motion, a stretch of it and what is known of it.

    Parameters
    ----------
    motions : S motions; the same one may come again and again.
    spans : S pairs of seconds, start and end.
    tasks, persons, cycles : of each segment; "" for what is not known.
    frame : one of ``FRAMES``.
    moments : T, 3 or more.

    Raises
    ------
    MetricError
        If the lists are not equally long or empty, or a span is not a number, shorter than 3 frames or outside its
        motion.
    BodyError
        If a body lacks a role that every body needs.

    Examples
    --------
    >>> from onbeat.examples.dancers import DANCERS
    >>> from onbeat.examples.folk_dance import FOLK_DANCE
    >>> from onbeat.examples.performer import perform
    >>> clip = perform(DANCERS[0], [FOLK_DANCE], 1.0, 1, np.random.default_rng(0))
    >>> spans = list(zip(clip.keyposes, clip.keyposes[1:]))
    >>> found = segments_of([clip.motion] * 7, spans, [clip.task] * 7, [clip.person] * 7, [0] * 7)
    >>> found.positions.shape, found.elements[-1]
    ((7, 32, 24, 3), 'crown')
    """
    counts = [len(motions), len(spans), len(tasks), len(persons), len(cycles)]
    if len(set(counts)) > 1 or not motions:
        raise MetricError(
            f"{counts} motions, spans, tasks, persons and cycles; as many of each are needed, one at least"
        )
    if frame not in FRAMES:
        raise MetricError(f"no frame {frame!r}; there are {', '.join(FRAMES)}")
    if moments < _SHORTEST:
        raise MetricError(f"{moments} moments of a segment; {_SHORTEST} at least are needed")
    for number, (motion, span) in enumerate(zip(motions, spans, strict=True)):
        _check_span(motion, span, number)
    places: dict[int, list[int]] = {}
    for number, motion in enumerate(motions):
        places.setdefault(id(motion), []).append(number)
    unique = [motions[at[0]] for at in places.values()]
    vectors = pose_vectors(unique)
    positions = np.empty((len(motions), moments, len(vectors[0].points), 3))
    sizes, bounds = np.empty(len(motions)), np.asarray(spans, np.float64)
    for motion, own in zip(unique, vectors, strict=True):
        at = np.array(places[id(motion)], np.int64)
        times = bounds[at, :1] + np.linspace(0.0, 1.0, moments) * (bounds[at, 1:] - bounds[at, :1])
        positions[at] = _read(motion, own, times, frame)
        sizes[at] = own.size
    elements = vectors[0].points
    of = (positions, bounds[:, 1] - bounds[:, 0], tuple(tasks), tuple(persons), np.asarray(cycles, np.int64))
    return Segments(*of, elements, links_of(elements), sizes)


def _read(motion: Motion, own: PoseVectors, times: Array, frame: str) -> Positions:
    """(S, T, E, 3) body sizes, the points at some seconds (S, T)."""
    read = motion.at(times.ravel())
    points = read.positions[:, own.joints].reshape(*times.shape, len(own.points), 3)
    turns, origins = body_frames(read, Body.of(motion.skeleton))
    turns, origins = turns.reshape(*times.shape, 4), origins.reshape(*times.shape, 3)
    if frame == "start":
        turns, origins = rot.yaw(facing(turns[:, :1])), origins[:, :1]
    elif frame == "ground":
        low = points[..., [own.points.index(f) for f in _FEET if f in own.points], 2].min(axis=(1, 2))
        turns, origins = rot.yaw(facing(turns)), origins.copy()
        origins[..., 2] = low[:, None]
    return rot.rotate(rot.inverse(turns)[:, :, None], points - origins[:, :, None]) / own.size


def _check_span(motion: Motion, span: tuple[float, float], number: int) -> None:
    label = f"segment {number} of {motion.name or 'the motion'}"
    start, end = (float(second) for second in span)
    if not (np.isfinite(start) and np.isfinite(end)):
        raise MetricError(f"{label} is from {start} to {end} s; numbers are needed")
    if not -1e-6 <= start <= end <= motion.duration + 1e-6:
        raise MetricError(
            f"{label} is from {start:g} to {end:g} s; it has to end after its start, and the motion lasts "
            f"{motion.duration:g} s"
        )
    if (end - start) * motion.fps < _SHORTEST - 1 - 1e-6:
        raise MetricError(
            f"{label} is from {start:g} to {end:g} s, {end - start:.3g} s long; "
            f"{(_SHORTEST - 1) / motion.fps:.3g} s ({_SHORTEST} frames) are the least; "
            "leave it out or join it to the next"
        )


def links_of(elements: Sequence[str]) -> Ints:
    """(E,) how many links each element is from the body's centre, the hips: hip 1, knee 2, … hand 7.

    The links are those of the roles, whatever joints a skeleton has between them; what is no role counts 1.

    Examples
    --------
    >>> links_of(["hips", "left_hip", "left_toe", "right_wrist", "crown"]).tolist()
    [0, 1, 4, 6, 5]
    """
    parts = (name.removeprefix("left_").removeprefix("right_") for name in elements)
    return np.array([{**_CENTRE_LINKS, **_SIDE_LINKS}.get(part, 1) for part in parts], np.int64)
