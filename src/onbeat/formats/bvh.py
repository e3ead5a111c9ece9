"""Biovision Hierarchy (BVH): joints with any channels, End Sites kept.

A BVH file stores neither its unit nor which axis is up. Both are guessed when reading (see
:mod:`onbeat.formats.conventions`) unless a :class:`Convention` is given. Position channels replace a joint's OFFSET;
where they do not change over time they become the skeleton's offset. A helper root above a travelling joint (as in
files whose ``Hips`` stand under a ``joint_Root`` on the ground) is folded into that joint, so that the root is what
travels. An End Site without length only says that a joint is a leaf, and is not kept.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from onbeat._shapes import Array, Bools, Rotations
from onbeat.errors import FormatError
from onbeat.files import write_atomically
from onbeat.formats.conventions import (
    Convention,
    Up,
    guessed_unit,
    guessed_up,
    y_up_rotations,
    y_up_vectors,
    z_up_motion,
)
from onbeat.motion import Motion, Skeleton
from onbeat.motion import rotations as rot

_MOTION = re.compile(r"^[ \t]*MOTION\b[ \t]*", re.IGNORECASE | re.MULTILINE)
_COUNTS = re.compile(r"\s*FRAMES[ \t]*:?[ \t]*(\S+)\s+FRAME[ \t]*TIME[ \t]*:?[ \t]*(\S+)", re.IGNORECASE)
_CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)
_SCALE_FREE = 1e-5
"""A position channel that changes by less than this part of the body's longest bone is constant."""


@dataclass
class _Joint:
    name: str
    parent: int
    line: int
    end: bool = False
    offset: list[float] | None = None
    channels: list[tuple[int, bool, int]] = field(default_factory=list[tuple[int, bool, int]])
    """(axis, whether it is a rotation, column)."""


def read_bvh(path: str | Path, fps: float | None = None, up: Up | None = None, unit: str | None = None) -> Motion:
    """Read a BVH file in metres with Z up; ``fps`` replaces the file's rate, ``up`` and ``unit`` the guesses.

    Raises
    ------
    FormatError
        If the file is not a whole, valid BVH file; file, line and what was expected are named.
    """
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    return parse_bvh(text, str(path), fps, up, unit, path.stem)


def parse_bvh(
    text: str, label: str, fps: float | None = None, up: Up | None = None, unit: str | None = None, name: str = ""
) -> Motion:
    """A motion from the text of a BVH file; ``label`` names the file in messages."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    start = _MOTION.search(text)
    if start is None:
        raise FormatError(f"{label}: no MOTION line found; a BVH file has a HIERARCHY and then MOTION")
    joints = _Hierarchy(text[: start.start()], label).joints
    line = text.count("\n", 0, start.start()) + 1
    counts = _COUNTS.match(text, start.end())
    if counts is None:
        raise FormatError(f"{label}:{line}: 'Frames: <count>' and 'Frame Time: <seconds>' are expected after MOTION")
    frames, rate = _whole_number(counts[1], f"{label}:{line}", "frames"), _rate(counts[2], f"{label}:{line}")
    values = _values(text, counts.end(), frames, sum(len(j.channels) for j in joints), label)
    raw = _motion(joints, values, rate if fps is None else fps, name, label)
    up = guessed_up(raw)[0] if up is None else up
    return z_up_motion(raw, Convention(up, unit or guessed_unit(raw.skeleton)).metres, up)


class _Hierarchy:
    """The joints of the text above MOTION, read word by word."""

    def __init__(self, text: str, label: str) -> None:
        lines = re.sub(r"([{}])", r" \1 ", text).split("\n")
        self.words = [(word, n) for n, line in enumerate(lines, 1) for word in line.split()]
        self.at, self.label, self.columns = 0, label, 0
        self.joints: list[_Joint] = []
        self.stack: list[int] = []
        if not self.words or self.words[0][0].upper() != "HIERARCHY":
            raise FormatError(f"{label}:1: HIERARCHY is expected at the start of a BVH file")
        self.at = 1
        while self.at < len(self.words):
            self._statement()
        if self.stack:
            joint = self.joints[self.stack[-1]]
            raise FormatError(f"{label}: the braces of joint {joint.name!r} (line {joint.line}) are not closed")
        if not self.joints:
            raise FormatError(f"{label}: the HIERARCHY has no ROOT")

    def _next(self) -> tuple[str, int]:
        if self.at >= len(self.words):
            raise FormatError(f"{self.label}:{self.words[-1][1]}: the HIERARCHY ends too soon")
        self.at += 1
        return self.words[self.at - 1]

    def _statement(self) -> None:
        word, line = self._next()
        kind = word.upper()
        if kind in ("ROOT", "JOINT", "END"):
            self._open(kind, line)
        elif kind == "}" and self.stack:
            self._close(line)
        elif kind == "OFFSET" and self.stack:
            self.joints[self.stack[-1]].offset = [self._number() for _ in range(3)]
        elif kind == "CHANNELS" and self.stack:
            self._channels(self.joints[self.stack[-1]])
        else:
            raise FormatError(
                f"{self.label}:{line}: {word[:40]!r} found; ROOT, JOINT, End Site, OFFSET or CHANNELS is expected"
            )

    def _open(self, kind: str, line: int) -> None:
        words: list[str] = []
        while (found := self._next())[0] != "{":
            if found[1] != line:
                raise FormatError(f"{self.label}:{found[1]}: a brace '{{' is expected, {found[0][:40]!r} found")
            words.append(found[0])
        if (kind == "ROOT") == bool(self.joints) or (self.joints and not self.stack):
            raise FormatError(f"{self.label}:{line}: {kind} is out of place; one ROOT with JOINTs inside is expected")
        parent = self.stack[-1] if self.stack else -1
        if parent >= 0 and self.joints[parent].end:
            raise FormatError(f"{self.label}:{line}: {kind} stands inside an End Site, which has no children")
        name = " ".join(words)
        if kind == "END":
            name = self._free_name(f"{self.joints[parent].name}_end")
        elif not name or any(joint.name == name for joint in self.joints):
            raise FormatError(f"{self.label}:{line}: the joint name {name!r} is empty or occurs twice; rename it")
        self.stack.append(len(self.joints))
        self.joints.append(_Joint(name, parent, line, kind == "END"))

    def _free_name(self, name: str) -> str:
        taken = {joint.name for joint in self.joints}
        return next(n for n in (name, *(f"{name}{k}" for k in range(2, len(taken) + 3))) if n not in taken)

    def _close(self, line: int) -> None:
        joint = self.joints[self.stack.pop()]
        if joint.offset is None:
            raise FormatError(f"{self.label}:{line}: joint {joint.name!r} has no OFFSET")

    def _number(self) -> float:
        word, line = self._next()
        try:
            value = float(word)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise FormatError(f"{self.label}:{line}: a number is expected, {word[:40]!r} found")
        return value

    def _channels(self, joint: _Joint) -> None:
        word, line = self._next()
        count = _whole_number(word, f"{self.label}:{line}", "channels")
        if joint.channels or joint.end:
            raise FormatError(f"{self.label}:{line}: joint {joint.name!r} cannot have these CHANNELS")
        for _ in range(count):
            word, _ = self._next()
            found = _CHANNEL.fullmatch(word)
            if found is None:
                raise FormatError(
                    f"{self.label}:{line}: {count} channels such as Xrotation are expected, {word[:40]!r} found"
                )
            joint.channels.append(("xyz".index(found[1].lower()), found[2].lower() == "rotation", self.columns))
            self.columns += 1


def _whole_number(word: str, where: str, what: str) -> int:
    if not re.fullmatch(r"\d{1,15}", word, re.ASCII):
        raise FormatError(f"{where}: a whole number of {what} is expected, {word[:40]!r} found")
    return int(word)


def _rate(word: str, where: str) -> float:
    """Frames a second from the frame time's text; a rounded 1/n counts as n (0.0083333 is 120, not 120.0005)."""
    try:
        seconds = float(word)
    except ValueError:
        seconds = np.nan
    if not 1e-6 <= seconds <= 1e6:
        raise FormatError(f"{where}: a frame time in seconds is expected, {word[:40]!r} found")
    whole = round(1 / seconds)
    digits = re.fullmatch(r"\d*\.(\d+)", word, re.ASCII)
    if digits and whole and abs(1 / whole - seconds) <= min(0.51 * 10.0 ** -len(digits[1]), 2.5e-3 * seconds):
        return float(whole)
    return 1 / seconds


def _values(text: str, start: int, frames: int, channels: int, label: str) -> Array:
    """(frames, channels) numbers of the motion block; line breaks inside a frame do not matter."""
    if channels == 0 or frames == 0:
        raise FormatError(f"{label}: {frames} frames of {channels} channels hold no motion")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = np.fromstring(text[start:], dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            raise _bad_number(text, start, label) from None
    if values.size != frames * channels:
        raise FormatError(
            f"{label}: {frames} frames of {channels} channels are promised ({frames * channels} numbers), "
            f"{values.size / channels:g} frames found ({values.size} numbers): the file is cut off or its count wrong"
        )
    if not np.isfinite(values).all():
        bad = int(np.argmin(np.isfinite(values)))
        raise FormatError(f"{label}: frame {bad // channels} has a value that is not a number ({values[bad]})")
    return values.reshape(frames, channels)


def _bad_number(text: str, start: int, label: str) -> FormatError:
    line = text.count("\n", 0, start) + 1
    for n, row in enumerate(text[start:].split("\n"), line):
        for word in row.split():
            try:
                float(word)
            except ValueError:
                return FormatError(f"{label}:{n}: a number is expected, {word[:40]!r} found")
    return FormatError(f"{label}: the motion after line {line} is not all numbers")


def _motion(joints: list[_Joint], values: Array, fps: float, name: str, label: str) -> Motion:
    """The motion in the file's own unit and axes."""
    kept = [n for n, joint in enumerate(joints) if not (joint.end and not any(joint.offset or ()))]
    number = {old: new for new, old in enumerate(kept)}
    joints = [joints[n] for n in kept]
    parents = [number.get(joint.parent, -1) for joint in joints]
    offsets = np.array([joint.offset for joint in joints], np.float64)
    rotations = _rotations(joints, values)
    paths = {n: _path(joint, values) for n, joint in enumerate(joints) if any(not c[1] for c in joint.channels)}
    root = paths.pop(0, np.broadcast_to(offsets[0], (len(values), 3)))
    offsets[0] = 0
    tolerance = _SCALE_FREE * float(np.abs(offsets).max(initial=0.0)) + 1e-12
    moving = {n: path for n, path in paths.items() if np.ptp(path, axis=0).max() > max(tolerance, _noise(path))}
    for n, path in paths.items():
        offsets[n] = np.median(path, axis=0)
    translations = None
    if moving:
        translations = np.tile(offsets, (len(values), 1, 1))
        for n, path in moving.items():
            translations[:, n] = path
    try:
        skeleton = Skeleton([joint.name for joint in joints], parents, offsets, [joint.end for joint in joints])
        motion = Motion(skeleton, rotations, root, fps, name, translations)
    except FormatError as error:
        raise FormatError(f"{label}: {error}") from None
    return _without_helper_roots(motion)


def _noise(path: Array) -> float:
    """Rounding of six printed digits."""
    return 1e-5 * float(np.abs(path).max())


def _rotations(joints: list[_Joint], values: Array) -> Rotations:
    """(F, J, 4) local rotations; joints whose channels turn about the same axes are done together."""
    rotations = np.zeros((len(values), len(joints), 4))
    rotations[..., 0] = 1
    groups: dict[tuple[int, ...], list[int]] = {}
    for n, joint in enumerate(joints):
        groups.setdefault(tuple(axis for axis, turns, _ in joint.channels if turns), []).append(n)
    for axes, members in groups.items():
        columns = [[column for _, turns, column in joints[n].channels if turns] for n in members]
        if axes:
            rotations[:, members] = rot.from_euler(
                "".join("XYZ"[axis] for axis in axes), np.radians(values[:, np.array(columns)])
            )
    return rotations


def _path(joint: _Joint, values: Array) -> Array:
    """(F, 3) positions; an axis without a channel keeps its OFFSET."""
    path = np.tile(np.asarray(joint.offset, np.float64), (len(values), 1))
    for axis, turns, column in joint.channels:
        if not turns:
            path[:, axis] = values[:, column]
    return path


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
        s = Skeleton(s.names[1:], np.maximum(s.parents[1:] - 1, -1), offsets, s.end_sites[1:])
        t = t if np.ptp(t, axis=0).max() > 0 else None
        motion = Motion(s, rotations, path, motion.fps, motion.name, t)
    return motion


def write_bvh(motion: Motion, path: str | Path, convention: Convention | None = None) -> None:
    """Write a BVH file, Y up in centimetres unless ``convention`` says otherwise, rotations in the order ZXY.

    Exactly as many frames as the motion has; the frame time has all its digits. A leaf that is a joint gets an End
    Site without length.
    """
    write_atomically(path, bvh_text(motion, convention or Convention()).encode())


def bvh_text(motion: Motion, convention: Convention) -> str:
    """The text of a BVH file."""
    y_up = convention.up == "y"
    scale = 1 / convention.metres
    skeleton = motion.skeleton
    vectors = y_up_vectors if y_up else np.asarray
    offsets = vectors(skeleton.offsets) * scale
    rotations = y_up_rotations(motion.rotations) if y_up else motion.rotations
    moving = np.zeros(len(skeleton), bool)
    if motion.translations is not None:
        moving = np.ptp(motion.translations, axis=0).max(-1) > 0
    moving[0] = True
    lines = ["HIERARCHY", *_hierarchy_lines(skeleton, offsets, moving)]
    columns: list[Array] = []
    for joint in _file_order(skeleton):
        if moving[joint]:
            path = motion.root_positions if joint == 0 else _moved(motion, joint)
            columns.append(vectors(path) * scale)
        columns.append(np.degrees(rot.to_euler("ZXY", rotations[:, joint])))
    table = np.concatenate(columns, axis=1)
    row = " ".join(["%.6f"] * table.shape[1])
    lines += ["MOTION", f"Frames: {len(motion)}", f"Frame Time: {_plain_decimal(1 / motion.fps)}"]
    return "\n".join([*lines, *(row % tuple(values) for values in table.tolist())]) + "\n"


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
    place = "\tOFFSET " + " ".join(f"{value:.6f}" for value in offset)
    if skeleton.end_sites[joint]:
        return ["End Site", "{", place]
    name = skeleton.names[joint]
    if re.search(r"[{}\r\n]", name) or not name.strip():
        raise FormatError(f"BVH cannot hold the joint name {name!r}; rename it without braces and line breaks")
    positions = "Xposition Yposition Zposition " if moving else ""
    channels = f"\tCHANNELS {6 if moving else 3} {positions}Zrotation Xrotation Yrotation"
    leaf = [] if skeleton.children[joint] else ["\tEnd Site", "\t{", "\t\tOFFSET 0.0 0.0 0.0", "\t}"]
    return [f"{'JOINT' if joint else 'ROOT'} {name}", "{", place, channels, *leaf]
