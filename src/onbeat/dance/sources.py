"""The clips of a plan, placed on the ground and read on the dance's own clock.

Every move shows its clip turned about the vertical and shifted on the ground, so that at each join the dancer goes on
from where they are and to where they face. A move can be read beyond its ends too: blends need what a clip does
around a join.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations, Times
from onbeat.dance.plan import DancePlan
from onbeat.dance.stage import MOST, steering
from onbeat.errors import FormatError, PlanError
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body, body_frames, facing
from onbeat.motion.motion import Motion
from onbeat.motion.skeleton import Skeleton

Warp = Callable[[Times], Times]
"""From the dance's seconds to the plan's seconds, never going back."""
FAR = 0.95
"""Cosine of half the angle between neighbouring frames below which rotations are read linearly."""
BEYOND = 0.1
"""Seconds a move may go past the ends of its clip; the end's pose is held."""
PATH_STEP = 0.2
"""Seconds between the points of the path by which a dance is kept on the stage."""
CLOCK_STEP = 1 / 480
"""Seconds between the points at which a warp is inverted."""


class Pose(NamedTuple):
    """N poses: local rotations (N, J, 4) wxyz and root positions (N, 3) in metres."""

    rotations: Rotations
    roots: Positions


def sample(clips: Sequence[Motion], which: Ints, seconds: Times) -> Pose:
    """Poses of clips ``which`` (N,) at ``seconds`` (N,), held past the ends of a clip.

    Frames are shown as they are; between frames a cubic through the four around it (Catmull-Rom, on quaternions made
    unit again) keeps velocities continuous, so that slow clips and warped time do not stutter.
    """
    joints = len(clips[0].skeleton)
    rotations, roots = np.empty((len(which), joints, 4)), np.empty((len(which), 3))
    for index in np.unique(which):
        clip, rows = clips[index], np.flatnonzero(which == index)
        frames = np.clip(seconds[rows] * clip.fps, 0, len(clip) - 1)
        low = np.minimum(np.floor(frames + 1e-4).astype(np.int64), len(clip) - 1)
        part = np.maximum(frames - low, 0.0)
        rotations[rows], roots[rows] = clip.rotations[low], clip.root_positions[low]
        between = part > 1e-4
        if between.any():
            rotations[rows[between]], roots[rows[between]] = _between(clip, low[between], part[between])
    return Pose(rotations, roots)


def _between(clip: Motion, low: Ints, part: Array) -> Pose:
    """Poses a ``part`` (N,) of a frame after the frames ``low`` (N,)."""
    near = np.clip(low[:, None] + np.arange(-1, 3), 0, len(clip) - 1)
    weights = catmull_rom(part)
    q = clip.rotations[near]
    along = np.sum(q * q[:, 1:2], axis=-1, keepdims=True)
    blended = np.sum(np.where(along < 0, -q, q) * weights[:, :, None, None], axis=1)
    # Where a joint turns far from one frame to the next (a fault of the capture) a cubic would overshoot.
    far = np.abs(along).min(axis=1)[..., 0] < FAR
    rotations = rot.normalise(blended)
    if far.any():
        rotations[far] = rot.slerp(q[:, 1][far], q[:, 2][far], np.broadcast_to(part[:, None], far.shape)[far])
    return Pose(rotations, np.sum(clip.root_positions[near] * weights[..., None], axis=1))


def catmull_rom(u: Array) -> Array:
    """(N, 4) weights of the values at -1, 0, 1 and 2 for a cubic read at ``u`` (N,) between 0 and 1."""
    powers = np.stack((np.ones_like(u), u, u**2, u**3), axis=-1)
    return powers @ (np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]]) / 2)


@dataclass(frozen=True)
class Sources:
    """M moves, placed, on the dance's clock.

    Parameters
    ----------
    clips : motions of one skeleton.
    plan : its moves.
    warp : dance seconds to plan seconds.
    starts : (M,) dance seconds at which each move begins.
    turns : (M,) radians by which each move is turned about the vertical.
    shifts : (M, 3) metres by which it is then shifted.
    """

    clips: Sequence[Motion]
    plan: DancePlan
    warp: Warp
    starts: Times
    turns: Array
    shifts: Positions

    @classmethod
    def of(cls, clips: Sequence[Motion], plan: DancePlan, warp: Warp | None = None) -> Sources:
        """The moves of a plan, not yet placed; raises if the plan and the clips do not fit."""
        _check(clips, plan)
        moves = len(plan.moves)
        warp = _same_time if warp is None else warp
        starts = np.concatenate(([0.0], _inverse(warp, plan.join_times, plan.duration)))
        return cls(clips, plan, warp, starts, np.zeros(moves), np.zeros((moves, 3)))

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton of all clips."""
        return self.clips[0].skeleton

    @property
    def joins(self) -> Times:
        """(M-1,) dance seconds of the joins."""
        return self.starts[1:]

    @property
    def clip_of(self) -> Ints:
        """(M,) the clip of each move."""
        return np.array([move.clip for move in self.plan.moves], np.int64)

    def moves_at(self, times: Times) -> Ints:
        """Which move is shown at dance times (N,)."""
        return np.searchsorted(self.starts, times + 1e-9, side="right") - 1

    def seconds(self, moves: Ints, times: Times) -> Times:
        """Seconds in their clips of ``moves`` (N,) at dance times (N,)."""
        begins, froms, rates = (
            np.array([getattr(move, name) for move in self.plan.moves]) for name in ("at_s", "from_s", "rate")
        )
        planned = self.warp(np.clip(times, 0.0, self.plan.duration))
        return froms[moves] + rates[moves] * (planned - begins[moves])

    def pose(self, moves: Ints, times: Times) -> Pose:
        """Placed poses of ``moves`` (N,) at dance times (N,)."""
        raw = sample(self.clips, self.clip_of[moves], self.seconds(moves, times))
        turn = rot.yaw(self.turns[moves])
        raw.rotations[:, 0] = rot.multiply(turn, raw.rotations[:, 0])
        return Pose(raw.rotations, rot.rotate(turn, raw.roots) + self.shifts[moves])


def placed(sources: Sources, body: Body, standing: Sequence[Bools], steer: float = MOST) -> Sources:
    """The moves turned and shifted so that facing and ground position go on at every join.

    The point that stays is the foot that stands on both sides of the join (the middle of both feet where both do), so
    that a planted foot is not moved; where none does, the waist. Facing is that of the frontal vector. Where the dancer
    would walk off, joins turn the dance by up to ``steer`` radians more or less (:mod:`onbeat.dance.stage`).

    Parameters
    ----------
    sources : the moves.
    body : roles of their skeleton.
    standing : for each clip, (F, 2) true where the left, right foot rests.
    steer : radians, 0 for facing that goes on exactly.
    """
    gaps, left, entered = pivots(sources, body, standing)
    first = sources.pose(np.zeros(1, np.int64), np.zeros(1))
    start = Motion(sources.skeleton, first.rotations, first.roots, fps=1.0)
    turn = -float(facing(body_frames(start, body)[0])[0])
    shift = on_ground(-rot.rotate(rot.yaw(turn), start.positions[0, body["hips"]]))
    straight = _chained(sources, turn, shift, gaps, left, entered)
    if steer <= 0 or not len(gaps):
        return straight
    times = np.arange(0.0, sources.plan.duration, PATH_STEP)
    path = straight.pose(straight.moves_at(times), times).roots
    staying = rot.rotate(rot.yaw(straight.turns[:-1]), left) + straight.shifts[:-1]
    steered = gaps + steering(staying, sources.joins, path, times, steer)
    return _chained(sources, turn, shift, steered, left, entered)


def pivots(sources: Sources, body: Body, standing: Sequence[Bools]) -> tuple[Array, Positions, Positions]:
    """(K,) radians from the facing entered to the facing left, and (K, 3) the point that stays, as left and entered."""
    joins, count = sources.joins, len(sources.joins)
    moves, times = np.concatenate((np.arange(count), np.arange(1, count + 1))), np.concatenate((joins, joins))
    if not count:
        return np.zeros(0), np.zeros((0, 3)), np.zeros((0, 3))
    ends = sources.pose(moves, times)
    motion = Motion(sources.skeleton, ends.rotations, ends.roots, fps=1.0)
    yaw = facing(body_frames(motion, body)[0])
    stands = standing_at(sources, standing, moves, times)
    both = stands[:count] & stands[count:]
    weights = both / np.maximum(both.sum(axis=1, keepdims=True), 1)
    feet = motion.positions[:, body.indices(*(f"{side}_{contact_role(body)}" for side in ("left", "right")))]
    feet = np.einsum("kfx,kf->kx", feet, np.tile(weights, (2, 1)))
    points = np.where(np.tile(both.any(axis=1), 2)[:, None], feet, motion.positions[:, body["hips"]])
    return yaw[:count] - yaw[count:], points[:count], points[count:]


def _chained(sources: Sources, turn: float, shift: Array, gaps: Array, left: Positions, entered: Positions) -> Sources:
    """Each move placed so that its entered point comes to where the move before left it, turned by the gap."""
    turns = turn + np.concatenate(([0.0], np.cumsum(gaps)))
    steps = on_ground(rot.rotate(rot.yaw(turns[:-1]), left) - rot.rotate(rot.yaw(turns[1:]), entered))
    shifts = shift + np.concatenate((np.zeros((1, 3)), np.cumsum(steps, axis=0)))
    return Sources(sources.clips, sources.plan, sources.warp, sources.starts, turns, shifts)


def contact_role(body: Body) -> str:
    """The role of the point of the foot that is kept in place: the toe, or the ankle of a body without toes."""
    return "toe" if "left_toe" in body and "right_toe" in body else "ankle"


def standing_at(sources: Sources, standing: Sequence[Bools], moves: Ints, times: Times) -> Bools:
    """(N, 2) whether the left, right foot rests in ``moves`` (N,) at dance times (N,)."""
    out = np.zeros((len(moves), 2), bool)
    which, seconds = sources.clip_of[moves], sources.seconds(moves, times)
    for index in np.unique(which):
        rows, labels = np.flatnonzero(which == index), standing[index]
        frames = np.rint(seconds[rows] * sources.clips[index].fps).astype(np.int64)
        out[rows] = labels[np.clip(frames, 0, len(labels) - 1)]
    return out


def on_ground(shift: Positions) -> Positions:
    """Metres (..., 3) along the floor only."""
    return shift * np.array([1.0, 1.0, 0.0])


def _same_time(times: Times) -> Times:
    return times


def _inverse(warp: Warp, planned: Times, duration: float) -> Times:
    """Dance times at which ``warp`` reaches ``planned`` (N,)."""
    if warp is _same_time or not len(planned):
        return planned
    clock = np.linspace(0.0, duration, max(2, int(np.ceil(duration / CLOCK_STEP)) + 1))
    reached = np.asarray(warp(clock))
    if np.any(np.diff(reached) < -1e-9) or abs(reached[0]) > 1e-3 or abs(reached[-1] - duration) > 1e-3:
        raise PlanError(
            f"the warp takes 0…{duration:.3f} s to {reached[0]:.3f}…{reached[-1]:.3f} s or goes back in time; "
            "it must rise from 0 to the plan's duration"
        )
    return np.interp(planned, reached, clock)


def _check(clips: Sequence[Motion], plan: DancePlan) -> None:
    for number, move in enumerate(plan.moves):
        if not 0 <= move.clip < len(clips):
            raise PlanError(f"move {number} shows clip {move.clip}; there are {len(clips)} clips, counted from 0")
        clip = clips[move.clip]
        if move.from_s < -BEYOND or move.to_s > clip.duration + BEYOND:
            raise PlanError(
                f"move {number} shows {move.from_s:.2f}…{move.to_s:.2f} s of clip {clip.name!r}, which lasts "
                f"{clip.duration:.2f} s; plan within the clip"
            )
    for index in sorted({move.clip for move in plan.moves}):
        clip, first = clips[index], clips[plan.moves[0].clip]
        if clip.skeleton != first.skeleton:
            raise FormatError(
                f"clip {clip.name!r} has another skeleton than {first.name!r}; retarget all clips to one skeleton first"
            )
        if clip.translations is not None:
            raise FormatError(f"clip {clip.name!r} has animated bone offsets; retarget it to a fixed skeleton first")
