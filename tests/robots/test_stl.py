"""Meshes of STL files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import BodyError
from onbeat.robots.description.stl import read_stl

CORNERS = np.arange(18, dtype=np.float32).reshape(2, 3, 3)


def binary(head: bytes = b"solid by name only") -> bytes:
    body = b"".join(np.zeros(3, "<f4").tobytes() + triangle.tobytes() + b"\0\0" for triangle in CORNERS)
    return head.ljust(80, b"\0") + (2).to_bytes(4, "little") + body


def test_binary_and_text_hold_the_same(tmp_path: Path):
    (tmp_path / "a.stl").write_bytes(binary())
    lines = "\n".join(f"  vertex {x:g} {y:g} {z:e}" for x, y, z in CORNERS.reshape(-1, 3))
    (tmp_path / "b.stl").write_text(
        f"solid b\nfacet normal 0 0 1\nouter loop\n{lines}\nendloop\nendfacet\nendsolid b\n"
    )
    for name in ("a.stl", "b.stl"):
        np.testing.assert_array_equal(read_stl(tmp_path / name), CORNERS.reshape(-1, 3))


@pytest.mark.parametrize(
    "data", [b"", b"solid\nendsolid", binary()[:-1], b"\xff" * 200, b"solid\nvertex 1 2\n", b"vertex a b c"]
)
def test_what_is_no_mesh_is_told(tmp_path: Path, data: bytes):
    (tmp_path / "a.stl").write_bytes(data)
    with pytest.raises(BodyError, match=r"a\.stl"):
        read_stl(tmp_path / "a.stl")


def test_a_mesh_that_is_not_there_is_told(tmp_path: Path):
    with pytest.raises(BodyError, match="cannot read the mesh"):
        read_stl(tmp_path / "a.stl")
