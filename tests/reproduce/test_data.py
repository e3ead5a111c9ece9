"""What is not there is said before anything is computed."""

from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.reproduce.data import Data


def test_motions_that_are_not_there_are_refused(tmp_path: Path):
    with pytest.raises(OnbeatError, match=r"no file or folder .*missing"):
        Data(motions=(tmp_path / "missing",)).motion_files()
    with pytest.raises(OnbeatError, match="no motion file in"):
        Data(motions=(tmp_path,)).motion_files()


def test_folders_and_files_are_gathered(tmp_path: Path):
    inside = tmp_path / "clips" / "one.bvh"
    inside.parent.mkdir()
    for path in (inside, tmp_path / "two.bvh"):
        path.write_text("HIERARCHY")
    assert Data(motions=(inside.parent, tmp_path / "two.bvh")).motion_files() == [inside, tmp_path / "two.bvh"]
