import csv

import numpy as np
import pytest

from onbeat.errors import FormatError
from onbeat.formats import Convention
from onbeat.formats.angles_csv import write_angles_csv
from onbeat.motion import rotations as rot
from persons import person, swinging


def test_the_table_has_a_line_for_each_frame_that_gives_the_motion_back(tmp_path):
    motion = swinging(person(), 12, 30)
    write_angles_csv(motion, tmp_path / "a.angles.csv")
    with open(tmp_path / "a.angles.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 12
    assert float(rows[3]["time"]) == pytest.approx(0.1)
    assert [float(rows[3][axis]) for axis in "xyz"] == pytest.approx(motion.root_positions[3].tolist(), abs=1e-6)
    elbow = np.radians([float(rows[3][f"LeftElbow {axis}"]) for axis in "ZXY"])
    joint = motion.skeleton.index("LeftElbow")
    assert rot.angle_between(rot.from_euler("ZXY", elbow), motion.rotations[3, joint]) < 1e-6
    assert "Head_end Z" not in rows[0]


def test_other_conventions_are_refused(tmp_path):
    with pytest.raises(FormatError, match="always in metres"):
        write_angles_csv(swinging(person(), 2), tmp_path / "a.angles.csv", Convention("y", "cm"))
