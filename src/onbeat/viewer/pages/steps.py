"""Where feet stand on the floor and how long, as marks for the page.

A mark lasts as long as the foot rests on it: a foot that slides or turns while it stands leaves one mark after the
other, so that every mark lies under the foot that made it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onbeat._shapes import Array, Bools, Positions
from onbeat.motion import Body, Motion
from onbeat.motion.contacts import SIDES, Contacts, foot_contacts, runs
from onbeat.viewer.contract import StepData

MOVED, TURNED = 0.05, 0.35
"""Metres and radians by which a foot may move before it makes another mark."""
SOLE, PART = 1.4, 0.65
"""How long a sole is, and what stands of it on the toe or the heel alone, by the way from ankle to toe."""
SHORTEST = 0.1
"""Seconds: marks that were shorter would only flicker."""


def steps_of(motion: Motion, body: Body | None) -> list[StepData]:
    """Where the feet of a motion stand, in order; none without a body or without feet.

    Examples
    --------
    >>> from onbeat.examples.body import Build
    >>> skeleton = Build(1.7).skeleton
    >>> still = np.tile([1.0, 0, 0, 0], (60, len(skeleton), 1))
    >>> motion = Motion(skeleton, still, np.tile([0, 0, -skeleton.rest_positions[:, 2].min()], (60, 1)), 60.0)
    >>> [(step.foot, step.from_s, step.to_s) for step in steps_of(motion, Body.of(skeleton))]
    [('left', 0.0, 1.0), ('right', 0.0, 1.0)]
    """
    if body is None or not all(f"{side}_ankle" in body for side in SIDES):
        return []
    contacts = foot_contacts(motion, body)
    made = [step for k, side in enumerate(SIDES) for step in _Foot.of(motion, body, contacts, k).steps(side)]
    return sorted(made, key=lambda step: (step.from_s, step.foot))


@dataclass(frozen=True)
class _Foot:
    """A foot over time: (F, 2) middle of what stands, (F,) yaw and length of it, (F,) whether any of it stands."""

    middle: Array
    yaw: Array
    length: Array
    stands: Bools
    fps: float

    @classmethod
    def of(cls, motion: Motion, body: Body, contacts: Contacts, k: int) -> _Foot:
        side, heels, toes = SIDES[k], contacts.heels[:, k], contacts.toes[:, k]
        ankle = motion.positions[:, body[f"{side}_ankle"]]
        toe = _toe(motion, body, side, ankle)
        along = (toe - ankle)[:, :2]
        # The sole goes on behind the ankle and before the toe's joint; a heel or a toe alone is the end of it.
        part = np.where(heels & toes, 0.5, np.where(toes, 0.95, 0.05))
        if f"{side}_toe" not in body:
            part = np.full(len(ankle), 0.5)
        whole = float(np.median(np.linalg.norm(toe - ankle, axis=1)))
        length = whole * np.where((part > 0.1) & (part < 0.9), SOLE, PART)
        return cls(
            ankle[:, :2] + part[:, None] * along,
            np.arctan2(-along[:, 0], along[:, 1]),
            length,
            contacts.feet[:, k],
            motion.fps,
        )

    def steps(self, side: str) -> list[StepData]:
        """Its marks."""
        made = [piece for first, last in runs(self.stands) for piece in self._pieces(first, last)]
        return [self._step(side, first, last) for first, last in made if last - first >= SHORTEST * self.fps]

    def _pieces(self, first: int, last: int) -> list[tuple[int, int]]:
        """A stretch of standing, cut where the foot is elsewhere than at its piece's beginning."""
        cuts = [first]
        while True:
            at, rest = cuts[-1], slice(cuts[-1], last)
            off = np.linalg.norm(self.middle[rest] - self.middle[at], axis=1) > MOVED
            off |= np.abs(np.angle(np.exp(1j * (self.yaw[rest] - self.yaw[at])))) > TURNED
            if not off.any():
                return list(zip(cuts, [*cuts[1:], last], strict=True))
            cuts.append(at + int(off.argmax()))

    def _step(self, side: str, first: int, last: int) -> StepData:
        here = slice(first, last)
        x, y = np.median(self.middle[here], axis=0).round(3).tolist()
        yaw = float(np.angle(np.exp(1j * self.yaw[here]).mean()))
        length = float(np.median(self.length[here]))
        times = round(first / self.fps, 3), round(last / self.fps, 3)
        return StepData(side, *times, x, y, round(yaw, 3), round(length, 3))


def _toe(motion: Motion, body: Body, side: str, ankle: Positions) -> Positions:
    """The toe's joint; of a body without one a place before the ankle where the shin's plane has it."""
    if f"{side}_toe" in body:
        return motion.positions[:, body[f"{side}_toe"]]
    knee = motion.positions[:, body[f"{side}_knee"]] if f"{side}_knee" in body else ankle
    forward = (knee - ankle)[:, :2]
    size = np.maximum(np.linalg.norm(forward, axis=1, keepdims=True), 1e-6)
    return ankle + 0.16 * np.column_stack((forward / size, np.zeros(len(ankle))))
