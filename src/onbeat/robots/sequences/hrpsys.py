"""Sequences for hrpsys' player: ``NAME.pos``, ``NAME.waist`` and ``NAME.zmp``, one line of numbers for each time.

As its ``SequencePlayer`` reads them (fkanehiro/hrpsys-base): each line begins with its time in seconds. After it
``.pos`` has the angles of all joints in rad, in the order of the model's joint ids, which is that of
``Robot.body.names``; ``.waist`` the root's ``x y z`` in metres and ``roll pitch yaw`` in rad with ``R = Rz(yaw)
Ry(pitch) Rx(roll)``; ``.zmp`` the ZMP ``x y z`` in metres **in the root's frame**. The player interpolates between
lines, so that angles go on over π.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat._shapes import Array, Positions, frozen
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.motion import rotations as rot
from onbeat.motion.motion import Motion
from onbeat.robots.model import Robot
from onbeat.robots.sequences.even import even_rate
from onbeat.robots.state import configurations, motion_of

SUFFIXES = (".pos", ".waist", ".zmp")
LARGEST = 1 << 28
"""Bytes of one file."""


class Sequence(NamedTuple):
    """What the three files hold: the motion, and the ZMP (F, 3) in metres in the world."""

    motion: Motion
    zmp: Positions


def write_hrpsys(robot: Robot, motion: Motion, zmp: Array, path: Path) -> tuple[Path, ...]:
    """Write a dance for hrpsys; the paths of the three files.

    Parameters
    ----------
    robot : whose dance it is.
    motion : F frames of it.
    zmp : (F, 2) or (F, 3) metres in the world; of two numbers the height is 0, the floor's.
    path : where, with or without one of the suffixes.

    Raises
    ------
    FormatError
        If there are not as many ZMPs as frames, or one is no number.
    BodyError
        If the motion is not the robot's.
    """
    qpos, points = configurations(robot, motion), np.asarray(zmp, np.float64)
    if points.shape not in ((len(motion), 2), (len(motion), 3)) or not np.isfinite(points).all():
        raise FormatError(f"a ZMP of shape {points.shape}; ({len(motion)}, 2) finite numbers are expected")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    turns = qpos[:, 3:7]
    waist = np.hstack((qpos[:, :3], np.unwrap(rot.to_euler("ZYX", turns)[:, ::-1], axis=0)))
    inside = rot.rotate(rot.inverse(turns), points - qpos[:, :3])
    paths = _paths(path)
    for file, values in zip(paths, (qpos[:, 7:], waist, inside), strict=True):
        write_atomically(file, _lines(motion.times, values))
    return paths


def read_hrpsys(robot: Robot, path: Path) -> Sequence:
    """Read a dance from hrpsys' files back.

    Parameters
    ----------
    robot : whose joints they hold.
    path : with or without one of the suffixes.

    Raises
    ------
    FormatError
        If a file is not there or too large, a line has another count of numbers than expected, times are not even, or
        the files disagree; file and line are named.
    """
    columns = (len(robot.body.names), 6, 3)
    (times, angles), (also, waist), (last, inside) = (_read(*pair) for pair in zip(_paths(path), columns, strict=True))
    for file, other in zip(_paths(path)[1:], (also, last), strict=True):
        if len(other) != len(times) or np.abs(other - times).max() > 1e-6:
            raise FormatError(f"{file}: its times are not those of the .pos; {len(times)} lines are expected")
    turns = rot.from_euler("ZYX", waist[:, :2:-1])
    motion = motion_of(
        robot, np.hstack((waist[:, :3], turns, angles)), even_rate(times, str(_paths(path)[0])), path.stem
    )
    return Sequence(motion, frozen(rot.rotate(turns, inside) + waist[:, :3]))


def _paths(path: Path) -> tuple[Path, ...]:
    stem = path.with_suffix("") if path.suffix in SUFFIXES else path
    return tuple(stem.parent / f"{stem.name}{suffix}" for suffix in SUFFIXES)


def _lines(times: Array, values: Array) -> bytes:
    rows = np.column_stack((times, values)) + 0.0  # no negative zeros
    form = " ".join(["%.9f"] * rows.shape[1]) + "\n"
    return "".join(form % tuple(row) for row in rows.tolist()).encode("ascii")


def _read(path: Path, columns: int) -> tuple[Array, Array]:
    """Times (F,) and values (F, columns)."""
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as error:
        told = error.strerror or error
        raise FormatError(f"cannot read {path}: {told}; all of {', '.join(SUFFIXES)} are expected") from None
    if len(data) > LARGEST:
        raise FormatError(f"{path}: more than {LARGEST >> 20} MB found; no dance has as much")
    rows = [_row(line, columns, f"{path}:{n}") for n, line in enumerate(data.split(b"\n"), 1) if line.strip()]
    if not rows:
        raise FormatError(f"{path} has no line; one for each time is expected")
    table = np.array(rows)
    return table[:, 0], table[:, 1:]


def _row(line: bytes, columns: int, where: str) -> list[float]:
    words = line.split()
    try:
        row = [float(word) for word in words]
    except ValueError:
        row = []
    if len(row) != columns + 1 or not all(abs(value) < 1e6 for value in row):
        found = f"{len(words)} words found: {line[:40]!r}"
        raise FormatError(f"{where}: a time and {columns} numbers are expected, {found}")
    return row
