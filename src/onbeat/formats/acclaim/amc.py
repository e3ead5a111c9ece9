"""Acclaim AMC: the values of each frame, read in blocks."""

from __future__ import annotations

import re
from pathlib import Path
from typing import BinaryIO

import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError
from onbeat.formats.acclaim.asf import Acclaim
from onbeat.formats.text import decoded, open_text, pieces

_LONGEST_HEADER = 1 << 16
_LARGEST_VALUE = 1e9
_NUMBERED = re.compile(rb"(?:^|[\r\n])[ \t]*(?=\d)")
Layout = tuple[dict[str, tuple[int, int]], int]
"""Where in a frame's words each bone's values are, and how many words a frame has."""


def read_columns(path: Path, acclaim: Acclaim) -> tuple[dict[str, Array], float]:
    """Each bone's (F, dofs) values, and the radians of one unit of angle.

    All frames list the same bones in the same order, so that the words of the file are a table.

    Raises
    ------
    FormatError
        If a frame is cut off, missing or not what the skeleton can move; file and frame are named.
    """
    words: list[str] = []
    layout: Layout | None = None
    blocks: list[dict[str, Array]] = []
    first, done = 0, 0
    with open_text(path) as file:
        radians, rest = _header(file, acclaim.radians, path)
        for piece in pieces(file, str(path), rest):
            words += decoded(piece).split()
            first = first or _frame_number(words[0], path)
            layout = layout or _layout(words, acclaim, path, last=False)
            if layout:
                count = len(words) // layout[1]
                blocks.append(_block(words[: count * layout[1]], layout, first + done, path))
                words, done = words[count * layout[1] :], done + count
    spans, width = layout or _layout(words, acclaim, path, last=True) or ({}, 1)
    count, cut = divmod(len(words), width)
    if count + done == 0 or cut:
        raise FormatError(f"{path}: the file ends inside frame {done + count + 1}; {width} words a frame are expected")
    if count:
        blocks.append(_block(words, (spans, width), first + done, path))
    return {name: np.concatenate([block[name] for block in blocks]) for name in spans}, radians


def _header(file: BinaryIO, radians: float, path: Path) -> tuple[float, bytes]:
    """The radians of one unit of angle, by the lines above the first frame, and what was read from it on."""
    data = file.read(_LONGEST_HEADER)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise FormatError(f"{path}: UTF-16 text found; save it as UTF-8")
    start = _NUMBERED.search(data)
    head = data if start is None else data[: start.end()]
    for number, line in enumerate(decoded(head).split("\n"), 1):
        word = line.strip().upper()
        radians = {":DEGREES": np.pi / 180, ":RADIANS": 1.0}.get(word, radians)
        if word and word[0] not in ":#":
            raise FormatError(f"{path}:{number}: a frame number is expected, {line.strip()[:40]!r} found")
    if start is None:
        raise FormatError(f"{path}: the file ends inside frame 1; no frame number is found in it")
    return radians, data[start.end() :]


def _frame_number(word: str, path: Path) -> int:
    if not re.fullmatch(r"\d{1,12}", word, re.ASCII):
        raise FormatError(f"{path}: a frame number is expected, {word[:40]!r} found")
    return int(word)


def _layout(words: list[str], acclaim: Acclaim, path: Path, *, last: bool) -> Layout | None:
    """From the first frame; None while it may go on in what is not yet read."""
    spans: dict[str, tuple[int, int]] = {}
    at = 1
    while at < len(words) and not words[at][:1].isdigit():
        bone = acclaim.bones.get(words[at])
        if bone is None or not bone.dofs or bone.name in spans:
            raise FormatError(f"{path}: frame {words[0]} has {words[at][:40]!r}, which its skeleton does not move so")
        spans[bone.name] = (at + 1, at + 1 + len(bone.dofs))
        at += 1 + len(bone.dofs)
    return (spans, at) if at < len(words) or last else None


def _block(words: list[str], layout: Layout, first: int, path: Path) -> dict[str, Array]:
    """Each bone's values in whole frames, the first of which bears the number ``first``."""
    spans, width = layout
    _check_numbering(words[::width], first, path)
    columns: dict[str, Array] = {}
    for name, (low, high) in spans.items():
        _check_names(words[low - 1 :: width], name, first, path)
        columns[name] = np.stack([_column(words[k::width], first, path) for k in range(low, high)], axis=1)
    return columns


def _check_numbering(words: list[str], start: int, path: Path) -> None:
    """Frame numbers count upwards by one."""
    for number, word in enumerate(words, start):
        if word != str(number):
            raise FormatError(f"{path}: {word[:40]!r} found where frame {number} should start; is one missing?")


def _check_names(words: list[str], name: str, first: int, path: Path) -> None:
    if words.count(name) != len(words):
        bad = next(n for n, word in enumerate(words) if word != name)
        raise FormatError(f"{path}: frame {first + bad} has {words[bad][:40]!r} where {name!r} is expected")


def _column(words: list[str], first: int, path: Path) -> Array:
    try:
        values = np.array(words, np.float64)
    except ValueError:
        values = np.array([np.nan])
    if not (np.abs(values) < _LARGEST_VALUE).all():
        bad = next(n for n, word in enumerate(words) if not _is_number(word))
        raise FormatError(f"{path}: frame {first + bad} has {words[bad][:40]!r} where a number is expected")
    return values


def _is_number(word: str) -> bool:
    try:
        return abs(float(word)) < _LARGEST_VALUE
    except ValueError:
        return False
