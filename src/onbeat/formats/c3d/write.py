"""Writing C3D: Intel floats, Z up in millimetres, with the parameters that readers ask for.

A marker that is not seen is ``0, 0, 0`` with the residual −1. Labels beyond 255 go to ``LABELS2``, ``LABELS3``, …;
beyond 65,535 frames the counters stay full and ``TRIAL:ACTUAL_END_FIELD`` holds the number in two words, as Vicon does.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from onbeat._shapes import Positions
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.c3d.layout import BLOCK, FULL
from onbeat.formats.conventions import Convention, Up, up_vectors
from onbeat.motion import Markers

_LONGEST_LABEL = 127
"""With 255 of them a parameter's record is just short enough for its distance to the next, a signed word."""
_MOST_LABELS = 255
_SCREEN = {
    "x": ("+Y", "+X"),
    "y": ("+X", "+Y"),
    "z": ("+X", "+Z"),
    "-x": ("+Y", "-X"),
    "-y": ("+X", "-Y"),
    "-z": ("+X", "-Z"),
}
"""The axes along a screen and up it."""
_NEAR_ZERO = 1e-30
"""Written for a coordinate of a marker that is seen exactly at the origin, which many take for one that is not."""


def write_c3d(markers: Markers, path: str | Path, convention: Convention | None = None) -> None:
    """Write markers as C3D, by default with Z up in millimetres.

    Raises
    ------
    FormatError
        If C3D cannot hold them: labels of more than 127 bytes, more than 65,535 markers, labels that fill more than
        255 blocks, or coordinates too large for 32-bit floats.
    """
    write_atomically(path, c3d_bytes(markers, convention or Convention("z", "mm")))


def c3d_bytes(markers: Markers, convention: Convention) -> bytes:
    """The bytes of a C3D file of the markers.

    Examples
    --------
    >>> seen = Markers(("LASI",), np.ones((2, 1, 3)), fps=100)
    >>> len(c3d_bytes(seen, Convention("z", "mm"))) // 512
    3
    """
    if len(markers.names) > FULL or len(markers) >= 2**31:
        raise FormatError(f"{len(markers.names)} markers are more than the {FULL} that C3D can hold")
    points = _points(markers, convention)
    scale = -max(float(np.abs(points[..., :3]).max()) / 32000, 1e-6)
    records = list(_records(markers, convention, scale))
    blocks = -(-(4 + sum(map(len, records)) + _DATA_START_BYTES + 1) // BLOCK)
    if blocks > 255:
        raise FormatError(f"the labels of {len(markers.names)} markers fill {blocks} blocks, C3D has 255; shorten them")
    start = blocks + 2
    section = bytes((1, 0x50, blocks, 84)) + b"".join(records) + _parameter(1, "DATA_START", _words(start))
    assert len(section) < blocks * BLOCK
    head = _header(markers, scale, start) + section.ljust(blocks * BLOCK, b"\0")
    data = points.tobytes()
    return head + data + bytes(-len(data) % BLOCK)


def _points(markers: Markers, convention: Convention) -> np.ndarray:
    """(F, M, 4) floats: coordinates in the file's unit and the residual."""
    seen = markers.seen
    found: Positions = up_vectors(markers.positions, convention.up) / convention.metres
    if not np.abs(np.where(seen[..., None], found, 0.0)).max() < np.finfo(np.float32).max:
        raise FormatError("a marker is too far away for the 32-bit floats of C3D; is the unit right?")
    points = np.zeros((*seen.shape, 4), "<f4")
    points[..., :3] = np.where(seen[..., None], found, 0.0)
    points[..., 0] = np.where(seen & ~points[..., :3].any(-1), _NEAR_ZERO, points[..., 0])
    points[..., 3] = np.where(seen, 0.0, -1.0)
    return points


def _words(*values: int) -> bytes:
    return np.array(values, "<u2").tobytes()


def _float(value: float) -> bytes:
    return np.array(value, "<f4").tobytes()


def _header(markers: Markers, scale: float, start: int) -> bytes:
    last = min(len(markers), FULL)
    head = b"\2\x50" + _words(len(markers.names), 0, 1, last, 0) + _float(scale) + _words(start, 1)
    return (head + _float(markers.fps)).ljust(BLOCK, b"\0")


def _group(number: int, name: str) -> bytes:
    return bytes((len(name), 256 - number)) + name.encode() + _words(3) + b"\0"


def _parameter(group: int, name: str, data: bytes, kind: int = 2, dimensions: tuple[int, ...] = ()) -> bytes:
    rest = bytes((kind % 256, len(dimensions), *dimensions)) + data + b"\0"
    return bytes((len(name), group)) + name.encode() + _words(2 + len(rest)) + rest


_DATA_START_BYTES = len(_parameter(1, "DATA_START", _words(0)))


def _text(group: int, name: str, *values: str) -> bytes:
    """A parameter of one string, or of several of one width."""
    coded = [value.encode() for value in values]
    width = max(map(len, coded), default=0)
    dimensions = (width,) if len(coded) == 1 else (width, len(coded))
    return _parameter(group, name, b"".join(each.ljust(width) for each in coded), -1, dimensions)


def _labels(names: tuple[str, ...]) -> Iterator[bytes]:
    """``LABELS`` and its continuations, and descriptions, which some readers insist on."""
    for name in names:
        if len(name.encode()) > _LONGEST_LABEL:
            raise FormatError(f"the label {name[:40]!r}… is longer than the {_LONGEST_LABEL} bytes of C3D; rename it")
    for first in range(0, len(names), _MOST_LABELS):
        some, number = names[first : first + _MOST_LABELS], first // _MOST_LABELS + 1
        suffix = str(number) if number > 1 else ""
        width = max(len(name.encode()) for name in some) or 1
        data = b"".join(name.encode().ljust(width) for name in some)
        yield _parameter(1, f"LABELS{suffix}", data, -1, (width, len(some)))
        yield _parameter(1, f"DESCRIPTIONS{suffix}", b" " * len(some), -1, (1, len(some)))


def _records(markers: Markers, convention: Convention, scale: float) -> Iterator[bytes]:
    """The groups and their parameters, but for ``POINT:DATA_START``, which is known last."""
    frames, up = len(markers), _SCREEN[convention.up]
    yield _group(1, "POINT")
    yield _parameter(1, "USED", _words(len(markers.names)))
    yield _parameter(1, "FRAMES", _words(min(frames, FULL)))
    yield _parameter(1, "SCALE", _float(scale), 4)
    yield _parameter(1, "RATE", _float(markers.fps), 4)
    yield _text(1, "UNITS", _unit(convention.unit, convention.up))
    yield _text(1, "X_SCREEN", up[0])
    yield _text(1, "Y_SCREEN", up[1])
    yield from _labels(markers.names)
    yield _group(2, "ANALOG")
    yield _parameter(2, "USED", _words(0))
    yield _parameter(2, "RATE", _float(markers.fps), 4)
    yield _parameter(2, "GEN_SCALE", _float(1.0), 4)
    yield _group(3, "FORCE_PLATFORM")
    yield _parameter(3, "USED", _words(0))
    yield _group(4, "TRIAL")
    yield _parameter(4, "ACTUAL_START_FIELD", _words(1, 0), 2, (2,))
    yield _parameter(4, "ACTUAL_END_FIELD", _words(frames % 65536, frames // 65536), 2, (2,))
    yield _group(5, "MANUFACTURER")
    yield _text(5, "SOFTWARE", "onbeat")


def _unit(unit: str, up: Up) -> str:
    if unit not in ("mm", "cm", "m"):
        raise FormatError(f"C3D in {unit!r}, {up} up, would not be read right elsewhere; mm, cm or m is expected")
    return unit
