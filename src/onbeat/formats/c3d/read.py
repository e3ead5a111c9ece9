"""C3D: labelled points of optical motion capture, as https://www.c3d.org describes it.

Blocks of 512 bytes: a header, a section of parameters (:mod:`onbeat.formats.c3d.parameters`), and frames of points and
analog samples (:mod:`onbeat.formats.c3d.layout`), as integers to be scaled or as floats, by Intel, DEC or MIPS
processors (:mod:`onbeat.formats.c3d.numbers`). A point is ``x, y, z`` and a word whose sign says that it was not seen.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.formats.c3d.labels import marker_labels
from onbeat.formats.c3d.layout import BLOCK, Layout, find_layout
from onbeat.formats.c3d.numbers import NUMBERS, Numbers
from onbeat.formats.c3d.parameters import Parameters, parse_parameters
from onbeat.formats.conventions import Up
from onbeat.formats.lost_frames import warn_of_lost_frames
from onbeat.formats.marker_axes import Stored, z_up_positions
from onbeat.formats.notes import tell
from onbeat.motion import Markers

_NEVER_NEAR = 0.05
"""A marker whose other positions are all farther from the origin than this part of what is usual was never there."""


def read_c3d(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Markers:
    """Read the markers of a C3D file in metres with Z up; NaN where one is not seen.

    Parameters
    ----------
    path : the ``.c3d`` file, of any byte order, with points as integers or floats.
    fps, up, unit : the rate, the axis that points up and the unit of length, where the file's are wrong.

    Raises
    ------
    FormatError
        If it is no C3D file, holds no markers, or is too damaged to be read without guessing.

    Warns
    -----
    LostFramesWarning
        If the file holds fewer frames than it promises.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            header, parameters = _head(file, size, path)
            layout = find_layout(header, parameters, size, path)
            frames = _frames_there(layout, size, path)
            kept, names = marker_labels(parameters, layout.points)
            if not names:
                raise FormatError(f"{path}: its {layout.points} points are angles, forces or the like, no markers")
            file.seek(layout.start)
            raw = _positions(file.read(frames * layout.frame_bytes), layout, parameters.numbers, kept)
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    rate = _rate(header, parameters, path) if fps is None else fps
    stored = Stored(parameters.text("POINT:UNITS"), _screen_up(parameters), usual="z")
    return Markers(names, z_up_positions(names, raw, stored, up, unit), rate, path.stem)


def _head(file: BinaryIO, size: int, path: Path) -> tuple[bytes, Parameters]:
    """The header and the parameters."""
    file.seek(0)
    header = file.read(BLOCK)
    if len(header) < 2 or header[1] != 0x50 or header[0] < 1:
        raise FormatError(f"{path} is no C3D file: the bytes {header[:2].hex(' ') or '(none)'} found, 02 50 expected")
    if len(header) < BLOCK:
        raise FormatError(f"{path} ends inside its header of {BLOCK} bytes, at {size}; copy it again")
    start = (header[0] - 1) * BLOCK
    file.seek(start)
    section = file.read(256 * BLOCK)
    if len(section) < 4 or section[3] not in NUMBERS:
        found = f"{section[3]} found" if len(section) > 3 else f"the file ends at {size}"
        raise FormatError(
            f"{path}: a processor of 84 (Intel), 85 (DEC) or 86 (MIPS) is expected at byte {start + 3}, {found}; "
            "is this a C3D file?"
        )
    parameters = parse_parameters(section[: _length(header, section)], NUMBERS[section[3]])
    if parameters.damaged:
        tell("parameters", "left out", f"damaged: {', '.join(parameters.damaged[:8])}")
    return header, parameters


def _length(header: bytes, section: bytes) -> int:
    """Bytes of the parameter section: to the points or as it says itself, whichever is more."""
    data_start = int(NUMBERS[section[3]].words(header[16:18])[0])
    return max(section[2], min(data_start - header[0], 255)) * BLOCK or len(section)


def _frames_there(layout: Layout, size: int, path: Path) -> int:
    whole = layout.whole(size)
    if whole == 0:
        raise FormatError(
            f"{path} is cut off: {layout.frames} frames of {layout.frame_bytes} bytes are promised from byte "
            f"{layout.start} on, the file ends at {size}; copy it again"
        )
    if whole < layout.frames:
        warn_of_lost_frames(path, layout.frames, whole)
    return min(whole, layout.frames)


def _positions(data: bytes, layout: Layout, numbers: Numbers, kept: list[int]) -> Array:
    """(F, M, 3) in the file's unit, NaN where a marker was not seen."""
    kind = numbers.float_bits if layout.is_float else numbers.word
    frames = len(data) // layout.frame_bytes
    shape, strides = (frames, layout.points, 4), (layout.frame_bytes, 4 * kind.itemsize, kind.itemsize)
    stored: NDArray[Any] = np.ndarray(shape, kind, data, strides=strides)
    if len(kept) < layout.points:
        stored = stored[:, kept]
    points = numbers.decoded(stored) if layout.is_float else stored
    with np.errstate(invalid="ignore"):  # a NaN may be a signalling one
        found = points[..., :3].astype(np.float64)
    if not layout.is_float:
        found *= layout.scale
    x, y, z = np.moveaxis(found, -1, 0)
    found[~(points[..., 3] >= 0) | np.isnan(x) | np.isnan(y) | np.isnan(z)] = np.nan
    return _without_origins(found)


def _without_origins(found: Array) -> Array:
    """Zeros by which some programs mean that a marker was not seen: exactly at the origin, and nowhere else near it."""
    origin = (found[..., 0] == 0) & (found[..., 1] == 0) & (found[..., 2] == 0)
    if not origin.any():
        return found
    reach = np.abs(found).max(-1)
    elsewhere = np.where(reach > 0, reach, np.inf).min(0)
    usual = np.median(elsewhere[np.isfinite(elsewhere)]) if np.isfinite(elsewhere).any() else 0.0
    unseen = origin & (elsewhere > _NEVER_NEAR * usual) & bool(usual)
    if unseen.any():
        found[unseen] = np.nan
        tell("gaps", f"{int(unseen.sum())} zeros", "a marker exactly at 0, 0, 0 and else nowhere near was not seen")
    return found


def _rate(header: bytes, parameters: Parameters, path: Path) -> float:
    """Frames a second, as the shortest decimal that is the file's 32-bit float."""
    said = [parameters.number("POINT:RATE"), float(parameters.numbers.floats(header[20:24])[0])]
    good = [float(str(np.float32(value))) for value in said if value is not None and 0.1 <= value <= 1e5]
    if not good:
        raise FormatError(f"{path}: a rate in frames a second is expected, {said[0]} found; say it with --source-fps")
    if len(good) == 2 and abs(good[0] - good[1]) > 1e-3 * good[0]:
        tell("fps", good[0], f"POINT:RATE goes before the header, which says {good[1]:g}")
    return good[0]


def _screen_up(parameters: Parameters) -> str:
    """The axis that points up a screen, as ``+z``; nothing where the file does not say."""
    said = re.fullmatch(r"([+-]?)([xyz])", parameters.text("POINT:Y_SCREEN").lower())
    return f"{said[1] or '+'}{said[2]}" if said else ""
