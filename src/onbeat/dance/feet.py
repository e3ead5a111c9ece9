"""Feet that rest on the floor stay where they are through a join.

Around a join a resting foot follows neither clip's blend but an anchor: in its own clip's manner (the little it slips,
how the heel rises) but moved and turned on the floor so that the two clips' feet meet. The way from the blended foot to
its anchor is eased in and out while the foot is in the air. The legs follow by two-bone inverse kinematics; where a leg
would be too short the pelvis sinks a little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations, Times
from onbeat.dance.blend import Windows, quintic
from onbeat.dance.pelvis import sunk
from onbeat.dance.sources import Pose, contact_role
from onbeat.dance.steps import Steps
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.contacts import SIDES, runs, twist
from onbeat.motion.kinematics import forward_kinematics
from onbeat.motion.legs import place_foot

EASE, QUICKEST = 0.3, 0.12
"""Seconds in which a foot leaves its anchor or comes to it; the second where its step is shorter."""


@dataclass(frozen=True)
class Foot:
    """One foot through F frames.

    Parameters
    ----------
    ankles : (F, 3) metres.
    soles : (F, 3) metres, the point that touches the floor: the toe, or the ankle of a body without toes.
    turns : (F, 4) wxyz, the world rotation of the ankle.
    """

    ankles: Positions
    soles: Positions
    turns: Rotations

    @classmethod
    def of(cls, body: Body, side: str, world: tuple[Rotations, Positions]) -> Foot:
        """The foot of ``side`` in world rotations (F, J, 4) and positions (F, J, 3)."""
        ankle, sole = body[f"{side}_ankle"], body[f"{side}_{contact_role(body)}"]
        return cls(world[1][:, ankle], world[1][:, sole], world[0][:, ankle])

    def part(self, frames: slice) -> Foot:
        """Some of the frames."""
        return Foot(self.ankles[frames], self.soles[frames], self.turns[frames])


def plant_feet(
    body: Body,
    pose: Pose,
    shown: tuple[Rotations, Positions],
    steps: Steps,
    moves: Ints,
    windows: Windows,
    times: Times,
) -> Pose:
    """The poses with the feet that rest around joins kept in place.

    Parameters
    ----------
    body : roles of the skeleton.
    pose : F blended poses.
    shown : world rotations (F, J, 4) and positions (F, J, 3) of the clips before blending.
    steps : when each foot rests, and how high it is lifted where it must step.
    moves : (F,) the move each frame shows.
    windows : of the joins.
    times : (F,) seconds.
    """
    if not len(windows.centres):
        return pose
    world = forward_kinematics(body.skeleton, pose.rotations, pose.roots)
    targets: dict[str, Foot] = {}
    changed = np.zeros(len(times), bool)
    for number, side in enumerate(SIDES):
        foot = Foot.of(body, side, world)
        offsets = _offsets(Foot.of(body, side, shown), foot, steps.contacts[:, number], moves, windows, times)
        offsets[:, 2] += steps.lifts[:, number]
        targets[side] = Foot(
            foot.ankles + offsets[:, :3], foot.soles, rot.multiply(rot.exp(offsets[:, 3:]), foot.turns)
        )
        changed |= np.abs(offsets).max(axis=1) > 1e-7
    roots = pose.roots - sunk(body, world, {side: foot.ankles for side, foot in targets.items()}, changed, times)
    frames = np.flatnonzero(changed | np.any(roots != pose.roots, axis=1))
    return stepped(body, Pose(pose.rotations, roots), targets, frames)


def stepped(body: Body, pose: Pose, targets: dict[str, Foot], frames: Ints) -> Pose:
    """The poses with both feet put to their targets, one a side, in ``frames``."""
    rotations, roots = pose.rotations[frames], pose.roots[frames]
    world = forward_kinematics(body.skeleton, rotations, roots)
    for side, foot in targets.items():
        rotations = place_foot(body, side, rotations, world, foot.ankles[frames], foot.turns[frames])
    out = pose.rotations.copy()
    out[frames] = rotations
    return Pose(out, pose.roots)


def _offsets(shown: Foot, blended: Foot, rests: Bools, moves: Ints, windows: Windows, times: Times) -> Array:
    """(F, 6) from the blended ankle to where it should be: metres, and a world rotation vector in radians."""
    offsets, held = np.zeros((len(times), 6)), np.zeros(len(times), bool)
    inside = windows.join_at(times) >= 0
    for first, last in runs(rests):
        if inside[first:last].any():
            span = slice(first, last)
            part = shown.part(span)
            held_at = anchored(part, anchors(part, moves[span]), moves[span], windows, times[span])
            offsets[span] = offset_between(blended.part(span), held_at)
            held[span] = True
    return eased(offsets, held, rests, times)


def offset_between(foot: Foot, goal: Foot) -> Array:
    """(F, 6) from one foot to another: metres of the ankle, and a world rotation vector in radians."""
    turned = rot.log(rot.multiply(goal.turns, rot.inverse(foot.turns)))
    return np.concatenate((goal.ankles - foot.ankles, turned), axis=1)


def anchors(foot: Foot, moves: Ints, given: Array | None = None) -> Array:
    """(F, 4) how the pieces of one run are moved on the floor so that they meet at the joins: x, y, z = 0 and yaw.

    They are moved such that, weighed by how long they last, they are moved the least.

    Parameters
    ----------
    foot : the clips' own through one run.
    moves : (F,) the move each frame shows.
    given : (4,) how the first piece is moved, where that is settled already.
    """
    joins = np.flatnonzero(np.diff(moves)) + 1
    edges = np.concatenate(([0], joins, [len(moves)]))
    weights = np.diff(edges) / len(moves)
    turned = np.array([twist(foot.turns[j - 1], foot.turns[j]) for j in joins])
    gaps, yaws = np.zeros((0, 3)), np.concatenate(([0.0], -np.cumsum(turned)))
    if len(joins):
        gaps = (foot.soles[joins - 1] - foot.soles[joins]) * np.array([1.0, 1.0, 0.0])
    shifts = np.concatenate((np.zeros((1, 3)), np.cumsum(gaps, axis=0)))
    keep = int(np.argmin(np.linalg.norm(shifts[:, None] - shifts, axis=-1) @ weights)) if given is None else 0
    pieces = np.column_stack((shifts - shifts[keep], yaws - yaws[keep]))
    return np.repeat(pieces if given is None else pieces + given, np.diff(edges), axis=0)


def anchored(foot: Foot, anchors: Array, moves: Ints, windows: Windows, times: Times) -> Foot:
    """The clips' own foot through one run, moved and turned on the floor by its anchors (F, 4).

    Height and tilt of the two clips at a join are eased into each other over its window.
    """
    soles, turns = foot.soles + anchors[:, :3], rot.multiply(rot.yaw(anchors[:, 3]), foot.turns)
    for j in (np.flatnonzero(np.diff(moves)) + 1).tolist():
        _meet(soles, turns, j, moves, windows, times)
    arms = rot.rotate(rot.inverse(foot.turns), foot.ankles - foot.soles)
    return Foot(soles + rot.rotate(turns, arms), soles, turns)


def _meet(soles: Positions, turns: Rotations, frame: int, moves: Ints, windows: Windows, times: Times) -> None:
    """Ease height and tilt of one clip's foot into the other's over the window of the join at ``frame``, in place."""
    join = int(moves[frame - 1])
    near = np.flatnonzero((times > windows.starts[join]) & (times < windows.ends[join]))
    later = near >= frame
    share = quintic((times[near] - windows.starts[join]) / windows.spans[join]) - later
    rise = soles[frame, 2] - soles[frame - 1, 2]
    tilt = rot.log(rot.multiply(rot.inverse(turns[frame - 1]), turns[frame]))
    soles[near, 2] += rise * share
    turns[near] = rot.multiply(turns[near], rot.exp(tilt * share[:, None]))


def eased(offsets: Array, held: Bools, rests: Bools, times: Times) -> Array:
    """Offsets (F, 6) with those between runs that are ``held`` (F,) filled by cubics that go to zero within a step."""
    out, frames = offsets.copy(), len(offsets)
    step = times[1] - times[0] if frames > 1 else 1.0
    ease, quickest = max(1, round(EASE / step)), max(1, round(QUICKEST / step))
    spans, stands = runs(held), np.array(runs(rests)).reshape(-1, 2)
    landings, leavings = np.append(stands[:, 0], frames + ease), np.insert(stands[:, 1], 0, -ease)
    for k, (first, last) in enumerate(spans):
        after = int(landings[np.searchsorted(landings, last)]) - last
        before = first - int(leavings[np.searchsorted(leavings, first, side="right") - 1])
        leave, arrive = last - 1 + min(max(after, quickest), ease), first - min(max(before, quickest), ease)
        following = spans[k + 1][0] if k + 1 < len(spans) else frames + 2 * ease
        previous = spans[k - 1][1] if k else -2 * ease
        if following - last < 2 * ease:
            out[last:following] = _cubic(offsets, last - 1, following)
        else:
            out[last : min(leave, frames)] = _cubic(offsets, last - 1, leave)[: frames - last]
        if first - previous >= 2 * ease:
            fill = _cubic(offsets, arrive, first)
            begin = max(arrive + 1, 0)
            out[begin:first] = fill[len(fill) - (first - begin) :]
    return out


def _cubic(offsets: Array, left: int, right: int) -> Array:
    """Values strictly between frames ``left`` and ``right`` of the cubic that meets value and velocity at both."""
    u = (np.arange(left + 1, right) - left)[:, None] / (right - left)
    (a, va), (b, vb) = _end(offsets, left, -1), _end(offsets, right, 1)
    span = right - left
    start = (2 * u**3 - 3 * u**2 + 1) * a + (u**3 - 2 * u**2 + u) * span * va
    return start + (3 * u**2 - 2 * u**3) * b + (u**3 - u**2) * span * vb


def _end(offsets: Array, frame: int, inward: int) -> tuple[Array, Array]:
    """Value and change a frame of the offsets at a held frame; zero where nothing is held."""
    none = np.zeros(6)
    if not 0 <= frame < len(offsets) or not offsets[frame].any():
        return none, none
    beside = frame + inward
    if not 0 <= beside < len(offsets):
        return offsets[frame], none
    return offsets[frame], (offsets[beside] - offsets[frame]) * inward
