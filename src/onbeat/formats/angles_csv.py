"""Joint angles as a table for spreadsheets and statistics: ``.angles.csv``, one line a frame.

Columns: ``time`` in seconds, the root's ``x y z`` in metres, then for each joint its Euler angles in degrees as
``<joint> <axis>``, about moving axes in the order Z, X, Y, without jumps from frame to frame. Z up.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention
from onbeat.formats.decimals import decimal_rows
from onbeat.motion import Motion
from onbeat.motion.angles import euler_angles

ORDER = "ZXY"


def write_angles_csv(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write the table; it is always in metres and degrees with Z up.

    Raises
    ------
    FormatError
        If another convention is asked for.
    """
    if convention is not None and convention != Convention("z", "m"):
        raise FormatError("an .angles.csv table is always in metres with Z up; leave the unit and the axis out")
    turning = np.flatnonzero(~motion.skeleton.end_sites)
    names = [motion.skeleton.names[joint] for joint in turning]
    head = io.StringIO()
    columns = ["time", "x", "y", "z", *(f"{name} {axis}" for name in names for axis in ORDER)]
    csv.writer(head, lineterminator="\n").writerow(columns)
    angles = np.degrees(euler_angles(motion, ORDER)[:, turning]).reshape(len(motion), -1)
    table = np.concatenate((motion.times[:, None], motion.root_positions, angles), axis=1)
    write_atomically(path, head.getvalue().encode() + decimal_rows(table, between=","))
