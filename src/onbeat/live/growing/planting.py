"""Feet of a growing dance stay where they stand, though what comes next is not known when they land.

As in :mod:`onbeat.dance.feet`, but going on from frames that cannot change any more: a foot that rests there goes on
resting where it is, and whatever else is on its way there (a foot in the air, a pelvis that sinks) goes on with its
velocity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Ints, Positions, Rotations, Times
from onbeat.dance.blend import Windows, quintic
from onbeat.dance.feet import EASE, Foot, anchored, anchors, eased, offset_between, stepped
from onbeat.dance.pelvis import SPREAD, sunk
from onbeat.dance.sources import Pose, contact_role
from onbeat.dance.steps import Steps, steps_between
from onbeat.live.growing.frames import Frames
from onbeat.motion import rotations as rot
from onbeat.motion.body import Body
from onbeat.motion.contacts import SIDES, runs
from onbeat.motion.kinematics import forward_kinematics

World = tuple[Rotations, Positions]
"""World rotations (F, J, 4) and positions (F, J, 3)."""


@dataclass(frozen=True, eq=False)
class Floor:
    """What F frames show before their feet are planted.

    Parameters
    ----------
    body : roles of the skeleton.
    times : (F,) seconds, evenly spaced.
    moves, numbers : (F,) the move each frame shows, counted from the first shown, and in the whole dance.
    windows : of the joins.
    before : what these frames were, as far as they were; the first ``fixed`` of them stay as they were.
    fixed : number of frames that stay, at most two.
    """

    body: Body
    times: Times
    moves: Ints
    numbers: Ints
    windows: Windows
    before: Frames
    fixed: int

    @property
    def frames(self) -> int:
        """How many."""
        return len(self.times)

    @property
    def _step(self) -> float:
        return float(self.times[1] - self.times[0]) if self.frames > 1 else 1.0

    def steps(self, standing: Bools, shown: World) -> Steps:
        """When each foot rests and steps; ``standing`` (F, 2) is where it rests in the clips shown."""
        turned = shown[0][:, self.body.indices("left_ankle", "right_ankle")]
        soles = shown[1][:, self.body.indices(*(f"{side}_{contact_role(self.body)}" for side in SIDES))]
        strayed = np.zeros((2, 3))
        if self.fixed:
            last = self.before.anchors[self.fixed - 1][:, [0, 1, 3]]
            strayed = np.where(self.before.contacts[self.fixed - 1][:, None], -last, 0.0)
        return steps_between(standing, soles, turned, self.moves, self.windows, self.times, strayed)

    def held(self, side: int, shown: Foot, blended: Foot, rests: Bools) -> tuple[Array, Array]:
        """(F, 6) offsets from the blended ankle to where it should be, and the (F, 4) anchors that lead there."""
        offsets, moved = np.zeros((self.frames, 6)), np.zeros((self.frames, 4))
        holds, inside = np.zeros(self.frames, bool), self.windows.join_at(self.times) >= 0
        for first, last in runs(rests):
            given, span = self._given(side, first, last), slice(first, last)
            if not inside[span].any() and (given is None or not given.any()):
                continue
            foot, moves = shown.part(span), self.moves[span]
            moved[span] = anchors(foot, moves, given)
            goal = anchored(foot, moved[span], moves, self.windows, self.times[span])
            offsets[span] = offset_between(blended.part(span), goal)
            holds[span] = True
        return self._from_fixed(side, offsets, holds, rests), moved

    def _given(self, side: int, first: int, last: int) -> Array | None:
        """(4,) the anchor that a run of frames keeps from its first on, None where it is free.

        A foot that is about to land keeps to where it was going to: there is no time to lead it elsewhere.
        """
        if first >= self.fixed + round(EASE / self._step) or not self.fixed:
            return None
        frame = max(first, min(self.fixed, last) - 1)
        known = frame < len(self.before) and self.before.moves[frame] == self.numbers[frame]
        if known and self.before.contacts[frame, side]:
            return self.before.anchors[frame, side]
        return np.zeros(4)

    def _from_fixed(self, side: int, offsets: Array, holds: Bools, rests: Bools) -> Array:
        """The offsets between held runs filled in, going on from those of the frames that stay."""
        fixed = self.before.offsets[: self.fixed, side]
        flying = np.flatnonzero(~rests[: self.fixed] & fixed.any(axis=1))
        offsets[flying], holds[flying] = fixed[flying], True
        return going_on(eased(offsets, holds, rests, self.times), fixed, EASE / self._step)

    def sinks(self, world: World, targets: dict[str, Foot], changed: Bools) -> Array:
        """(F, 1) metres by which the pelvis is lowered."""
        ankles = {side: foot.ankles for side, foot in targets.items()}
        down = sunk(self.body, world, ankles, changed, self.times)[:, 2:]
        return going_on(down, self.before.sinks[: self.fixed], 2 * SPREAD / self._step)


def planted(floor: Floor, pose: Pose, shown: World, steps: Steps) -> tuple[Pose, Array, Array, Array]:
    """The blended poses with resting feet in place; offsets (F, 2, 6), anchors (F, 2, 4) and sinks (F, 1) of them."""
    body, count = floor.body, floor.frames
    world = forward_kinematics(body.skeleton, pose.rotations, pose.roots)
    targets: dict[str, Foot] = {}
    offsets, moved = np.zeros((count, 2, 6)), np.zeros((count, 2, 4))
    for side, name in enumerate(SIDES):
        foot, clip = Foot.of(body, name, world), Foot.of(body, name, shown)
        offsets[:, side], moved[:, side] = floor.held(side, clip, foot, steps.contacts[:, side])
        offsets[:, side, 2] += steps.lifts[:, side]
        turns = rot.multiply(rot.exp(offsets[:, side, 3:]), foot.turns)
        targets[name] = Foot(foot.ankles + offsets[:, side, :3], foot.soles, turns)
    changed = np.abs(offsets).max(axis=(1, 2)) > 1e-7
    sinks = floor.sinks(world, targets, changed)
    roots = pose.roots - sinks * np.array([0.0, 0.0, 1.0])
    frames = np.flatnonzero(changed | (sinks[:, 0] != 0.0))
    return stepped(body, Pose(pose.rotations, roots), targets, frames), offsets, moved, sinks


def going_on(values: Array, fixed: Array, frames: float) -> Array:
    """Values (F, k) that go on from the first few of them, which were ``fixed`` (h, k), within so many frames.

    The difference at the last fixed frame, and how it changes, is eased out.

    Examples
    --------
    >>> going_on(np.zeros((5, 1)), np.ones((2, 1)), 4.0).ravel().round(2).tolist()
    [1.0, 1.0, 0.9, 0.5, 0.1]
    """
    last = len(fixed) - 1
    if last < 0:
        return values
    gap = fixed[last] - values[last]
    run = gap - (fixed[last - 1] - values[last - 1]) if last else np.zeros_like(gap)
    out = values.copy()
    out[: last + 1] = fixed
    ahead = np.arange(1, len(values) - last)[:, None]
    u = np.minimum(ahead / frames, 1.0)
    out[last + 1 :] += gap * (1 - quintic(u)) + run * ahead * (1 - u) ** 3
    return out
