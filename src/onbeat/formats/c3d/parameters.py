"""The parameter section of a C3D file: groups of named values.

A record is: length of its name (negative where it is locked), the number of its group (negative where the record
*is* the group), name, and the distance from there to the next record, 0 in the last; a parameter then has its type
(−1 characters, 1 bytes, 2 words, 4 floats), the number of its dimensions, the dimensions, first the fastest, the values
and a description. Records are found by the distances alone, so a description that is missing or too long (OptiTrack
writes none after ``POINT:LABELS``) harms nobody; a parameter whose dimensions promise more than its record holds is
left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from onbeat.formats.c3d.numbers import Numbers

_SIZES = {-1: 1, 1: 1, 2: 2, 4: 4}
"""Bytes of one value, by the type of the parameter; negative is text."""


@dataclass(frozen=True)
class Parameter:
    """One parameter: its type, its dimensions (the first runs fastest) and the bytes of its values."""

    type: int
    dimensions: tuple[int, ...]
    data: bytes


@dataclass(frozen=True)
class Parameters:
    """All parameters of a file by ``GROUP:NAME``, in capitals."""

    numbers: Numbers
    found: dict[str, Parameter] = field(default_factory=dict[str, Parameter])
    damaged: tuple[str, ...] = ()
    """Parameters whose values are not whole, and are not in ``found``."""

    def numbers_of(self, name: str) -> list[float]:
        """The values of a numeric parameter, words without sign; nothing where there is none."""
        parameter = self.found.get(name)
        if parameter is None or parameter.type < 0:
            return []
        if parameter.type == 4:
            return self.numbers.floats(parameter.data).tolist()
        values = list(parameter.data) if parameter.type == 1 else self.numbers.words(parameter.data).tolist()
        return [float(value) for value in values]

    def number(self, name: str) -> float | None:
        """The first value of a numeric parameter; None where there is none or it is not finite."""
        values = self.numbers_of(name)
        return values[0] if values and math.isfinite(values[0]) else None

    def texts(self, name: str) -> list[str]:
        """The strings of a text parameter, trimmed; nothing where there is none."""
        parameter = self.found.get(name)
        if parameter is None or parameter.type >= 0 or not parameter.data:
            return []
        width = parameter.dimensions[0] if parameter.dimensions else 1
        return [_text(parameter.data[at : at + width]) for at in range(0, len(parameter.data), width)]

    def text(self, name: str) -> str:
        """The first string of a text parameter, or nothing."""
        return next(iter(self.texts(name)), "")

    def all_texts(self, name: str) -> list[str]:
        """The strings of ``NAME``, ``NAME2``, ``NAME3``, …: one parameter has room for 255."""
        found, number = self.texts(name), 2
        while more := self.texts(f"{name}{number}"):
            found, number = found + more, number + 1
        return found


def _text(data: bytes) -> str:
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return "".join(c if c.isprintable() else " " for c in text).strip()


def parse_parameters(section: bytes, numbers: Numbers) -> Parameters:
    r"""The parameters of a section, whose records begin at its fifth byte; it never fails on damage.

    Examples
    --------
    >>> from onbeat.formats.c3d.numbers import NUMBERS
    >>> group, used = b"POINT" + b"\3\0" + b"\0", b"USED" + b"\0\0" + b"\2\0" + b"\7\0" + b"\0"
    >>> section = b"\1\x50\1\x54" + b"\5\xff" + group + b"\4\1" + used
    >>> parse_parameters(section, NUMBERS[84]).number("POINT:USED")
    7.0
    """
    groups: dict[int, str] = {}
    kept: list[tuple[int, str, Parameter | None]] = []
    for group, name, record in _records(section, numbers):
        if group < 0:
            groups.setdefault(-group, name)
        else:
            kept.append((group, name, _parameter(record)))
    found: dict[str, Parameter] = {}
    damaged: list[str] = []
    # A parameter may stand before its group, so they meet only here.
    for group, name, parameter in kept:
        full = f"{groups.get(group, group)}:{name}"
        if parameter is None:
            damaged.append(full)
        else:
            found.setdefault(full, parameter)
    return Parameters(numbers, found, tuple(damaged))


def _records(section: bytes, numbers: Numbers) -> Iterator[tuple[int, str, bytes]]:
    """Group, name and the rest of each record."""
    at = 4
    while at + 4 < len(section) and section[at]:
        length = abs(int.from_bytes(section[at : at + 1], signed=True))
        group = int.from_bytes(section[at + 1 : at + 2], signed=True)
        here = at + 2 + length
        if not length or not group or here + 2 > len(section):
            return
        step = int(numbers.words(section[here : here + 2])[0])
        end = here + step if step else len(section)
        yield group, _text(section[at + 2 : here]).upper(), section[here + 2 : end]
        if step < 2:
            return
        at = end


def _parameter(record: bytes) -> Parameter | None:
    """What a record holds; None where its values are not all there or of no known type."""
    if len(record) < 2:
        return None
    kind, count = int.from_bytes(record[:1], signed=True), record[1]
    dimensions = tuple(record[2 : 2 + count])
    size = _SIZES.get(kind, 0) * math.prod(dimensions)
    data = record[2 + count : 2 + count + size]
    if kind not in _SIZES or len(dimensions) < count or len(data) < size:
        return None
    return Parameter(kind, dimensions, data)
