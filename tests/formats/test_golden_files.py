"""The files of ``tests/golden/motion`` are read as what they were made of, and made again with the same text."""

import json
from pathlib import Path

import numpy as np
import pytest

from onbeat.formats import read_file, write_motion
from onbeat.motion import Markers

FOLDER = Path(__file__).parents[1] / "golden" / "motion"
PLACES = json.loads((FOLDER / "positions.json").read_text())
FILES = sorted(path.name for path in FOLDER.iterdir() if path.suffix != ".json")


@pytest.mark.parametrize("name", FILES)
def test_joints_are_where_they_were(name):
    found = read_file(FOLDER / name, fps=30, up={"trc": "y", "c3d": "z"}.get(name[-3:]))
    assert len(found) == 4
    if isinstance(found, Markers):
        places = dict(zip(found.names, np.moveaxis(found.positions, 1, 0), strict=True))
    else:
        places = dict(zip(found.skeleton.names, np.moveaxis(found.positions, 1, 0), strict=True))
    wanted = PLACES[name.partition(".")[0]]
    shared = [joint for joint in wanted if joint in places]
    assert len(shared) > 20
    for joint in shared:
        np.testing.assert_allclose(places[joint], wanted[joint], atol=3e-6)


@pytest.mark.parametrize("name", [name for name in FILES if name.endswith((".bvh", ".csv"))])
def test_what_is_read_is_written_the_same(name, tmp_path):
    found = read_file(FOLDER / name, fps=30)
    assert not isinstance(found, Markers)
    write_motion(found, tmp_path / name)
    assert (tmp_path / name).read_bytes() == (FOLDER / name).read_bytes()
