"""Who dances, and poses, for tests of what passes them on."""

from __future__ import annotations

import numpy as np

from onbeat.live.protocol import Pose, Status, Who

ROBOT = Who("arm", "robot", ("base",), (-1,), ("shoulder", "elbow"), ("base", "hand"), 0.1, 1_700_000_000.25)


def dancer(joints: int = 3) -> Who:
    names = tuple(f"joint {number}" for number in range(joints))
    return Who("ann", "character", names, tuple(range(-1, joints - 1)), (), names, 0.0, 1_700_000_000.25)


def pose(number: int, who: Who = ROBOT) -> Pose:
    """A pose whose numbers tell which it is."""
    turns = np.zeros((len(who.joints) if who.kind == "character" else 1, 4))
    turns[:, 0] = 1.0
    turns[-1] = [0.0, 0.0, 0.0, 1.0]
    angles = np.arange(len(who.hinges)) + number / 1000
    points = np.full((len(who.points), 3), number, np.float32)
    return Pose(number, number / 100, np.array([number / 100, 2.0, 3.0]), turns, angles, points)


def status(time: float, beats: list[float], position: int = 1, hearing: str = "music") -> Status:
    return Status(time, hearing, 120.0, 0.9, 4, position, beats, [0.5], "waltz", 1.0)
