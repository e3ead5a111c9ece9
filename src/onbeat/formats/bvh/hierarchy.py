"""The HIERARCHY of a BVH file: joints, offsets and channels, read word by word."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from onbeat.errors import FormatError
from onbeat.formats.notes import tell

MOST_JOINTS = 10_000
LONGEST_NAME = 1000
_CHANNEL = re.compile(r"([xyz])_?(position|rotation|translation)", re.IGNORECASE)


@dataclass
class Joint:
    """A joint or End Site: its parent's number (-1 for the root), OFFSET and channels, in the file's unit."""

    name: str
    parent: int
    line: int
    end: bool = False
    offset: list[float] | None = None
    channels: list[tuple[int, bool, int]] = field(default_factory=list[tuple[int, bool, int]])
    """(axis, whether it is a rotation, column)."""


def read_hierarchy(text: str, label: str) -> list[Joint]:
    """The joints of the text above MOTION, parents first.

    Raises
    ------
    FormatError
        If it is not one tree of ROOT, JOINT and End Site; file and line are named.
    """
    return _Hierarchy(text, label).joints


def whole_number(word: str, where: str, what: str) -> int:
    """A count of at most 15 digits."""
    if not re.fullmatch(r"\d{1,15}", word, re.ASCII):
        raise FormatError(f"{where}: a whole number of {what} is expected, {word[:40]!r} found")
    return int(word)


def _words(text: str) -> Iterator[tuple[str, int]]:
    """The words with their lines; braces are words of their own."""
    for number, line in enumerate(text.split("\n"), 1):
        spaced = line.replace("{", " { ").replace("}", " } ") if "{" in line or "}" in line else line
        for word in spaced.split():
            yield word, number


class _Hierarchy:
    def __init__(self, text: str, label: str) -> None:
        self.words, self.label, self.columns, self.line = _words(text), label, 0, 1
        self.joints: list[Joint] = []
        self.names: set[str] = set()
        self.stack: list[int] = []
        if next(self.words, ("", 1))[0].upper() != "HIERARCHY":
            raise FormatError(f"{label}:1: HIERARCHY is expected at the start of a BVH file")
        for word, line in self.words:
            self.line = line
            self._statement(word, line)
        if self.stack:
            joint = self.joints[self.stack[-1]]
            raise FormatError(f"{label}: the braces of joint {joint.name!r} (line {joint.line}) are not closed")
        if not self.joints:
            raise FormatError(f"{label}: the HIERARCHY has no ROOT")

    def _next(self) -> tuple[str, int]:
        found = next(self.words, None)
        if found is None:
            raise FormatError(f"{self.label}:{self.line}: the HIERARCHY ends too soon")
        return found

    def _statement(self, word: str, line: int) -> None:
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
        if len(self.joints) == MOST_JOINTS:
            raise FormatError(f"{self.label}:{line}: more than {MOST_JOINTS} joints; a body has fewer")
        name = f"{self.joints[parent].name}_end" if kind == "END" else " ".join(words)
        self.stack.append(len(self.joints))
        self.joints.append(Joint(self._free(name, kind, line), parent, line, kind == "END"))

    def _free(self, name: str, kind: str, line: int) -> str:
        """The name, or the next free one of its kind: files do name two joints alike, the tree tells them apart."""
        if not 0 < len(name) <= LONGEST_NAME:
            raise FormatError(
                f"{self.label}:{line}: {kind} has a name of {len(name)} letters; 1 to {LONGEST_NAME} are possible"
            )
        free, number = name, 2
        while free in self.names:
            free, number = f"{name}{number}" if kind == "END" else f"{name}_{number}", number + 1
        self.names.add(free)
        if free != name and kind != "END":
            tell("names", free, f"line {line} names another joint {name!r}")
        return free

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
        if not abs(value) < 1e9:
            hint = "; write decimals with a point" if re.fullmatch(r"-?\d+,\d+", word) else ""
            hint = "; no body is so large" if abs(value) >= 1e9 else hint
            raise FormatError(f"{self.label}:{line}: a number is expected, {word[:40]!r} found{hint}")
        return value

    def _channels(self, joint: Joint) -> None:
        word, line = self._next()
        count = whole_number(word, f"{self.label}:{line}", "channels")
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
            if len(joint.channels) > 12:
                raise FormatError(f"{self.label}:{line}: joint {joint.name!r} has more than 12 channels")
