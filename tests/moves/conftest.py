"""Clips of the embedded troupe, short enough for quick tests."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.examples.troupe import dance_library
from onbeat.formats import write_motion
from onbeat.motion import Motion


@pytest.fixture(scope="session")
def dances() -> list[Motion]:
    """Seventeen dances of the troupe at 30 fps, four seconds of each."""
    return [performance.motion[60:180] for performance in dance_library(fps=30.0)]


@pytest.fixture
def clips_folder(dances: list[Motion], tmp_path: Path) -> Path:
    """A folder of three dances as npz: a, b and c."""
    folder = tmp_path / "clips"
    folder.mkdir()
    for name, motion in zip("abc", dances, strict=False):
        write_motion(motion, folder / f"{name}.npz")
    return folder
