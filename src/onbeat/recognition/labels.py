"""Label files: which stretch of which motion file is which task, by whom. CSV with a first line of names.

::

    file,from,to,task,person,cycle
    dances/aiko.bvh,0.58,1.73,bow,Aiko,0

``file`` is seen from the label file's folder, ``from`` and ``to`` are seconds; left empty, or both columns left out,
they are the file's start and end. Task, person and cycle may be left empty or out, too: not known, and 0.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onbeat.errors import FormatError
from onbeat.formats.text import small_text

_NEEDED, _BOTH = ("file",), ("from", "to")
_COLUMNS = (*_NEEDED, *_BOTH, "task", "person", "cycle")
_LARGEST = 1 << 26  # bytes: a million lines


class Label(NamedTuple):
    """What is said of a stretch of a motion file.

    Parameters
    ----------
    file : the motion file.
    start, end : seconds; infinity for the file's end.
    task, person : "" where they are not known.
    cycle : which repetition.
    line : of the label file, for messages; 0 for none.
    """

    file: Path
    start: float
    end: float
    task: str = ""
    person: str = ""
    cycle: int = 0
    line: int = 0


def read_labels(path: str | Path) -> list[Label]:
    """The labels of a CSV file, in its order.

    Raises
    ------
    FormatError
        If the file cannot be read, is too large, lacks a column, holds no label, or a line has too few or too many
        values or one that is not what its column says; the line is named.
    """
    path = Path(path)
    text = small_text(path, _LARGEST, f"CSV with the columns {', '.join(_COLUMNS)}")
    rows = csv.reader(text.split("\n"))
    try:
        names = [name.strip().lower() for name in next(rows, [])]
        needed = (*_NEEDED, *(_BOTH if any(name in names for name in _BOTH) else ()))
        missing = [name for name in needed if name not in names]
        if missing:
            raise FormatError(
                f"{path}:1: no column {', '.join(missing)}; the first line names the columns: {','.join(_COLUMNS)}"
            )
        found: list[Label] = []
        for row in rows:
            if any(cell.strip() for cell in row):
                found.append(_label(path, rows.line_num, names, row))
    except csv.Error as error:
        raise FormatError(f"{path}:{rows.line_num}: no CSV: {error}") from None
    if not found:
        raise FormatError(f"{path}: no label found; one line a segment is expected after the first")
    return found


def _label(path: Path, line: int, names: list[str], row: list[str]) -> Label:
    if len(row) != len(names):
        raise FormatError(f"{path}:{line}: {len(row)} values found, {len(names)} expected; quote values with commas")
    cell = {name: value.strip() for name, value in zip(names, row, strict=True)}
    if not cell["file"] or "\0" in cell["file"]:
        raise FormatError(f"{path}:{line}: no file is named; write the motion file's path")
    start = _number(path, line, cell, "from") if cell.get("from") else 0.0
    end = _number(path, line, cell, "to") if cell.get("to") else np.inf
    if not start < end:
        raise FormatError(f"{path}:{line}: from {start:g} to {end:g} s; the end has to be after the start")
    cycle = _number(path, line, {"cycle": cell.get("cycle") or "0"}, "cycle")
    if cycle != int(cycle) or not 0 <= cycle < 1 << 31:
        raise FormatError(f"{path}:{line}: cycle {cell['cycle']!r} found; a whole number from 0 is expected")
    return Label(path.parent / cell["file"], start, end, cell.get("task", ""), cell.get("person", ""), int(cycle), line)


def _number(path: Path, line: int, cell: Mapping[str, str], name: str) -> float:
    try:
        value = float(cell[name])
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise FormatError(f"{path}:{line}: {name} is {cell[name][:40]!r}; a number is expected")
    return value
