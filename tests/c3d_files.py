"""C3D files made by hand for tests, with any processor and any mistake; nothing of the program's own is used."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence

import numpy as np

BLOCK = 512
ORDERS = {84: "<", 85: "<", 86: ">"}


def vax(value: float) -> bytes:
    """A VAX F float: two words, the one with sign and exponent first; ``0.1f · 2^(e − 128)``."""
    if value == 0:
        return bytes(4)
    fraction, exponent = math.frexp(abs(float(np.float32(value))))
    bits = (value < 0) << 31 | (exponent + 128) << 23 | round(fraction * 2**24) & 0x7FFFFF
    return struct.pack("<HH", bits >> 16, bits & 0xFFFF)


def floats(values: Sequence[float], processor: int) -> bytes:
    if processor == 85:
        return b"".join(vax(value) for value in values)
    return struct.pack(f"{ORDERS[processor]}{len(values)}f", *values)


def words(values: Sequence[int], processor: int) -> bytes:
    return struct.pack(f"{ORDERS[processor]}{len(values)}H", *(value % 65536 for value in values))


def record(name: str, group: int, rest: bytes, processor: int = 84, step: int | None = None) -> bytes:
    """A group (negative) or a parameter; ``step`` is a lie about where the next one is."""
    head = struct.pack("bb", len(name), group) + name.encode()
    return head + words([2 + len(rest) if step is None else step], processor) + rest


def parameter(name: str, group: int, value: object, processor: int = 84, described: bool = True) -> bytes:
    """Words from ints, floats from floats, text from a string or a list of them."""
    if isinstance(value, str):
        kind, dimensions, data = -1, [len(value)], value.encode("latin-1")
    elif isinstance(value, list) and value and isinstance(value[0], str):
        width = max(map(len, value))
        kind, dimensions, data = -1, [width, len(value)], "".join(v.ljust(width) for v in value).encode("latin-1")
    else:
        many = value if isinstance(value, list) else [value]
        dimensions = [len(many)] if isinstance(value, list) else []
        kind = 4 if isinstance(many[0], float) else 2
        data = floats(many, processor) if kind == 4 else words(many, processor)
    rest = struct.pack("bB", kind, len(dimensions)) + bytes(dimensions) + data + (b"\0" if described else b"")
    return record(name, group, rest, processor)


def point_parameters(count: int, frames: int, floating: bool, scale: float) -> dict[str, object]:
    return {
        "USED": count,
        "FRAMES": min(frames, 65535),
        "SCALE": -abs(scale) if floating else abs(scale),
        "RATE": 100.0,
        "DATA_START": 0,  # filled in
        "UNITS": "mm",
        "X_SCREEN": "+X",
        "Y_SCREEN": "+Z",
        "LABELS": [f"M{n}" for n in range(1, count + 1)],
    }


def c3d_file(
    points: np.ndarray,
    processor: int = 84,
    floating: bool = True,
    scale: float = 0.1,
    changed: dict[str, object] | None = None,
    others: Sequence[bytes] = (),
    analog: int = 0,
    header: dict[int, int] | None = None,
) -> bytes:
    """A file of points (F, M, 4) in millimetres with residuals.

    ``changed`` replaces parameters of POINT (None leaves one out), ``others`` are more records, ``header`` replaces
    words of the header, counted from 1.
    """
    frames, count = points.shape[:2]
    said = point_parameters(count, frames, floating, scale) | (changed or {})
    blocks = 1 + (200 + sum(len(repr(value)) + 32 for value in said.values()) + sum(map(len, others))) // BLOCK
    if said["DATA_START"] == 0 and "DATA_START" not in (changed or {}):
        said["DATA_START"] = blocks + 2
    group = record("POINT", -1, b"\0", processor)
    kept = [parameter(name, 1, value, processor) for name, value in said.items() if value is not None]
    section = bytes([1, 0x50, blocks, processor]) + group + b"".join(kept) + b"".join(others)
    head = [0, count, analog, 1, min(frames, 65535), 10, 0, 0, blocks + 2, 1 if analog else 0]
    for place, value in (header or {}).items():
        head[place - 1] = value
    top = b"\2\x50" + words(head[1:6], processor) + floats([-abs(scale) if floating else scale], processor)
    top += words(head[8:10], processor) + floats([100.0], processor)
    return (
        top.ljust(BLOCK, b"\0")
        + section.ljust(blocks * BLOCK, b"\0")
        + frame_data(points, processor, floating, scale, analog)
    )


def frame_data(points: np.ndarray, processor: int, floating: bool, scale: float, analog: int) -> bytes:
    found = b""
    for frame in points:
        if floating:
            found += floats([*frame.ravel().tolist(), *[7.0] * analog], processor)
        else:
            stored = np.column_stack((np.round(frame[:, :3] / scale), frame[:, 3])).astype(int)
            found += words([*stored.ravel().tolist(), *[7] * analog], processor)
    return found + bytes(-len(found) % BLOCK)


def wandering(frames: int = 6, count: int = 4, seed: int = 0) -> np.ndarray:
    """Points (F, M, 4) in steps of 0.1 mm, some not seen."""
    rng = np.random.default_rng(seed)
    points = np.concatenate((rng.integers(-20000, 20000, (frames, count, 3)) / 10, np.zeros((frames, count, 1))), -1)
    unseen = rng.random((frames, count)) < 0.2
    points[unseen] = [0, 0, 0, -1]
    return points


def expected(points: np.ndarray) -> np.ndarray:
    """(F, M, 3) metres, NaN where a point is not seen."""
    return np.where(points[..., 3:] < 0, np.nan, points[..., :3] / 1000)
