"""Biovision Hierarchy (BVH): joints with any channels, End Sites kept.

A BVH file stores neither its unit nor which axis is up. Both are guessed when reading (see
:mod:`onbeat.formats.upright` and :mod:`onbeat.formats.body_size`) unless they are given. Position channels replace a
joint's OFFSET; where they do not change over time they become the skeleton's offset. A helper root above a travelling
joint (as in files whose ``Hips`` stand under a ``joint_Root`` on the ground) is folded into that joint, so that the
root is what travels. An End Site without length only says that a joint is a leaf, and is not kept.
"""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import BinaryIO

import numpy as np

from onbeat._shapes import Array, Positions
from onbeat.errors import FormatError
from onbeat.formats.body_size import guessed_unit
from onbeat.formats.bvh.frames import Frames, read_frames
from onbeat.formats.bvh.hierarchy import Joint, read_hierarchy, whole_number
from onbeat.formats.conventions import Up, turn_in_place, unit_metres, z_up_vectors
from onbeat.formats.notes import tell
from onbeat.formats.rates import ASK, printed_rate
from onbeat.formats.text import decoded, open_text
from onbeat.formats.upright import guessed_up
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

_LONGEST_HEADER = 1 << 24
_LARGEST_UTF16 = 1 << 26
"""Bytes; a file in UTF-16 is turned to UTF-8 whole."""
_MOTION = re.compile(rb"(?:^|[\r\n}])[ \t]*MOTION(?=\s)", re.IGNORECASE)
_COUNTS = re.compile(
    rb"\s{0,999}FRAMES?[ \t]*:?[ \t]*([^\s:]+)\s{1,999}FRAME[ \t]*TIME[ \t]*:?[ \t]*([^\s:]+)(?=\s|$)", re.IGNORECASE
)
_SLOWEST = 0.2
"""Frames a second; with fewer it is no movement, but a rate or milliseconds where seconds belong."""
_SCALE_FREE = 1e-5
"""A position channel that changes by less than this part of the body's longest bone is constant."""


def read_bvh(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read a BVH file in metres with Z up; ``fps`` replaces the file's rate, ``up`` and ``unit`` the guesses.

    Raises
    ------
    FormatError
        If the file is not a whole, valid BVH file; file, line and what was expected are named.
    """
    path = Path(path)
    with open_text(path) as file:
        return _read(file, path.stat().st_size, str(path), fps, up, unit, path.stem)


def parse_bvh(
    text: str, label: str, fps: float | None = None, up: Up | None = None, unit: str | None = None, name: str = ""
) -> Motion:
    """A motion from the text of a BVH file; ``label`` names the file in messages."""
    data = text.encode()
    return _read(io.BytesIO(data), len(data), label, fps, up, unit, name)


def _read(
    file: BinaryIO, size: int, label: str, fps: float | None, up: Up | None, unit: str | None, name: str
) -> Motion:
    file, size = _in_utf8(file, size)
    above, rest = _header(file, label)
    head = decoded(above)
    joints = read_hierarchy(head, label)
    line = head.count("\n") + 1
    counts = _COUNTS.match(rest)
    if counts is None:
        raise FormatError(f"{label}:{line}: 'Frames: <count>' and 'Frame Time: <seconds>' are expected after MOTION")
    frames = whole_number(decoded(counts[1]), f"{label}:{line}", "frames")
    rate = _rate(decoded(counts[2]), f"{label}:{line}") if fps is None else fps
    line += decoded(counts[0]).count("\n")
    left = size - len(above) - counts.end()
    found = read_frames(file, rest[counts.end() :], left, line, frames, joints, label)
    return _without_helper_roots(_motion(joints, found, rate, up, unit, name, label))


def _in_utf8(file: BinaryIO, size: int) -> tuple[BinaryIO, int]:
    """The file, its text turned to UTF-8 where it is marked as UTF-16."""
    marked = file.read(2) in (b"\xff\xfe", b"\xfe\xff")
    file.seek(0)
    if not marked or size > _LARGEST_UTF16:
        return file, size
    text = decoded(file.read()).encode()
    return io.BytesIO(text), len(text)


def _header(file: BinaryIO, label: str) -> tuple[bytes, bytes]:
    """What is above the word MOTION, with the line break before it, and what was read beyond it."""
    data, block = bytearray(), 1 << 17
    while (found := _MOTION.search(data, max(0, len(data) - block - 99))) is None:
        more = file.read(block) if len(data) < _LONGEST_HEADER else b""
        if not more or not (data or b"HIERARCHY" in more.upper() or _MOTION.search(more)):
            raise FormatError(f"{label}: no MOTION line found; a BVH file has a HIERARCHY and then MOTION")
        data += more
    return bytes(data[: found.start() + 1]), bytes(data[found.end() :]) + file.read(4096)


def _rate(word: str, where: str) -> float:
    rate = printed_rate(word)
    if rate is None:
        raise FormatError(f"{where}: a frame time in seconds is expected, {word[:40]!r} found")
    if rate < _SLOWEST:
        raise FormatError(
            f"{where}: a frame time of {word[:40]} s is found, too long for a movement; if it is a rate or "
            f"milliseconds, find out the frames a second and {ASK}"
        )
    return rate


def _motion(
    joints: list[Joint], found: Frames, fps: float, up: Up | None, unit: str | None, name: str, label: str
) -> Motion:
    """The motion in metres with Z up."""
    kept = [n for n, joint in enumerate(joints) if not (joint.end and not any(joint.offset or ()))]
    number = {old: new for new, old in enumerate(kept)}
    names, ends = [joints[n].name for n in kept], [joints[n].end for n in kept]
    parents = [number.get(joints[n].parent, -1) for n in kept]
    offsets = np.array([joints[n].offset for n in kept], np.float64)
    paths = dict(found.paths)
    root = paths.pop(0, None)
    root = np.tile(offsets[0], (len(found.rotations), 1)) if root is None else root
    offsets[0] = 0
    translations = _moving(offsets, {} if _all_zero(offsets, paths) else paths, len(root))
    try:
        raw = Skeleton(names, parents, offsets, ends)
        some = slice(None, None, max(1, len(root) // 32))
        moved = None if translations is None else translations[some]
        up = up or _told_up(Motion(raw, found.rotations[some], root[some], fps, name, moved))
        metres = unit_metres(unit or guessed_unit(raw, label))
        skeleton = Skeleton(names, parents, z_up_vectors(offsets, up) * metres, ends)
        turn_in_place(found.rotations[..., 1:], up)
        for vectors in (root, translations):
            if vectors is not None:
                turn_in_place(vectors, up, metres)
        for array in (found.rotations, root, translations):
            if array is not None:
                array.setflags(write=False)  # now the motion's own: no copy is made
        return Motion(skeleton, found.rotations, root, fps, name, translations)
    except FormatError as error:
        raise FormatError(f"{label}: {error}") from None


def _told_up(motion: Motion) -> Up:
    up, why = guessed_up(motion)
    tell("up", up, why)
    return up


def _all_zero(offsets: Array, paths: dict[int, Positions]) -> bool:
    """Whether the positions of all bones are zero throughout: they are added to OFFSET then, and put nothing there.

    Elsewhere they replace OFFSET; here no bone would have a length.
    """
    bones = [n for n in paths if offsets[n].any()]
    zero = len(bones) > 2 and not any(paths[n].any() for n in bones)
    if zero:
        tell("positions", "none", f"those of all {len(bones)} bones are zero throughout; OFFSET is taken")
    return zero


def _moving(offsets: Array, paths: dict[int, Positions], frames: int) -> Positions | None:
    """Animated offsets (F, J, 3) where any joint's positions move; positions that stay go into ``offsets`` instead."""
    tolerance = _SCALE_FREE * float(np.abs(offsets).max(initial=0.0)) + 1e-12
    moving = {n: path for n, path in paths.items() if np.ptp(path, axis=0).max() > max(tolerance, _noise(path))}
    for n, path in paths.items():
        offsets[n] = np.median(path, axis=0)
    if not moving:
        return None
    translations = np.tile(offsets, (frames, 1, 1))
    for n, path in moving.items():
        translations[:, n] = path
    return translations


def _noise(path: Array) -> float:
    """Rounding of six printed digits."""
    return 1e-5 * float(np.abs(path).max())


def _without_helper_roots(motion: Motion) -> Motion:
    """The only child of the root becomes the root as long as it travels within it."""
    s, t = motion.skeleton, motion.translations
    while t is not None and len(s.children[0]) == 1 and np.ptp(t[:, 1], axis=0).max() > 0 and not s.end_sites[1]:
        turn = motion.rotations[:, 0]
        path = motion.root_positions + rot.rotate(turn, t[:, 1])
        rotations = np.array(motion.rotations[:, 1:])
        rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
        offsets = np.array(s.offsets[1:])
        offsets[0] = 0
        t = np.array(t[:, 1:])
        t[:, 0] = 0
        parents = np.maximum(s.parents[1:] - 1, -1)
        s = s.replace(names=s.names[1:], parents=parents, offsets=offsets, end_sites=s.end_sites[1:])
        t = t if np.ptp(t, axis=0).max() > 0 else None
        motion = Motion(s, rotations, path, motion.fps, motion.name, t)
    return motion
