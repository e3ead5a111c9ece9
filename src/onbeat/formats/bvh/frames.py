"""The frames of a BVH file, turned into rotations and paths block by block as they are read.

The table of channels is never held whole: a block of some hundred frames stays in the processor's cache from text to
quaternions, so that memory is that of the result.
"""

from __future__ import annotations

from typing import BinaryIO, NamedTuple

import numpy as np

from onbeat._shapes import Array, Ints, Positions, Rotations
from onbeat.errors import FormatError
from onbeat.formats.bvh.hierarchy import Joint
from onbeat.formats.text import decoded, numbers, pieces
from onbeat.motion import rotations as rot


class Frames(NamedTuple):
    """All frames of a file, in its own unit and axes."""

    rotations: Rotations
    """(F, J, 4) of the joints and of the End Sites that have a length, in their order."""
    paths: dict[int, Positions]
    """(F, 3) of those with position channels, by their number among these joints."""


def read_frames(
    file: BinaryIO, rest: bytes, left: int, line: int, frames: int, joints: list[Joint], label: str
) -> Frames:
    """Read the motion block; line breaks inside a frame do not matter.

    Parameters
    ----------
    rest : what has been read of it already.
    left : bytes from the start of ``rest`` to the end of the file.
    line : the line on which ``rest`` starts.
    frames : how many are promised.

    Raises
    ------
    FormatError
        If there are fewer or more numbers than promised, or something that is no number.
    """
    channels = sum(len(joint.channels) for joint in joints)
    if channels == 0 or frames == 0:
        raise FormatError(f"{label}: {frames} frames of {channels} channels hold no motion")
    # Each number takes two bytes at least: nothing is set aside for a promise that the file has no room for.
    table = _Table(frames, joints) if frames * channels <= (left + 1) // 2 else None
    carry, done, count = np.zeros(0), 0, 0
    for piece in pieces(file, label, rest):
        values = numbers(piece, line, label)
        _check(values, piece, line, count, channels, label)
        line += _lines(piece)
        count += values.size
        if table is None or count > frames * channels:
            continue
        values = np.concatenate((carry, values)) if carry.size else values
        whole = values.size // channels
        block, carry = values[: whole * channels].reshape(whole, channels), values[whole * channels :]
        table.add(block, done)
        done += whole
    if table is None or count != frames * channels:
        raise FormatError(
            f"{label}: {frames} frames of {channels} channels are promised ({frames * channels} numbers), "
            f"{count / channels:g} frames found ({count} numbers): the file is cut off or its count wrong"
        )
    return Frames(table.rotations, table.paths)


class _Table:
    """Where the joints' channels are in a row of numbers, and the arrays that are filled from them."""

    def __init__(self, frames: int, joints: list[Joint]) -> None:
        kept = [joint for joint in joints if not (joint.end and not any(joint.offset or ()))]
        self.rotations = np.empty((frames, len(kept), 4))
        self.rotations[...] = rot.IDENTITY
        self.paths: dict[int, Positions] = {}
        self.moves: list[tuple[Positions, int, int]] = []
        groups: dict[str, list[tuple[int, list[int]]]] = {}
        for number, joint in enumerate(kept):
            turning = [(axis, column) for axis, turns, column in joint.channels if turns]
            order = "".join("XYZ"[axis] for axis, _ in turning)
            groups.setdefault(order, []).append((number, [column for _, column in turning]))
            if len(turning) < len(joint.channels):
                self.paths[number] = path = np.tile(np.asarray(joint.offset, np.float64), (frames, 1))
                self.moves += [(path, axis, column) for axis, turns, column in joint.channels if not turns]
        self.groups = [_group(order, members) for order, members in groups.items() if order]

    def add(self, block: Array, at: int) -> None:
        """Frames (n, channels) that begin at frame ``at``; joints that turn about the same axes are done together."""
        rows = slice(at, at + len(block))
        radians = np.radians(block)
        for order, members, columns in self.groups:
            self.rotations[rows, members] = rot.from_euler(order, radians[:, columns])
        for path, axis, column in self.moves:
            path[rows, axis] = block[:, column]


def _group(order: str, members: list[tuple[int, list[int]]]) -> tuple[str, slice | Ints, Ints]:
    """Joints with the same axes: their numbers (a slice where they follow each other) and their columns (k, n)."""
    numbers = np.array([number for number, _ in members])
    run = slice(int(numbers[0]), int(numbers[-1]) + 1)
    return order, run if len(numbers) == run.stop - run.start else numbers, np.array([c for _, c in members])


def _lines(piece: bytes) -> int:
    return piece.count(b"\n") or piece.count(b"\r")


def _check(values: Array, piece: bytes, line: int, before: int, channels: int, label: str) -> None:
    # Beyond a billion units or turns nothing is motion, and sums of it would overflow.
    good = np.abs(values) < 1e9
    if good.all():
        return
    bad = int(np.argmin(good))
    words = np.cumsum([len(row.split()) for row in decoded(piece).split("\n")])
    line += int(np.searchsorted(words, bad, side="right"))
    what = "is too large" if abs(values[bad]) >= 1e9 else "is not a number"
    frame = (before + bad) // channels
    raise FormatError(f"{label}:{line}: frame {frame} has a value that {what} ({values[bad]:g})")
