"""Who dances in a live session, put together: body, timeline, who chooses, and what a page needs to draw it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Ints
from onbeat.dance.sublibrary import sublibrary
from onbeat.errors import PlanError
from onbeat.live.bodies.dancers import Character, Dancer
from onbeat.live.bodies.rest import resting
from onbeat.live.bodies.soles import Soles
from onbeat.live.bodies.turned import Turned
from onbeat.live.choice.choreography import Choreography, Repertoire
from onbeat.live.choice.improvised import Improvised
from onbeat.live.choice.improviser import Improviser
from onbeat.live.choice.pickers import Picker
from onbeat.live.conductor import Conductor, Rest
from onbeat.live.growing.line import Line
from onbeat.live.protocol import RATE, Who
from onbeat.live.session import Tried
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.motion import Motion
from onbeat.motion.retarget import grounded, retarget
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.clips import MIRROR_SUFFIX
from onbeat.moves.poses import pose_vectors
from onbeat.viewer.contract import CapsuleData
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.pages.content import body_data

DANCED, MOST = 110.0, 1200.0
"""Beats a minute that a part of a great library is chosen for, and its seconds: as much as is searched in time."""
FIRST = 2.0
"""Seconds of rest that are looked at for the height of the floor."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """How the body is drawn: capsules between points, the spine among these, the floor's height, and where it faces."""

    capsules: tuple[CapsuleData, ...]
    spine: tuple[int, ...]
    floor: float
    facing: float


@dataclass(frozen=True, eq=False)
class Cast:
    """All that a session needs but sound.

    Parameters
    ----------
    who : told to all who listen.
    dancer, conductor : of the session.
    drawn : for the page.
    tried : where its body is simulated, what becomes of poses.
    """

    who: Who
    dancer: Dancer
    conductor: Conductor
    drawn: Drawn
    tried: Tried | None = None


@dataclass(frozen=True, eq=False)
class Known:
    """A choreography that was given: its motion, its beats and keyposes in the motion's seconds, beats of a bar."""

    motion: Motion
    beats: np.ndarray
    keyposes: np.ndarray
    meter: int = 4


def improvising(library: MoveLibrary) -> Cast:
    """A character who makes its dance up from a library's moves; of a great library, from a part that suits dances."""
    library = sublibrary(library, DANCED, MOST)
    clips = [clip.motion for clip in library.clips]
    names = tuple(clip.name.replace(MIRROR_SUFFIX, ", mirrored") for clip in library.clips)
    improviser = Improviser(library)

    def picker(rest: Motion) -> Picker:
        return Improvised(improviser, names, pose_vectors(rest[:3])[1])

    return _character(clips, picker, "a dancer")


def following(dances: Sequence[Known]) -> Cast:
    """A character who dances given choreographies, all on the skeleton of the first.

    Raises
    ------
    PlanError
        If there is none, or one has less than two beats.
    BodyError
        If a body's roles are not found.
    """
    if not dances:
        raise PlanError("no choreography to dance; give one motion or more")
    names = distinct([dance.motion.name or f"dance {k + 1}" for k, dance in enumerate(dances)])
    plans = [
        Choreography(name, k, dance.motion.duration, dance.beats, dance.meter, dance.keyposes)
        for k, (name, dance) in enumerate(zip(names, dances, strict=True))
    ]
    first = grounded(dances[0].motion)
    clips = [first] + [_on(first, dance.motion) for dance in dances[1:]]
    return _character(clips, lambda rest: Repertoire(plans), names[0])


def distinct(names: Sequence[str]) -> list[str]:
    """Names of which no two are alike.

    Examples
    --------
    >>> distinct(["walk", "walk", "turn"])
    ['walk', 'walk 2', 'turn']
    """
    out = list[str]()
    for name in names:
        other, number = name, 2
        while other in out:
            other, number = f"{name} {number}", number + 1
        out.append(other)
    return out


def _on(first: Motion, motion: Motion) -> Motion:
    if motion.skeleton == first.skeleton and motion.translations is None:
        return grounded(motion)
    return retarget(motion, first.skeleton, first)


def _character(clips: Sequence[Motion], picked: Callable[[Motion], Picker], name: str) -> Cast:
    rest = resting(clips)
    shown = [*clips, rest]
    line = Line(shown)
    conductor = Conductor(line, picked(rest), Rest(len(clips), rest.duration))
    skeleton = rest.skeleton
    drawn = body_data(rest[:2], 1)
    points: Ints = np.array([skeleton.index(joint) for joint in drawn.joints], dtype=np.int64)
    soles = Soles.of(line.dancers.body)
    dancer = Character(Turned(line, shown), skeleton, points, soles)
    who = Who(name, "character", skeleton.names, tuple(skeleton.parents.tolist()), (), tuple(drawn.joints))
    times = np.arange(int(FIRST * RATE)) / RATE
    rotations, roots = line.pose(times)
    places = forward_kinematics(skeleton, rotations, roots)[1]
    stood = Motion(skeleton, soles.pressed(rotations, roots, places)[0], roots, RATE)
    floor = ground_height(Figure.of(skeleton), stood)
    return Cast(who, dancer, conductor, Drawn(tuple(drawn.capsules), tuple(drawn.spine), floor, 0.0))
