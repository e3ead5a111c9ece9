"""TRC: marker positions as a table of text, as Motion Analysis and OpenSim write it.

Five lines of header: what it is, the names of six or more facts, their values, the labels (``Frame# Time`` and one for
each three columns), ``X1 Y1 Z1 …``. Then, often after an empty line, a row for each frame. Cells are separated by tabs,
and an empty one means that a marker was not seen; or by spaces, and then no cell can be empty. Rows are read one by
one, so that a file which is none is refused before much of it is read.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.formats.conventions import Up
from onbeat.formats.lost_frames import warn_of_lost_frames
from onbeat.formats.marker_axes import Stored, z_up_positions
from onbeat.formats.notes import tell
from onbeat.formats.rates import ASK, RateWarning
from onbeat.motion import Markers
from onbeat.motion.marker_labels import distinct_labels, shared_prefix, without_prefix

_LONGEST_LABELS = 1 << 20
_LONGEST_ROW = 1 << 24
_BATCH = 1 << 17
"""Cells that are made numbers at a time."""
_ROOM = 1 << 22
"""Cells beyond four for each byte of the file, since a row may leave out the empty ones at its end."""
_BLANK_LINES = 100
"""So many in a row are no table."""


@dataclass(frozen=True)
class _Header:
    facts: dict[str, str]
    labels: tuple[str, ...]
    line: int
    """The first line that may hold a frame."""

    def number(self, key: str) -> float | None:
        """A fact as a number; None where it is not told or none."""
        try:
            value = float(self.facts.get(key, ""))
        except ValueError:
            return None
        return value if np.isfinite(value) else None


def read_trc(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Markers:
    """Read a TRC file in metres with Z up; NaN where a marker is not seen.

    The header may promise fewer frames than there are (all are read, which is told) or more (a warning). Its DataRate
    is checked against the column of times.

    Parameters
    ----------
    path : the ``.trc`` file.
    fps, up, unit : the rate, the axis that points up and the unit of length, where the file's are wrong. TRC names no
        axis: it is seen from the markers, and Y where they do not show it.

    Raises
    ------
    FormatError
        If it is no TRC file or a row is not what the header says; the line is named.

    Warns
    -----
    LostFramesWarning
        If there are fewer frames than promised.
    RateWarning
        If times and rate contradict each other; the rate is taken.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            header = _header(file, path)
            table = _table(file, header, path)
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    _check_count(header, len(table), path)
    rate = _rate(header, table[:, 0], path) if fps is None else fps
    positions = table[:, 1:].reshape(len(table), len(header.labels), 3)
    positions[np.isnan(positions).any(-1)] = np.nan
    stored = Stored(header.facts.get("units", ""), "", usual="y")
    return Markers(header.labels, z_up_positions(header.labels, positions, stored, up, unit), rate, path.stem)


def _cells(line: str) -> list[str]:
    """Cells between tabs where there are any, else words."""
    return [cell.strip() for cell in line.rstrip("\r\n").split("\t")] if "\t" in line else line.split()


def _line(file: BinaryIO, longest: int, path: Path, number: int) -> str:
    """The next line, with its end; empty at the end of the file."""
    data = file.readline(longest + 1)
    if len(data) > longest:
        raise FormatError(f"{path}:{number}: a line is longer than {longest} bytes; is this a TRC file?")
    return data.decode("utf-8", errors="replace").removeprefix("\ufeff")


def _header(file: BinaryIO, path: Path) -> _Header:
    first = _line(file, _LONGEST_LABELS, path, 1)
    if not first.lower().startswith("pathfiletype"):
        raise FormatError(f"{path}:1: 'PathFileType' is expected at the start of a TRC file, {first[:40]!r} found")
    keys, values = (_cells(_line(file, _LONGEST_LABELS, path, n)) for n in (2, 3))
    facts = {key.lower(): value for key, value in zip(keys, values, strict=False)}
    if "datarate" not in facts or "units" not in facts:
        raise FormatError(f"{path}:2: 'DataRate', 'Units' and so on are expected, {' '.join(keys)[:60]!r} found")
    if any("," in facts.get(key, "") for key in ("datarate", "camerarate")):
        raise _decimal_comma(path, 3, facts["datarate"])
    labels = _labels(_line(file, _LONGEST_LABELS, path, 4), path)
    columns, line = _axes(file, path)
    labels += [""] * (columns - len(labels))
    prefix = shared_prefix(labels)
    if prefix:
        tell("labels", f"without {prefix!r}", "all labels begin with this subject's name")
    labels = without_prefix(labels, prefix)
    named = distinct_labels(labels)
    if list(named) != labels:
        tell("labels", "numbered", f"{labels.count('')} of {len(labels)} are empty, or some occur more than once")
    return _Header(facts, named, line)


def _labels(line: str, path: Path) -> list[str]:
    """The labels of the fourth line, empty ones between others too."""
    cells = _cells(line)
    if len(cells) < 3 or not cells[0].lower().startswith("frame") or not cells[1].lower().startswith("time"):
        raise FormatError(f"{path}:4: 'Frame#', 'Time' and labels are expected, {line.strip()[:60]!r} found")
    named = [place for place, cell in enumerate(cells) if place > 1 and cell]
    spread = "\t" in line and all(place % 3 == 2 for place in named)
    # Each label stands over the first of its three columns, or they stand side by side.
    labels = cells[2 : max(named, default=1) + 1 : 3] if spread else [cells[place] for place in named]
    if not labels:
        raise FormatError(f"{path}:4: no labels found after 'Frame#' and 'Time'; the file holds no markers")
    return labels


def _axes(file: BinaryIO, path: Path) -> tuple[int, int]:
    """Markers in ``X1 Y1 Z1 …``, more than labels where some have none, and the next line; some leave it out."""
    here = file.tell()
    line = _line(file, _LONGEST_LABELS, path, 5)
    if re.match(r"\s*x1?\b", line, re.IGNORECASE) or not line.strip():
        return len(re.findall(r"(?i)\bx\d*\b", line)), 6
    file.seek(here)
    return 0, 5


def _table(file: BinaryIO, header: _Header, path: Path) -> Array:
    """(F, 1 + 3M) times and coordinates, NaN where a cell is empty."""
    parts: list[Array] = []
    cells: list[str] = []
    lines: list[int] = []
    width = 1 + 3 * len(header.labels)
    for number, row in _rows(file, header, path):
        cells += row[1:]
        lines.append(number)
        if len(cells) >= _BATCH:
            parts.append(_numbers(cells, width, lines, path))
            cells, lines = [], []
    if cells:
        parts.append(_numbers(cells, width, lines, path))
    if not parts:
        raise FormatError(f"{path}: no frame found after the header of {header.line - 1} lines; is it cut off?")
    return np.concatenate(parts)


def _rows(file: BinaryIO, header: _Header, path: Path) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each frame, as many as there are columns."""
    width, blank, most = 2 + 3 * len(header.labels), 0, 0
    longest = min(256 * width + (1 << 16), _LONGEST_ROW)
    room = _ROOM + 4 * os.fstat(file.fileno()).st_size
    number, line = header.line, _line(file, longest, path, header.line)
    while line:
        if line.strip():
            cells = _cells(line)
            row = _row(cells, width, line, f"{path}:{number}")
            if row is not None:
                room -= width
                yield number, row
            if room < 0:
                raise FormatError(
                    f"{path}:{number}: rows of {width} cells are expected, almost all are empty up to here"
                )
            most, blank = max(most, sum(1 for cell in cells[width:] if cell)), 0
        blank += 1
        if blank > _BLANK_LINES:
            raise FormatError(f"{path}:{number}: {_BLANK_LINES} empty lines found where rows of frames are expected")
        number += 1
        line = _line(file, longest, path, number)
    if most:
        tell("points", f"{len(header.labels)} markers", f"in columns without a label up to {most // 3} more were seen")


def _row(cells: list[str], width: int, line: str, where: str) -> list[str] | None:
    """The first ``width`` cells, empty ones at the end filled in; None for a last line that is not whole.

    Columns without a label hold scraps of trajectories that nobody named, and are left out.
    """
    if not _is_number(cells[0]):
        raise FormatError(f"{where}: a frame number is expected, {cells[0][:40]!r} found")
    if "\t" in line and len(cells) > 1 and (len(cells) >= width or line.endswith("\n")):
        return [*cells[:width], *[""] * (width - len(cells))]
    if len(cells) == width:
        return cells
    if not line.endswith("\n"):
        return None
    raise FormatError(f"{where}: {len(cells)} numbers found, {width} are expected for {(width - 2) // 3} markers")


def _numbers(cells: list[str], width: int, lines: list[int], path: Path) -> Array:
    """(rows, width) values of the rows that stand in these lines."""
    try:
        return np.array([cell or "nan" for cell in cells], np.float64).reshape(-1, width)
    except ValueError:
        bad = next(n for n, cell in enumerate(cells) if cell and not _is_number(cell))
    line = lines[bad // width]
    if re.fullmatch(r"[+-]?\d+,\d+", cells[bad]):
        raise _decimal_comma(path, line, cells[bad])
    raise FormatError(f"{path}:{line}: a number is expected in column {bad % width + 2}, {cells[bad][:40]!r} found")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _decimal_comma(path: Path, line: int, found: str) -> FormatError:
    return FormatError(f"{path}:{line}: {found[:40]!r} has a decimal comma; export the file with decimal points")


def _check_count(header: _Header, rows: int, path: Path) -> None:
    """Frames and markers against what the header promises."""
    promised, markers = header.number("numframes"), header.number("nummarkers")
    if promised is not None and rows < promised < 2**63:
        warn_of_lost_frames(path, int(promised), rows)
    elif promised != rows:
        tell("frames", rows, f"all that are there; NumFrames says {header.facts.get('numframes', 'nothing')[:20]}")
    if markers != len(header.labels):
        found = header.facts.get("nummarkers", "nothing")[:20]
        tell("markers", len(header.labels), f"as many as there are labels; NumMarkers says {found}")


def _rate(header: _Header, times: Array, path: Path) -> float:
    """Frames a second: DataRate, or what the times say where there is none."""
    said = header.number("datarate")
    shown = _shown_rate(times)
    if said is None or not 0.1 <= said <= 1e5:
        if not shown:
            raise FormatError(
                f"{path}:3: a DataRate in frames a second is expected, {header.facts['datarate'][:40]!r} found, and "
                f"the times do not tell; {ASK}"
            )
        tell("fps", f"{shown:g}", "by the column of times; the file has no DataRate")
        return shown
    if shown and abs(shown - said) > 0.02 * said:
        tell("fps", f"{said:g}", f"DataRate says so, though the times are {shown:.4g} a second")
        warnings.warn(
            f"{path}: DataRate says {said:g} frames a second, the column of times {shown:.4g}; {said:g} is taken, "
            f"{ASK}",
            RateWarning,
            stacklevel=3,
        )
    return said


def _shown_rate(times: Array) -> float:
    """Frames a second by the times of the first and the last frame; 0 where they do not tell."""
    if len(times) < 2 or not np.isfinite(times).all() or not np.abs(times).max() < 1e9:
        return 0.0
    span = float(times[-1] - times[0])
    return round((len(times) - 1) / span, 6) if span > 0 and 0.1 <= (len(times) - 1) / span <= 1e5 else 0.0
