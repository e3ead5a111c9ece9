"""A motion library: clips of one body, their features, and the motion graph that joins them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from onbeat._shapes import Array, Float32, Ints, Times
from onbeat.errors import LibraryError
from onbeat.keyposes.own import own_keyposes
from onbeat.motion.body import Body
from onbeat.motion.features import hand_features, intensity_component
from onbeat.motion.links import LINKS, link_directions, link_error
from onbeat.motion.motion import Motion
from onbeat.moves.graph import GRID, MARGIN, STRETCH, MotionGraph
from onbeat.moves.lazy import Lazy
from onbeat.moves.poses import pose_vectors
from onbeat.moves.recordings import About
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
    source : number of the recording, or of the stretch of one; a mirrored clip shares its original's.
    mirrored : whether it is a mirror image.
    stops : seconds of the body's stops.
    intensity : (n,) Eq. 2 at each graph frame, m/s.
    poses : (n, D) pose vectors at each graph frame.
    keyposes : seconds of its keyposes by its own pulse; none where it keeps none.
    length : frames and frames a second of the motion, told where they are to be known before it is read.
    about : what is told of its recording.
    """

    motion: Lazy[Motion] = Lazy()
    name: Lazy[str] = Lazy()
    source: Lazy[int] = Lazy()
    mirrored: Lazy[bool] = Lazy()
    stops: Lazy[Times] = Lazy()
    intensity: Lazy[Array] = Lazy()
    poses: Lazy[Float32] = Lazy()
    keyposes: Lazy[Times] = Lazy(lambda: np.zeros(0))
    length: tuple[int, float] | None = None
    about: About = About()

    @property
    def fps(self) -> float:
        """Frames a second of the motion."""
        return self.motion.fps if self.length is None else self.length[1]

    @property
    def seconds(self) -> float:
        """How long the motion is."""
        return self.motion.duration if self.length is None else self.length[0] / self.length[1]

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
        return sum(clip.seconds for clip in self.clips if not clip.mirrored)

    def link_errors(self, leave: Ints, enter: Ints) -> Array:
        """Mean link error in degrees between pairs of graph frames; only the clips they lie in are read."""
        return link_error(self._links_at(leave), self._links_at(enter))

    def _links_at(self, frames: Ints) -> Array:
        """(n, 17, 3) link directions at graph frames."""
        found = np.empty((len(frames), len(LINKS), 3))
        clip_of = self.graph.clip_of[frames]
        for clip in np.unique(clip_of).tolist():
            here = np.flatnonzero(clip_of == clip)
            found[here] = self._links_of(clip)[frames[here] - self.starts[clip]]
        return found

    def _links_of(self, clip: int) -> Array:
        if clip not in self._links:
            self._links[clip] = link_directions(self.clips[clip].motion.resampled(GRID))
        return self._links[clip]

    @cached_property
    def _links(self) -> dict[int, Array]:
        return {}
