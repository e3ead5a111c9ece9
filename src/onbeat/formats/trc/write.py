"""Writing TRC: tabs, Y up in millimetres, an empty cell where a marker is not seen; OpenSim reads it so."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onbeat._shapes import Positions
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, up_vectors
from onbeat.motion import Markers
from onbeat.motion.marker_labels import distinct_labels

_DECIMALS = {"mm": 5, "cm": 6, "m": 8}
"""Digits after the point, to 10 nm."""
_KEYS = ("DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate", "OrigDataStartFrame")


def write_trc(markers: Markers, path: str | Path, convention: Convention | None = None) -> None:
    """Write markers as TRC, by default with Y up in millimetres; tabs and line ends in labels become spaces.

    Raises
    ------
    FormatError
        If the unit is none of mm, cm and m.
    """
    path = Path(path)
    write_atomically(path, trc_text(markers, convention or Convention("y", "mm"), path.name).encode())


def trc_text(markers: Markers, convention: Convention, name: str = "markers.trc") -> str:
    r"""The text of a TRC file called ``name``.

    Examples
    --------
    >>> seen = Markers(("LASI",), np.array([[[0, 0, 1.0]], [[np.nan] * 3]]), fps=100)
    >>> trc_text(seen, Convention("y", "mm")).splitlines()[-2:]
    ['1\t0.000000\t0.00000\t1000.00000\t0.00000', '2\t0.010000\t\t\t']
    """
    if convention.unit not in _DECIMALS:
        raise FormatError(f"TRC in {convention.unit!r} would not be read right elsewhere; mm, cm or m is expected")
    frames, count, rate = len(markers), len(markers.names), _shortest(markers.fps)
    values = (rate, rate, str(frames), str(count), convention.unit, rate, "1", str(frames))
    labels = distinct_labels([_one_cell(label) for label in markers.names])
    axes = [f"{axis}{number}" for number in range(1, count + 1) for axis in "XYZ"]
    head = (
        ("PathFileType", "4", "(X/Y/Z)", _one_cell(name)),
        (*_KEYS, "OrigNumFrames"),
        values,
        ("Frame#", "Time", "\t\t\t".join(labels) + "\t\t"),
        ("", "", *axes),
        ("",),
    )
    return "".join("\t".join(cells) + "\n" for cells in (*head, *_rows(markers, convention)))


def _one_cell(text: str) -> str:
    """Without tabs, line ends and whatever else is not printed."""
    return "".join(c if c.isprintable() else " " for c in text).strip()


def _shortest(fps: float) -> str:
    """With two decimals, as is usual, unless that would lose some."""
    return f"{fps:.2f}" if float(f"{fps:.2f}") == fps else repr(fps)


def _rows(markers: Markers, convention: Convention) -> list[tuple[str, ...]]:
    positions: Positions = up_vectors(markers.positions, convention.up) / convention.metres
    unseen = ~np.repeat(markers.seen, 3, axis=1)
    form = f"%.{_DECIMALS[convention.unit]}f"
    # Minus zero is written as zero.
    rows = np.where(unseen, np.nan, positions.reshape(len(markers), -1) + 0.0)
    cells = [["" if text == "nan" else text for text in (form % value for value in row)] for row in rows.tolist()]
    return [(str(n), f"{time:.6f}", *row) for n, (time, row) in enumerate(zip(markers.times, cells, strict=True), 1)]
