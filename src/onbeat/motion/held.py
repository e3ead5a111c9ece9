"""Poses of reference before or after a movement, as exporters put them: a T-pose, for one frame or for some seconds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion

FAR, FAST = np.radians(15), 20.0
"""Radians, and radians a second: joints turn by more than both from the pose into the movement, and not on."""
SEVERAL = 3
"""Joints that do so at least: one may be noise."""
ALIKE = np.radians(0.5)
"""Radians up to which a joint is held."""


class Held(NamedTuple):
    """Frames at the beginning and at the end that are a pose by itself."""

    first: int
    last: int


def held_poses(motion: Motion) -> Held:
    """How many frames in front, and at the end, hold one pose from which several joints snap into the movement.

    Examples
    --------
    >>> from onbeat.examples import embedded_motions
    >>> dance = embedded_motions()[0]
    >>> held_poses(dance)
    Held(first=0, last=0)
    >>> pose = np.zeros(len(dance), int)
    >>> pose[20:] = np.arange(len(dance) - 20)
    >>> turned = dance.rotations[pose].copy()
    >>> turned[:20] = [1.0, 0, 0, 0]
    >>> held_poses(dance.replace(rotations=turned))
    Held(first=20, last=0)
    """
    first = _held(motion.rotations, motion.fps)
    return Held(first, 0 if first == len(motion) else _held(motion.rotations[::-1], motion.fps))


def _held(rotations: np.ndarray, fps: float) -> int:
    """Frames at the beginning of rotations (F, J, 4) that are held; none where they do not snap."""
    away = rot.angle_between(rotations[:1], rotations).max(axis=1) > ALIKE
    count = int(away.argmax())
    if count == 0 or count + 2 > len(rotations):
        return 0
    turned = rot.angle_between(rotations[count - 1 : count + 1], rotations[count : count + 2])
    far = (turned > FAR) & (turned * fps > FAST)
    return count if far[0].sum() >= SEVERAL > far[1].sum() else 0
