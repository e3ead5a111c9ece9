"""Toes that no marker tells: they bend where the floor bends them."""

from __future__ import annotations

import numpy as np

from onbeat._shapes import Array
from onbeat.capture.body import SIDES
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion

MOST = np.radians(65.0)
"""How far toes bend upwards at most."""


def bend_toes(motion: Motion, floor: float | None = None) -> Motion:
    """The motion with toes bent up where, straight, they would go through the floor.

    Parameters
    ----------
    motion : of a fitted body.
    floor : height in metres of the toes' joints when the feet stand; found as what they rarely are below.
    """
    skeleton, rotations = motion.skeleton, motion.rotations.copy()
    joints = [skeleton.index(f"{side}ToeBase") for side in SIDES]
    heights = motion.positions[:, joints, 2]
    floor = float(np.percentile(heights.min(axis=1), 5)) if floor is None else floor
    for column, side in enumerate(SIDES):
        joint, end = joints[column], skeleton.index(f"{side}ToeEnd")
        toes = motion.positions[:, end] - motion.positions[:, joint]
        bend = _bend(toes, heights[:, column] - floor)
        rotations[:, joint] = rot.multiply(rotations[:, joint], rot.about(np.array([1.0, 0, 0]), bend))
    return Motion(skeleton, rotations, motion.root_positions, motion.fps, motion.name, motion.translations)


def _bend(toes: Array, height: Array) -> Array:
    """(F,) radians that lift toes (F, 3) so that their tips are not deeper below their joints than the floor is."""
    length = np.maximum(np.linalg.norm(toes, axis=1), 1e-9)
    down = np.arcsin(np.clip(-toes[:, 2] / length, -1, 1))
    room = np.arcsin(np.clip(height / length, 0, 1))
    return np.clip(down - room, 0.0, MOST)
