"""A robot's joint angles as a table: CSV with a header that names the joints, one line a frame.

The first column may be ``time`` in seconds, in even steps, which gives the rate; all others are joints, in radians (or
in degrees, where that is said). Columns ``x``, ``y`` and ``z`` would be a root's path: such files are motions, which
:mod:`onbeat.formats.robot_csv` reads, or ``.angles.csv`` tables for statistics.
"""

from __future__ import annotations

import csv
import io
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.decimals import decimal_rows
from onbeat.formats.rates import ASK
from onbeat.formats.text import decoded, open_text, small_text
from onbeat.motion.joint_angles import JointAngles

_LARGEST = 1 << 28
"""Bytes; 30 joints at 100 Hz fill it in over two hours."""
_HEAD = 1 << 16
_TIME = ("time", "t", "seconds")
_ROOT = {"x", "y", "z"}
_BEYOND = 1e6
"""Radians that no joint turns."""
_UNLIKELY = 20.0
"""Radians that hardly any joint reaches: three turns."""
_UNEVEN = 0.2
"""The part of a step by which a time may be off its place."""
_PRINTED = 0.03
"""The part by which a rate by printed times may be off a usual one: of 60 frames in thousandths of a second."""
_PLACES = 9


class AngleWarning(UserWarning):
    """Angles so large that they look like degrees."""


def read_joint_table(path: str | Path, fps: float | None = None, degrees: bool = False) -> JointAngles:
    """Read a table of joint angles.

    Parameters
    ----------
    path : the ``.csv`` file.
    fps : the rate of its frames; it counts more than a column of times, and is needed where there is none.
    degrees : the angles are in degrees.

    Raises
    ------
    FormatError
        If it is no such table; line and column, what was found and what is expected are named.
    """
    path = Path(path)
    lines = small_text(path, _LARGEST, "a table of joint angles").split("\n")
    kept = [(number, line) for number, line in enumerate(lines, 1) if line and not line.isspace()]
    if not kept:
        raise FormatError(f"{path} is empty; a line with the names of joints, and lines of numbers, are expected")
    columns = _columns(kept[0][1], f"{path}:{kept[0][0]}")
    if len(kept) == 1:
        raise FormatError(f"{path} has names of joints and no frame; lines of {len(columns)} numbers are expected")
    table = _numbers(kept[1:], columns, str(path))
    timed = columns[0].lower() in _TIME
    angles = table[:, timed:]
    if fps is None:
        fps = _rate(table[:, 0] if timed else None, kept, str(path))
    if not degrees and np.abs(angles).max() > _UNLIKELY:
        most = float(np.abs(angles).max())
        warnings.warn(f"{path} has angles up to {most:.4g} rad; are they degrees? Say so", AngleWarning, stacklevel=2)
    return JointAngles(columns[timed:], np.radians(angles) if degrees else angles, fps, path.stem)


def is_joint_table(path: str | Path) -> bool:
    """Whether a file begins with names of joints and a line of as many numbers."""
    try:
        with open_text(Path(path)) as file:
            lines = decoded(file.read(_HEAD)).split("\n")
        kept = [(number, line) for number, line in enumerate(lines, 1) if line and not line.isspace()][:2]
        return len(kept) == 2 and len(_numbers(kept[1:], _columns(kept[0][1], ""), "")) == 1
    except FormatError:
        return False


def _columns(line: str, label: str) -> tuple[str, ...]:
    """The names in the first line."""
    if line.count(",") < max(line.count(";"), line.count("\t")):
        raise FormatError(f"{label}: columns with semicolons or tabs found; commas are expected")
    try:
        words = [word.strip() for word in next(csv.reader([line], skipinitialspace=True))]
    except csv.Error as error:
        raise FormatError(f"{label}: no line of a CSV ({error}); names of joints with commas are expected") from None
    if sum(map(_is_number, words)) > len(words) / 2:
        raise FormatError(f"{label}: numbers found; the first line has to name the joints")
    for column, word in enumerate(words, 1):
        if not word:
            raise FormatError(f"{label}: column {column} has no name; that of a joint is expected")
    twice = [word for word, count in Counter(words).items() if count > 1]
    if twice:
        raise FormatError(f"{label}: more than one column is named {twice[0][:60]}")
    if {word.lower() for word in words} >= _ROOT:
        raise FormatError(f"{label}: columns x, y and z found: a motion with a root; a joint table has joints alone")
    if len(words) == (words[0].lower() in _TIME):
        raise FormatError(f"{label}: no column but {words[0]!r} found; columns of joints are expected")
    return tuple(words)


def _is_number(word: str) -> bool:
    try:
        return "_" not in word and abs(float(word)) <= _BEYOND
    except ValueError:
        return False


def _numbers(lines: list[tuple[int, str]], columns: tuple[str, ...], label: str) -> Array:
    """The numbers of lines (rows, columns); what is wrong with them is named by line and column."""
    try:
        text = [line for _, line in lines]
        table = np.loadtxt(text, np.float64, delimiter=",", comments=None, quotechar='"', ndmin=2)
    except ValueError:
        table = np.zeros((0, 0))
    with np.errstate(invalid="ignore"):
        good = table.shape == (len(lines), len(columns)) and bool((np.abs(table) <= _BEYOND).all())
    if not good:
        raise _blamed(lines, columns, label)
    return table


def _blamed(lines: list[tuple[int, str]], columns: tuple[str, ...], label: str) -> FormatError:
    for number, line in lines:
        words = line.split(",")
        if len(words) != len(columns):
            return FormatError(f"{label}:{number}: {len(words)} columns found, {len(columns)} are expected")
        for word, column in zip(words, columns, strict=True):
            if not _is_number(word.strip().strip('"')):
                found = f"{word.strip()[:40]!r} found" if word.strip() else "nothing found"
                return FormatError(f"{label}:{number}: {column[:60]}: a number is expected, {found}")
    return FormatError(f"{label}:{lines[0][0]}: numbers with commas are expected from this line on")


def _rate(times: Times | None, kept: list[tuple[int, str]], label: str) -> float:
    """Frames a second by a column of times."""
    if times is None or len(times) < 2:
        found = "no column 'time' found" if times is None else "a single frame found"
        raise FormatError(f"{label}: {found}, so the rate of its frames is not known; {ASK}")
    steps = np.diff(times)
    if (steps <= 0).any():
        row = int(np.argmax(steps <= 0)) + 1
        raise FormatError(
            f"{label}:{kept[row + 1][0]}: the time {times[row]:g} s is not after {times[row - 1]:g} s; times have to "
            "increase"
        )
    rate = (len(times) - 1) / float(times[-1] - times[0])
    usual = min((round(rate) * part for part in (1.0, 1000 / 1001)), key=lambda usual: _off(times, usual))
    if _off(times, usual) <= _rounding(times) and abs(usual / rate - 1) < _PRINTED:
        rate = usual
    if _off(times, rate) * rate > _UNEVEN:
        row = int(np.argmax(np.abs(steps * rate - 1))) + 1
        raise FormatError(
            f"{label}:{kept[row + 1][0]}: a step of {steps[row - 1]:g} s found where {1 / rate:g} s are usual; even "
            f"steps are expected; if they are even, {ASK}"
        )
    return rate


def _off(times: Times, rate: float) -> float:
    """Seconds by which a time is off its place at most."""
    return float(np.abs(times - times[0] - np.arange(len(times)) / rate).max()) if rate else np.inf


def _rounding(times: Times) -> float:
    """Seconds by which printing has rounded the times at most: one unit of their last place."""
    for places in range(_PLACES):
        scaled = times * 10.0**places
        if np.abs(scaled - np.rint(scaled)).max() < 1e-4:
            return 1.01 * 10.0**-places
    return 10.0**-_PLACES


def write_joint_table(joints: JointAngles, path: str | Path, degrees: bool = False) -> None:
    """Write a table of joint angles with a column of times; nine digits behind the point.

    Raises
    ------
    FormatError
        If a joint's name cannot be a column's: those of the time and of the root's path.
    """
    head = io.StringIO()
    csv.writer(head, lineterminator="\n").writerow([_TIME[0], *joints.names])
    _columns(head.getvalue().rstrip("\n"), "a joint table")
    angles = np.degrees(joints.angles) if degrees else joints.angles
    table = np.column_stack((joints.times, angles))
    write_atomically(path, head.getvalue().encode() + decimal_rows(table, _PLACES, ","))
