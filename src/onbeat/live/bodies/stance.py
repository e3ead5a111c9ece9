"""The calmest stance that a body takes in its clips: both feet flat, upright, arms low, hardly moving."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import PlanError
from onbeat.motion.body import Body, body_frames, facing
from onbeat.motion.contacts import foot_contacts, point_speeds
from onbeat.motion.motion import Motion

READ = 15.0
"""Hz at which clips are looked through."""
SPEED = 0.2
"""m/s, mean of all joints, that counts as much as each of the following."""
LEAN, ARMS = 0.15, 0.4
"""Radians of trunk and arms from the vertical."""
CROUCH, WIDTH, TWIST = 0.06, 0.6, 0.3
"""Parts of the leg's length by which it is bent, of the hips' width by which feet are apart; radians in the waist."""
LIFTED = 3.0
"""What a foot that does not stand counts."""


def calmest_stance(clips: Sequence[Motion]) -> Motion:
    """The calmest frame of all clips, as a motion of one frame.

    Parameters
    ----------
    clips : of one skeleton.

    Raises
    ------
    PlanError
        If there are no clips.
    """
    if not clips:
        raise PlanError("there are no clips to find a stance in; give one or more")
    body = Body.of(clips[0].skeleton)
    every = [max(1, round(clip.fps / READ)) for clip in clips]
    worst = [unrest(clip, body, step) for clip, step in zip(clips, every, strict=True)]
    best = int(np.argmin([values.min() for values in worst]))
    frame = int(np.argmin(worst[best])) * every[best]
    return clips[best][frame : frame + 1]


def unrest(motion: Motion, body: Body, step: int = 1) -> Array:
    """How far each ``step``-th frame is from standing at ease: a sum of squares, 1 for each measure at its scale."""
    contacts = foot_contacts(motion, body)
    lifted = (LIFTED * (~contacts.heels).sum(axis=1) + (~contacts.feet).sum(axis=1))[::step]
    motion = motion[::step].replace(fps=motion.fps / step)
    speed = point_speeds(motion.positions, motion.fps).mean(axis=1)
    measures = speed / SPEED, *_trunk_and_arms(motion, body), *_legs(motion, body)
    return lifted + np.sum(np.square(measures), axis=0)


def _trunk_and_arms(motion: Motion, body: Body) -> tuple[Array, ...]:
    at = motion.positions
    shoulders = at[:, body.indices("left_shoulder", "right_shoulder")]
    hips = at[:, body.indices("left_hip", "right_hip")]
    lean = _from_vertical(shoulders.mean(axis=1) - at[:, body["hips"]], 1.0)
    elbows = at[:, body.indices("left_elbow", "right_elbow")]
    wrists = at[:, body.indices("left_wrist", "right_wrist")]
    arms = _from_vertical(np.concatenate((elbows - shoulders, wrists - elbows), axis=1), -1.0)
    across = np.stack((shoulders[:, 1] - shoulders[:, 0], hips[:, 1] - hips[:, 0]))
    yaw = np.arctan2(across[..., 1], across[..., 0])
    twist = np.angle(np.exp(1j * (yaw[0] - yaw[1])))
    return lean / LEAN, *(arms.T / ARMS), twist / TWIST


def _legs(motion: Motion, body: Body) -> tuple[Array, ...]:
    at = motion.positions
    ankles = at[:, body.indices("left_ankle", "right_ankle")]
    hips = at[:, body.indices("left_hip", "right_hip")]
    reach = np.linalg.norm(ankles - hips, axis=-1).min(axis=1)
    wide = max(float(np.linalg.norm(hips[0, 1] - hips[0, 0])), 1e-6)
    apart = ankles[:, 1] - ankles[:, 0]
    yaw = facing(body_frames(motion, body)[0])
    side = apart[:, 0] * np.cos(yaw) + apart[:, 1] * np.sin(yaw)
    ahead = apart[:, 1] * np.cos(yaw) - apart[:, 0] * np.sin(yaw)
    crouch = 1 - reach / max(body.leg_length, 1e-6)
    return crouch / CROUCH, (side / wide - 1.2) / WIDTH, ahead / wide / WIDTH


def _from_vertical(directions: Array, up: float) -> Array:
    """Radians between directions (..., 3) and up (1) or down (−1)."""
    return np.arctan2(np.linalg.norm(directions[..., :2], axis=-1), up * directions[..., 2])
