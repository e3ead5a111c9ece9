"""A sheet of small pictures of a motion, for looking at a dance at a glance; and pictures as PNG files."""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import replace

import numpy as np

from onbeat._shapes import Times
from onbeat.files import write_atomically
from onbeat.motion import Motion
from onbeat.viewer.figure import Figure, ground_height
from onbeat.viewer.render.camera import Size, follow
from onbeat.viewer.render.lettering import write_text
from onbeat.viewer.render.raster import render_frame
from onbeat.viewer.render.stage import Stage


def contact_sheet(motion: Motion, times: Times, columns: int = 6, size: Size = (320, 320)) -> np.ndarray:
    """Poses of a motion in a grid, row by row, each with its second.

    Parameters
    ----------
    motion : what is looked at.
    times : (N,) seconds.
    columns : pictures in a row.
    size : of each picture, in pixels.

    Returns
    -------
    (rows * height, columns * width, 3) uint8.
    """
    figure = Figure.of(motion.skeleton)
    ground = ground_height(figure, motion)
    poses = motion.at(np.asarray(times, np.float64))
    # A camera of its own for each pose, as smoothing over a sheet's distant moments would mean nothing; one distance.
    path = follow(poses, figure, ground, size=size, smoothing=0.0, side=0.45)
    path = replace(path, distances=np.full(len(poses), path.distances.max()))
    stage = Stage.lit_from(path.azimuth, ground, fine=3)
    rows = -(-len(poses) // columns)
    sheet = np.full((rows * size[1], columns * size[0], 3), 255, np.uint8)
    for number, second in enumerate(np.asarray(times).tolist()):
        picture = render_frame(poses.positions[number], figure, path[number], size, stage)
        letters = max(10, size[1] // 18)
        write_text(picture, f"{second:.2f} s", letters // 2, letters // 4, letters, (90, 96, 104))
        top, left = number // columns * size[1], number % columns * size[0]
        sheet[top : top + size[1] - 2, left : left + size[0] - 2] = picture[:-2, :-2]
    return sheet


def png_bytes(picture: np.ndarray) -> bytes:
    r"""A picture (H, W, 3) uint8 as a PNG file's bytes, the same for the same picture.

    Examples
    --------
    >>> png_bytes(np.zeros((2, 3, 3), np.uint8))[:4]
    b'\x89PNG'
    """
    height, width = picture.shape[:2]
    # Filter 1 of the format: each pixel less its left neighbour, modulo 256; smooth pictures pack well so.
    less = picture.copy()
    less[:, 1:] -= picture[:, :-1]
    lines = np.hstack((np.ones((height, 1), np.uint8), less.reshape(height, -1)))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(lines.tobytes(), 6)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in chunks)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def write_png(path: str | os.PathLike[str], picture: np.ndarray) -> None:
    """Write a picture (H, W, 3) uint8 as a PNG file."""
    write_atomically(path, png_bytes(picture))
