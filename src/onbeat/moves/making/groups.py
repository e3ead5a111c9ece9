"""Groups: the clips of a library in lots of about 4,096 frames, whose pairs are searched block by block.

Which clips lie in a group depends on what they are and not on where they stand: contents are split by the bits of
their digests until each lot is small enough. So a clip more or less changes its own group (and one beside it, where
that splits or is joined again), and the blocks of all others stay as they are.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import NamedTuple

GROUP = 4096
"""Graph frames in a group at most: 64 MB of distances, float32, in a block."""
RIM = 2
"""Frames beyond a cut that both sides share, as many as a minimum looks at on each side."""


class Member(NamedTuple):
    """A clip as groups see it.

    Parameters
    ----------
    clip : its number in the library.
    content : of its recording; a clip and its mirror image lie in one group.
    digest : of its own bytes.
    frames : graph frames.
    """

    clip: int
    content: str
    digest: str
    frames: int


class Piece(NamedTuple):
    """Graph frames ``start`` … ``stop`` of a clip; all of them, but where it is too long for a group."""

    clip: int
    start: int
    stop: int


class Lot(NamedTuple):
    """A group: its key, by which its pairs are known again, and what lies in it, in order."""

    key: bytes
    pieces: tuple[Piece, ...]

    @property
    def frames(self) -> int:
        """Graph frames in all."""
        return sum(piece.stop - piece.start for piece in self.pieces)


def lots_of(members: Sequence[Member], size: int = GROUP) -> list[Lot]:
    """The groups of clips, in order of their contents' digests.

    Examples
    --------
    >>> clips = [Member(0, "0a", "x", 300), Member(1, "0a", "y", 300), Member(2, "f0", "z", 500)]
    >>> [[piece.clip for piece in lot.pieces] for lot in lots_of(clips, size=1000)]
    [[0, 1], [2]]
    """
    units: dict[str, list[Member]] = {}
    for member in sorted(members, key=lambda member: (member.content, member.clip)):
        units.setdefault(member.content, []).append(member)
    found: list[Lot] = []
    short: list[list[Member]] = []
    for unit in units.values():
        if sum(member.frames for member in unit) <= size:
            short.append(unit)
        else:
            found += [_lot([part]) for member in unit for part in _cut(member, size)]
    found += [_lot([(m, Piece(m.clip, 0, m.frames)) for unit in lot for m in unit]) for lot in _split(short, size, 0)]
    return sorted(found, key=lambda lot: lot.key)


def _split(units: list[list[Member]], size: int, bit: int) -> list[list[list[Member]]]:
    """Units split by one bit of their contents after the other."""
    if not units:
        return []
    if sum(member.frames for unit in units for member in unit) <= size or len(units) == 1:
        return [units]
    sides: tuple[list[list[Member]], list[list[Member]]] = ([], [])
    for unit in units:
        sides[_bit(unit[0].content, bit)].append(unit)
    return [lot for side in sides for lot in _split(side, size, bit + 1)]


def _bit(content: str, bit: int) -> int:
    """A bit of a content's name, whatever it looks like."""
    return hashlib.sha256(content.encode()).digest()[bit // 8 % 32] >> (7 - bit % 8) & 1


def _cut(member: Member, size: int) -> list[tuple[Member, Piece]]:
    """A long clip in pieces that share their rims: a pair near a cut is found on one side of it, and there alone."""
    inner = size - 2 * RIM
    cuts = range(0, max(member.frames - 2 * RIM, 1), inner)
    return [(member, Piece(member.clip, start, min(start + size, member.frames))) for start in cuts]


def _lot(parts: list[tuple[Member, Piece]]) -> Lot:
    total = hashlib.blake2b(digest_size=16)
    for member, piece in parts:
        total.update(f"{member.digest} {piece.start} {piece.stop}\n".encode())
    return Lot(total.digest(), tuple(piece for _, piece in parts))
