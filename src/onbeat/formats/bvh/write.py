"""Writing BVH: any tree, Y up in centimetres unless asked otherwise, rotations in the order ZXY."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Bools
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import Convention, Up, up_rotations, up_vectors
from onbeat.formats.decimals import decimal_rows
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot


def write_bvh(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a BVH file, Y up in centimetres unless ``convention`` says otherwise, rotations in the order ZXY.

    Exactly as many frames as the motion has; the frame time has all its digits. A leaf that is a joint gets an End
    Site without length.
    """
    write_atomically(path, bvh_bytes(motion, convention or Convention()))


def bvh_bytes(motion: Motion, convention: Convention) -> bytes:
    """The bytes of a BVH file, in UTF-8."""
    scale, up, skeleton = 1 / convention.metres, convention.up, motion.skeleton
    moving = np.zeros(len(skeleton), bool)
    if motion.translations is not None:
        moving = np.ptp(motion.translations, axis=0).max(-1) > 0
    moving[0] = True
    lines = ["HIERARCHY", *_hierarchy_lines(skeleton, up_vectors(skeleton.offsets, up) * scale, moving)]
    lines += ["MOTION", f"Frames: {len(motion)}", f"Frame Time: {_plain_decimal(1 / motion.fps)}", ""]
    return b"".join(["\n".join(lines).encode(), *map(decimal_rows, _tables(motion, up, scale, moving))])


def bvh_text(motion: Motion, convention: Convention) -> str:
    """The text of a BVH file."""
    return bvh_bytes(motion, convention).decode()


def _tables(motion: Motion, up: Up, scale: float, moving: Bools) -> Iterator[Array]:
    """Channels (n, channels) of a few frames at a time, so that they stay in the processor's cache."""
    order, step = _file_order(motion.skeleton), max(1, 8192 // len(motion.skeleton))
    for at in range(0, len(motion), step):
        rows = slice(at, at + step)
        angles = np.degrees(rot.to_euler("ZXY", up_rotations(motion.rotations[rows, order], up)))
        columns: list[Array] = []
        for joint, turns in zip(order, np.moveaxis(angles, 1, 0), strict=True):
            if moving[joint]:
                path = motion.root_positions[rows] if joint == 0 else _moved(motion, joint)[rows]
                columns.append(up_vectors(path, up) * scale)
            columns.append(turns)
        yield np.concatenate(columns, axis=1)


def _moved(motion: Motion, joint: int) -> Array:
    assert motion.translations is not None
    return motion.translations[:, joint]


def _plain_decimal(seconds: float) -> str:
    return np.format_float_positional(seconds, unique=True, min_digits=6)


def _file_order(skeleton: Skeleton) -> list[int]:
    """The joints with channels, depth first as the hierarchy lists them."""
    order, stack = [], [0]
    while stack:
        joint = stack.pop()
        if not skeleton.end_sites[joint]:
            order.append(joint)
        stack += reversed(skeleton.children[joint])
    return order


def _hierarchy_lines(skeleton: Skeleton, offsets: Array, moving: Bools) -> list[str]:
    """The lines from ROOT to its closing brace, depth first."""
    lines: list[str] = []
    stack: list[tuple[int, int]] = [(0, 0)]
    open_depth = 0
    while stack:
        joint, depth = stack.pop()
        lines += ["\t" * level + "}" for level in range(open_depth - 1, depth - 1, -1)]
        lines += ["\t" * depth + line for line in _joint_lines(skeleton, offsets[joint], bool(moving[joint]), joint)]
        open_depth = depth + 1
        stack += [(child, depth + 1) for child in reversed(skeleton.children[joint])]
    return [*lines, *("\t" * level + "}" for level in range(open_depth - 1, -1, -1))]


def _joint_lines(skeleton: Skeleton, offset: Array, moving: bool, joint: int) -> list[str]:
    """A joint up to its children; a leaf that is a joint gets an End Site without length."""
    place = "\tOFFSET " + decimal_rows(offset[None]).decode().strip()
    if skeleton.end_sites[joint]:
        return ["End Site", "{", place]
    name = skeleton.names[joint]
    if re.search(r"[{}\r\n]", name) or not name.strip():
        raise FormatError(f"BVH cannot hold the joint name {name!r}; rename it without braces and line breaks")
    positions = "Xposition Yposition Zposition " if moving else ""
    channels = f"\tCHANNELS {6 if moving else 3} {positions}Zrotation Xrotation Yrotation"
    leaf = [] if skeleton.children[joint] else ["\tEnd Site", "\t{", "\t\tOFFSET 0.0 0.0 0.0", "\t}"]
    return [f"{'JOINT' if joint else 'ROOT'} {name}", "{", place, channels, *leaf]
