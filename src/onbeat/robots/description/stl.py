"""The vertices of STL files, binary or text."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from onbeat._shapes import Positions
from onbeat.errors import BodyError

LARGEST = 64 << 20
"""Bytes."""
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
_HEAD = 84


def read_stl(path: Path) -> Positions:
    """The corners (N, 3) of all triangles of a mesh, in the file's own unit.

    Raises
    ------
    BodyError
        If it cannot be read, is over 64 MB, or holds no triangle.
    """
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except (OSError, ValueError) as error:
        raise BodyError(f"cannot read the mesh {path}: {getattr(error, 'strerror', None) or error}") from None
    if len(data) > LARGEST:
        raise BodyError(f"the mesh {path} has more than {LARGEST} bytes; simplify it")
    count = int.from_bytes(data[80:84], "little") if len(data) >= _HEAD else 0
    binary = len(data) == _HEAD + count * _TRIANGLE.itemsize
    found = np.frombuffer(data, _TRIANGLE, count, _HEAD)["corners"].reshape(-1, 3) if binary else _text(data)
    points = found.astype(np.float64)
    with np.errstate(invalid="ignore"):
        if len(points) == 0 or not (np.abs(points) < 1e6).all():
            raise BodyError(f"the mesh {path} is no STL with triangles")
    return points


def _text(data: bytes) -> Positions:
    lines = (line.split() for line in data.decode("ascii", "replace").splitlines())
    try:
        corners = [[float(word) for word in words[1:4]] for words in lines if words[:1] == ["vertex"]]
        return np.array(corners, np.float64).reshape(-1, 3)
    except ValueError:
        return np.zeros((0, 3))
