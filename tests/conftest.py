"""Fixtures shared by all tests."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from onbeat.examples.body import Build
from onbeat.motion import Motion
from onbeat.motion import rotations as rot


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of optional real data; tests that ask for it are skipped where it is absent."""
    root = Path(__file__).resolve().parents[1]
    folder = Path(os.environ.get("ONBEAT_DATA", root.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no real data at {folder} (set ONBEAT_DATA)")
    return folder


@pytest.fixture(scope="session")
def swinger() -> Motion:
    """Four seconds of a person who walks a circle of 1 m and swings both arms, each once a second."""
    fps, skeleton = 60.0, Build(1.7).skeleton
    times = np.arange(240) / fps
    rotations = np.tile(rot.IDENTITY, (len(times), len(skeleton), 1))
    rotations[:, 0] = rot.about(np.array([0, 0, 1.0]), np.pi / 2 * times)
    for name, sign in (("LeftArm", -1.0), ("RightArm", 1.0)):
        swing = sign * (0.6 + 0.5 * np.cos(2 * np.pi * times))
        rotations[:, skeleton.index(name)] = rot.about(np.array([0, 1.0, 0]), swing)
    turn = np.pi / 2 * times
    root = np.column_stack((np.cos(turn), np.sin(turn), np.full(len(times), -skeleton.rest_positions[:, 2].min())))
    return Motion(skeleton, rotations, root, fps, name="swinger")
