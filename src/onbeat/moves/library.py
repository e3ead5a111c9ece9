"""A motion library: clips of one body, their features, and the motion graph that joins them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.errors import LibraryError
from onbeat.keyposes.own import own_keyposes
from onbeat.motion.body import Body
from onbeat.motion.features import hand_features, intensity_component
from onbeat.motion.links import link_directions, link_error
from onbeat.motion.motion import Motion
from onbeat.moves.graph import GRID, MARGIN, STRETCH, MotionGraph
from onbeat.moves.poses import pose_vectors
from onbeat.moves.similarity import clip_pairs

CLIP_RATE = 60.0
"""Hz, the highest rate at which clips are kept."""
REACH = 0.54
"""Largest pose distance of a join (see ``poses``)."""
SHORTEST = STRETCH + 2 * MARGIN + 0.2
"""Seconds that a clip needs at least."""


@dataclass(frozen=True, eq=False)
class Clip:
    """One clip and what was read off it, on the graph's frames.

    Parameters
    ----------
    motion : on the library's skeleton, at ``CLIP_RATE`` at most.
    name : for people and plans.
    source : number of the recording; a mirrored clip shares its original's.
    mirrored : whether it is a mirror image.
    stops : seconds of the body's stops.
    intensity : (n,) Eq. 2 at each graph frame, m/s.
    poses : (n, D) pose vectors at each graph frame.
    keyposes : seconds of its keyposes by its own pulse; none where it keeps none.
    """

    motion: Motion
    name: str
    source: int
    mirrored: bool
    stops: Times
    intensity: Array
    poses: Float32
    keyposes: Times = field(default_factory=lambda: np.zeros(0))

    @classmethod
    def of(cls, motion: Motion, name: str = "", source: int = 0, *, mirrored: bool = False) -> Clip:
        """Read the features off a motion."""
        body = Body.of(motion.skeleton)
        grid = motion.resampled(GRID)
        features = hand_features(motion, body)
        return cls(
            motion if motion.fps <= CLIP_RATE + 1e-6 else motion.resampled(CLIP_RATE),
            name or motion.name,
            source,
            mirrored,
            features.body_stops,
            intensity_component(features, grid.times),
            pose_vectors(grid, body),
            own_keyposes(motion),
        )


@dataclass(frozen=True, eq=False)
class MoveLibrary:
    """Clips in a row and the graph over their frames.

    Parameters
    ----------
    clips : in the order of the graph's frames.
    graph : over all frames at ``GRID`` Hz.
    problems : files that are not in it, and why, a line each.
    notes : what was assumed of files that are.
    """

    clips: tuple[Clip, ...]
    graph: MotionGraph
    problems: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, clips: Sequence[Clip], reach: float = REACH, step: Callable[[float], None] | None = None
    ) -> MoveLibrary:
        """Find the joins between clips, all of one skeleton; a ``LibraryError`` says if there is none to use."""
        if not clips:
            raise LibraryError("the library has no clips; give a folder of motion files (docs/files.md)")
        clip_of = np.repeat(np.arange(len(clips)), [len(clip.poses) for clip in clips])
        first, second, distance = clip_pairs([clip.poses for clip in clips], reach, step=step)
        return cls(tuple(clips), MotionGraph.of(clip_of, first, second, distance))

    @cached_property
    def starts(self) -> Ints:
        """(clips + 1,) the graph frame at which each clip begins, and the number of frames."""
        return np.concatenate(([0], np.cumsum([len(clip.poses) for clip in self.clips])))

    @cached_property
    def intensity(self) -> Array:
        """(N,) Eq. 2 at each graph frame."""
        return np.concatenate([clip.intensity for clip in self.clips])

    @property
    def seconds(self) -> float:
        """How much motion there is, mirrored clips not counted."""
        return sum(clip.motion.duration for clip in self.clips if not clip.mirrored)

    def link_errors(self, leave: Ints, enter: Ints) -> Array:
        """Mean link error in degrees between pairs of graph frames."""
        links = self._links
        return link_error(links[leave], links[enter])

    @cached_property
    def _links(self) -> Array:
        return np.concatenate([link_directions(clip.motion.resampled(GRID)) for clip in self.clips])
