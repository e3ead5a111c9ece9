"""Robot motions as Unitree, BeyondMimic and mjlab exchange them: a CSV with one line a frame.

36 columns and no header: the root's position x y z in metres (Z up), its quaternion qx qy qz qw, and the 29 angles of
the Unitree G1 in radians in its own order (:data:`onbeat.motion.unitree_g1.G1`). 30 columns are the G1 with 23 joints.
Where there is a header, columns are taken by their names, in any order, and others are passed over.

The file does not store its rate: 30 frames a second are assumed with a warning, as BeyondMimic does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, Up, z_up_vectors
from onbeat.formats.notes import tell
from onbeat.formats.rates import assumed
from onbeat.motion import Motion
from onbeat.motion import rotations as rot
from onbeat.motion.unitree_g1 import G1, G1_23, LARGEST, g1_angles, g1_motion, unit_quaternions

ASSUMED_FPS = 30.0
_ROOT = ("x", "y", "z", "qx", "qy", "qz", "qw")
_WIDTHS = (len(_ROOT) + len(G1.names), len(_ROOT) + len(G1_23))
_LONGEST_LINE = 1 << 14
_BLOCK = 1 << 22
"""Bytes read at once; as many without a number are in no motion."""


class _Layout(NamedTuple):
    """What the first line says: how many columns there are, which of them to take, and whether it was a header."""

    width: int
    columns: list[int]
    header: bool


def read_robot_csv(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read a robot's motion, in metres with Z up.

    Parameters
    ----------
    path : the ``.csv`` file.
    fps : the rate of its frames; without it 30 is assumed, with a warning.
    up, unit : the axis of the world that points up and the unit of the root's path, where they are not Z and metres.

    Raises
    ------
    FormatError
        If it is not such a file; line and column, what was found and what is expected are named.
    """
    path = Path(path)
    with _opened(path) as file:
        layout = _layout(_first_line(file, str(path)), str(path))
        file.seek(0)
        blocks = list(_tables(file, layout, str(path)))
    if not blocks:
        raise FormatError(f"{path}: no frame found; a line of {layout.width} numbers each is expected")
    table = np.concatenate(blocks)[:, layout.columns]
    rate = fps or assumed(ASSUMED_FPS, "robot CSV files store", "as BeyondMimic does")
    return _motion(table, rate, up or "z", Convention("z", unit or "m").metres, path)


def _motion(table: Array, fps: float, up: Up, metres: float, path: Path) -> Motion:
    """The motion of a table with the root's columns first; the world is turned, not the robot."""
    if table.shape[1] == _WIDTHS[1]:
        tell("joints", "23", "30 columns are a G1 without waist roll and pitch and wrist pitch and yaw, held at 0")
    turn = rot.from_matrix(np.ascontiguousarray(z_up_vectors(np.eye(3), up).T))
    root = table[:, [6, 3, 4, 5]]
    root = root if up == "z" else rot.multiply(turn, root)
    return g1_motion(z_up_vectors(table[:, :3], up) * metres, root, table[:, 7:], fps, path.stem, str(path))


def is_robot_csv(path: Path) -> bool:
    """Whether the first line of a file is one of a robot's motion: a header of its joints, or a frame of it."""
    try:
        with _opened(path) as file:
            line = _first_line(file, str(path))
        layout = _layout(line, str(path))
        if not layout.header:
            _numbers([(1, line)], layout, str(path))
    except FormatError:
        return False
    return True


def _opened(path: Path) -> BinaryIO:
    try:
        return path.open("rb")
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None


def _text(data: bytes) -> str:
    return data.decode("utf-8-sig", errors="replace").replace("\r\n", "\n").replace("\r", "\n")


def _first_line(file: BinaryIO, label: str) -> str:
    """The first line that is not blank, of the first kilobytes."""
    head = file.read(_LONGEST_LINE)
    line, end, _ = _text(head).lstrip("\n \t").partition("\n")
    if not line or (len(head) == _LONGEST_LINE and not end):
        found = f"{line[:20]!r}… without an end of line" if line else "white space" if head else "an empty file"
        raise FormatError(f"{label}: {found} found; lines of {_WIDTHS[0]} numbers with commas are expected")
    return line


def _layout(line: str, label: str) -> _Layout:
    """Columns by their count, or by their names where most words are no numbers."""
    words = [word.strip().strip("\"'") for word in line.split(",")]
    if sum(_is_number(word) for word in words) <= len(words) / 2:
        return _Layout(len(words), _named(words, label), header=True)
    if len(words) not in _WIDTHS:
        raise FormatError(
            f"{label}: {len(words)} columns found; a robot's motion has x y z qx qy qz qw and the angles of the "
            f"{G1.name}: {_WIDTHS[0]} columns, or {_WIDTHS[1]} with 23 joints"
        )
    return _Layout(len(words), list(range(len(words))), header=False)


def _named(words: Sequence[str], label: str) -> list[int]:
    """Where each root column and joint is in a header; ``root_x``, ``base_pos_x`` and the like are x too."""
    plain = [_plain(word) for word in words]
    twice = sorted({name for name in plain if name in (*_ROOT, *G1.names) and plain.count(name) > 1})
    if twice:
        raise FormatError(f"{label}: more than one column is named {', '.join(twice)}")
    joints = G1.names if set(G1.names) <= set(plain) else G1_23
    missing = [name for name in (*_ROOT, *joints) if name not in plain]
    if missing:
        separator = next((name for name, sign in (("semicolons", ";"), ("tabs", "\t")) if sign in "".join(words)), "")
        shown = f"the columns are separated by {separator}" if separator else f"{','.join(words)[:40]!r} found"
        raise FormatError(
            f"{label}: {shown}; numbers with commas are expected, or a header that names {', '.join(missing[:3])}"
            + (f" and {len(missing) - 3} more" if len(missing) > 3 else "")
        )
    wanted = [plain.index(name) for name in (*_ROOT, *joints)]
    if spare := [word for n, word in enumerate(words) if n not in wanted]:
        tell("columns", "passed over", ", ".join(spare)[:200])
    return wanted


def _plain(word: str) -> str:
    """A header's name as ours."""
    name = word.strip().lower().replace(" ", "_").removesuffix("_dof")
    for joint in (name, f"{name}_joint"):
        if joint in G1.names:
            return joint
    for part in ("root", "base", "pelvis"):
        name = name.removeprefix(f"{part}_")
    axis = name.rpartition("_")[2]
    if name.startswith(("pos_", "position_", "trans_")) or name == axis:
        return axis
    return f"q{axis.removeprefix('q')}" if name.startswith(("quat_", "rot_", "q_", "orientation_")) else name


def _is_number(word: str) -> bool:
    try:
        value = float(word)
    except ValueError:
        return False
    return abs(value) < LARGEST and "_" not in word


def _tables(file: BinaryIO, layout: _Layout, label: str) -> Iterator[Array]:
    """The numbers of the file, some thousand frames at a time."""
    header = layout.header
    for number, lines in _lines(file, label):
        kept = [(n, line) for n, line in enumerate(lines, number) if line and not line.isspace()]
        if kept and header:
            del kept[0]
            header = False
        if kept:
            yield _numbers(kept, layout, label)


def _lines(file: BinaryIO, label: str) -> Iterator[tuple[int, list[str]]]:
    """Whole lines, about :data:`_BLOCK` bytes at a time, and the number of their first."""
    rest, number = b"", 1
    while data := file.read(_BLOCK):
        data = rest + data
        cut = max(data.rfind(b"\n"), data.rfind(b"\r", 0, len(data) - 1)) + 1
        rest = data[cut:]
        if len(rest) > _LONGEST_LINE:
            raise FormatError(f"{label}: a line of over {_LONGEST_LINE} bytes found; numbers with commas are expected")
        if len(data) >= _BLOCK and data.isspace():
            raise FormatError(f"{label}:{number}: {_BLOCK >> 20} MB of white space found; frames are expected")
        *lines, _ = _text(data[:cut]).split("\n")
        yield number, lines
        number += len(lines)
    yield number, _text(rest).split("\n")


def _numbers(lines: list[tuple[int, str]], layout: _Layout, label: str) -> Array:
    """The numbers of some lines (rows, columns); what is wrong with them is named by line and column."""
    try:
        table = np.loadtxt([line for _, line in lines], np.float64, delimiter=",", comments=None, ndmin=2)
    except ValueError:
        table = np.zeros((0, 0))
    with np.errstate(invalid="ignore"):
        good = table.shape == (len(lines), layout.width) and bool((np.abs(table) < LARGEST).all())
    if not good:
        _blame(lines, layout, label)
    q = table[:, [layout.columns[n] for n in (6, 3, 4, 5)]]
    bad = np.abs(np.linalg.norm(q, axis=1) - 1) >= 0.01
    if bad.any():
        unit_quaternions(q[bad][:1], f"{label}:{lines[int(np.argmax(bad))][0]}")
    return table


def _blame(lines: list[tuple[int, str]], layout: _Layout, label: str) -> None:
    for number, line in lines:
        words = line.split(",")
        if len(words) != layout.width:
            raise FormatError(f"{label}:{number}: {len(words)} columns found, {layout.width} are expected")
        for column, word in enumerate(words, 1):
            if not _is_number(word):
                raise FormatError(
                    f"{label}:{number}: column {column} holds {word.strip()[:40]!r}; a number of metres or radians "
                    "is expected"
                )
    raise FormatError(f"{label}:{lines[0][0]}: numbers with commas are expected from this line on")


def write_robot_csv(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a motion of the Unitree G1: 36 columns without a header, always in metres with Z up.

    Six digits behind the point where they hold the motion, as in a file that had six, else nine.

    Raises
    ------
    FormatError
        If the motion is of another body: it has to be retargeted to the robot first.
    """
    if convention is not None and convention != Convention("z", "m"):
        raise FormatError("a robot's .csv is always in metres with Z up; leave the unit and the axis out")
    angles = g1_angles(motion, "a robot's .csv")
    table = np.column_stack((motion.root_positions, motion.rotations[:, 0, [1, 2, 3, 0]], angles))
    digits = 6 if np.abs(table - table.round(6)).max() < 1e-11 else 9
    line = ",".join([f"%.{digits}f"] * table.shape[1]) + "\n"
    # Adding zero makes −0 a 0.
    values = (table.round(digits) + 0.0).ravel().tolist()
    write_atomically(path, (line * len(table) % tuple(values)).encode())
