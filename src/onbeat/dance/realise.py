"""From a plan to a dance: clips placed, joined and planted, exactly as long as the plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Times
from onbeat.dance.blend import BLENDS, Blend, Windows
from onbeat.dance.feet import plant_feet
from onbeat.dance.plan import DancePlan
from onbeat.dance.sources import Pose, Sources, Warp, contact_role, placed, standing_at
from onbeat.dance.stage import MOST
from onbeat.dance.steps import steps_between
from onbeat.dance.windows import fitted_windows, link_speeds
from onbeat.errors import PlanError
from onbeat.motion.body import Body
from onbeat.motion.contacts import SIDES, foot_contacts
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.motion import Motion
from onbeat.motion.soles import on_soles


@dataclass(frozen=True)
class Realised:
    """A dance.

    Parameters
    ----------
    motion : F frames, exactly as long as the plan.
    windows : (from, to) in dance seconds of each join's blend.
    contacts : (F, 2) true where the left, right foot is meant to rest on the floor.
    clips : (F,) the clip each frame shows.
    seconds : (F,) the second of that clip.
    """

    motion: Motion
    windows: tuple[tuple[float, float], ...]
    contacts: Bools
    clips: Ints
    seconds: Times


def realise(
    clips: Sequence[Motion],
    plan: DancePlan,
    fps: float = 60.0,
    warp: Warp | None = None,
    *,
    blend: str = "inertial",
    plant: bool = True,
    steer: float = MOST,
    standing: Sequence[Bools] | None = None,
    peaks: Array | None = None,
    spans: Array | None = None,
) -> Realised:
    """Dance a plan: its moves turned and shifted to go on from each other, blended at the joins, feet kept planted.

    Outside the windows of the joins the frames are the clips' own, moved as a whole on the ground, but for feet that
    would sink into the floor; the first pose faces +Y and the dance's ground is centred on the origin.

    Parameters
    ----------
    clips : motions of one skeleton, at any rates.
    plan : which of them is shown when.
    fps : frames per second of the dance; it has ``round(plan.duration * fps)`` frames.
    warp : from dance seconds to plan seconds, never going back and from 0 to the duration; none keeps the plan's time.
    blend : how joins are blended, a name in ``BLENDS``.
    plant : whether feet that rest on the floor are kept in place around joins, and out of the floor everywhere.
    steer : radians by which a join may turn the dance to keep the dancer on the stage; 0 for none.
    standing : for each clip, (F, 2) true where the left, right foot rests; found in the clips where not given.
    peaks : (J,) rad/s, the fastest each joint's bone may turn in a join, such as the library's own peaks; where not
        given, as fast as it turns in the moves shown.
    spans : (joins,) seconds that blends last, NaN for those that are to last as long as they need.

    Raises
    ------
    PlanError
        If a move shows a clip that is not there, the blend is unknown or the warp goes back.
    FormatError
        If the clips have different skeletons.
    """
    how = _blend(blend)
    sources = Sources.of(clips, plan, warp)
    body = Body.of(sources.skeleton)
    if standing is None:
        used = {move.clip for move in plan.moves}
        nothing = np.zeros((0, 2), bool)
        standing = [foot_contacts(clip, body).feet if i in used else nothing for i, clip in enumerate(clips)]
    sources = placed(sources, body, standing, steer)
    times = np.arange(max(1, round(plan.duration * fps))) / fps
    moves = sources.moves_at(times)
    shown = sources.pose(moves, times)
    shown_world = forward_kinematics(sources.skeleton, shown.rotations, shown.roots)
    limits = _peaks(sources, shown_world[1], moves, times) if peaks is None else peaks
    windows = fitted_windows(sources, how, limits, spans)
    pose = joined(sources, windows, how, shown, times)
    standing_now = standing_at(sources, standing, moves, times)
    turned = shown_world[0][:, body.indices("left_ankle", "right_ankle")]
    soles = shown_world[1][:, body.indices(*(f"{side}_{contact_role(body)}" for side in SIDES))]
    steps = steps_between(standing_now, soles, turned, moves, windows, times)
    if plant:
        pose = plant_feet(body, pose, shown_world, steps, moves, windows, times)
        pose = Pose(on_soles(body, pose.rotations, pose.roots), pose.roots)
    roots = pose.roots - _middle(pose.roots)
    motion = Motion(sources.skeleton, pose.rotations, roots, fps, name="dance")
    blended = tuple(zip(windows.starts.tolist(), windows.ends.tolist(), strict=True))
    return Realised(motion, blended, steps.contacts, sources.clip_of[moves], sources.seconds(moves, times))


def _blend(name: str) -> Blend:
    if name not in BLENDS:
        raise PlanError(f"there is no blend {name!r}; choose one of {', '.join(BLENDS)}")
    return BLENDS[name]


def joined(sources: Sources, windows: Windows, blend: Blend, shown: Pose, times: Times) -> Pose:
    """The poses shown at ``times`` (F,), with those inside windows replaced by blended ones."""
    join = windows.join_at(times)
    inside = np.flatnonzero(join >= 0)
    rotations, roots = shown.rotations.copy(), shown.roots.copy()
    if len(inside):
        blended = blend(sources, windows, join[inside], times[inside])
        rotations[inside], roots[inside] = blended.rotations, blended.roots
    return Pose(rotations, roots)


def _peaks(sources: Sources, positions: Array, moves: Ints, times: Times) -> Array:
    """(J,) rad/s, the fastest each bone turns inside the moves shown."""
    if len(times) < 2:
        return np.zeros(len(sources.skeleton))
    speeds = link_speeds(sources.skeleton, positions, times)
    return speeds[np.diff(moves) == 0].max(axis=0, initial=0.0)


def _middle(roots: Array) -> Array:
    """The middle of the ground the roots (F, 3) cover, at height 0."""
    return (roots.min(axis=0) + roots.max(axis=0)) / 2 * np.array([1.0, 1.0, 0.0])
