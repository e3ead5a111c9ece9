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


def test_a_file_that_stores_no_rate_has_the_one_that_is_told(tmp_path: Path):
    path = tmp_path / "robot.csv"
    path.write_text((",".join(["0", "0", "0.8", "0", "0", "0", "1"] + ["0"] * 29) + "\n") * 12)
    assert Data((path,), fps=60.0).motion(path).fps == 60.0
    with pytest.raises(OnbeatError, match="0 frames a second cannot be"):
        Data((path,), fps=0.0)


def test_folders_and_files_are_gathered(tmp_path: Path):
    inside = tmp_path / "clips" / "one.bvh"
    inside.parent.mkdir()
    for path in (inside, tmp_path / "two.bvh"):
        path.write_text("HIERARCHY")
    assert Data(motions=(inside.parent, tmp_path / "two.bvh")).motion_files() == [inside, tmp_path / "two.bvh"]
