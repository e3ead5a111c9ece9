"""Fixtures shared by all tests."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from onbeat.examples.body import Build
from onbeat.files import lock_file
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.moves.embedded import embedded_library
from onbeat.moves.library import MoveLibrary


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of optional real data; tests that ask for it are skipped where it is absent."""
    root = Path(__file__).resolve().parents[1]
    folder = Path(os.environ.get("ONBEAT_DATA", root.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no real data at {folder} (set ONBEAT_DATA)")
    return folder


class Kept(NamedTuple):
    """A folder where libraries are kept, and the troupe's, which is there."""

    folder: Path
    troupe: MoveLibrary


@contextmanager
def one_at_a_time(path: Path) -> Iterator[None]:
    """Wait for the other workers of this run that are at it."""
    with path.open("a") as file:
        while True:
            try:
                lock_file(file.fileno())
                break
            except OSError:
                time.sleep(0.05)
        yield


@pytest.fixture(scope="session")
def kept() -> Iterator[Kept]:
    """Where all workers of this run keep libraries: the first one makes the troupe's, the others open it."""
    folder = Path(os.environ["ONBEAT_CACHE"]) / "kept"
    folder.mkdir(parents=True, exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ONBEAT_CACHE", str(folder))
        with one_at_a_time(folder / "troupe.lock"):
            troupe = embedded_library()
        yield Kept(folder, troupe)


@pytest.fixture(scope="session")
def cache(kept: Kept) -> Path:
    """A folder of this run's own where libraries are kept, so that the user's is neither read nor filled."""
    return kept.folder


@pytest.fixture(scope="session")
def troupe(kept: Kept) -> MoveLibrary:
    """The moves of the embedded troupe."""
    return kept.troupe


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
