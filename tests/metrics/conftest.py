"""A small body and motions of it whose scores are known by construction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

SIDE_JOINTS = ("humerus", "radius", "wrist", "femur", "tibia", "foot", "toes")
NAMES = ("hips", "chest", *(side + joint for side in "lr" for joint in SIDE_JOINTS))
PARENTS = [-1, 0, 1, 2, 3, 0, 5, 6, 7, 1, 9, 10, 0, 12, 13, 14]
_LEFT = [[-0.2, 0, 0.1], [0, 0, -0.3], [0, 0, -0.25], [-0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4], [0, 0.1, -0.05]]
OFFSETS = [[0, 0, 0], [0, 0, 0.4], *_LEFT, *([-x, y, z] for x, y, z in _LEFT)]

Wave = Callable[..., Motion]


@pytest.fixture
def skeleton() -> Skeleton:
    return Skeleton(NAMES, PARENTS, OFFSETS)


@pytest.fixture
def sway(skeleton: Skeleton) -> Wave:
    """Both arms swing like pendulums: the wrists stop every ``every`` seconds, the first time at ``first``."""

    def make(seconds: float = 10.0, fps: float = 60.0, every: float = 0.5, first: float = 0.25) -> Motion:
        times = np.arange(round(seconds * fps)) / fps
        angle = 0.8 * np.cos(np.pi * (times - first) / every)
        rotations = np.tile(rot.IDENTITY, (len(times), len(skeleton), 1))
        for name in ("lhumerus", "rhumerus"):
            rotations[:, skeleton.index(name)] = rot.about(np.array([1.0, 0, 0]), angle)
        return Motion(skeleton, rotations, np.tile([0, 0, 0.85], (len(times), 1)), fps)

    return make
