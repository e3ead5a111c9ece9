"""Where the points of a C3D file lie: what header and parameters say of it, and the file's size that decides.

A file says most things twice: in its header of 256 words and in its parameters. Where they disagree, or the header's
words are too short (65,535 frames), the combination counts that ends where the file ends (within the 512 bytes to
which files are padded); else parameters go before the header.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from onbeat.errors import FormatError
from onbeat.formats.c3d.parameters import Parameters

BLOCK = 512
FULL = 65535
"""The most that a word can say."""


@dataclass(frozen=True)
class Layout:
    """Frames of ``points`` × (x, y, z, residual) and analog samples, from byte ``start`` on."""

    start: int
    points: int
    analog: int
    """Analog values in a frame of points: channels × samples."""
    frames: int
    """As promised; see :meth:`whole` for what is there."""
    scale: float
    """Units in a step of an integer; negative where the points are floats."""

    @property
    def is_float(self) -> bool:
        """Whether points are floats in the file's unit, not integers to be scaled."""
        return self.scale < 0

    @property
    def frame_bytes(self) -> int:
        """Bytes from one frame to the next."""
        return (4 * self.points + self.analog) * (4 if self.is_float else 2)

    def whole(self, size: int) -> int:
        """How many whole frames a file of ``size`` bytes holds."""
        return max(0, size - self.start) // max(self.frame_bytes, 1)

    def ends_with(self, size: int) -> bool:
        """Whether the frames end in the last block of a file of ``size`` bytes."""
        return 0 <= size - self.start - self.frames * self.frame_bytes < BLOCK


def find_layout(header: bytes, parameters: Parameters, size: int, path: Path) -> Layout:
    """The layout that header and parameters describe and a file of ``size`` bytes can hold.

    Raises
    ------
    FormatError
        If there are no points, no frames, no scale, or no place where they could be.
    """
    words = [0, *parameters.numbers.words(header[:20]).tolist()]  # counted from 1, as everybody counts them
    points = _choices(parameters.number("POINT:USED"), words[2])
    analog = _analog(parameters, words)
    if not points:
        held = f"holds {max(analog)} analog values a frame and" if max(analog) else "holds"
        raise FormatError(f"{path} {held} no points; a C3D file of markers is expected")
    scales = _scales(parameters, header, path)
    starts = [(block - 1) * BLOCK for block in _choices(parameters.number("POINT:DATA_START"), words[9]) if block > 1]
    starts = [start for start in starts if start < size] or starts
    if not starts:
        raise FormatError(f"{path}: neither its header nor POINT:DATA_START says where the points are")
    frames = _frames(parameters, words)
    if not frames:
        raise FormatError(f"{path} has no frames: its header says {words[4]} to {words[5]}")
    choices = [Layout(*each) for each in itertools.product(starts, points, analog, frames, scales)]
    best = next((layout for layout in choices if layout.ends_with(size)), choices[0])
    # A counter that is full says nothing more; what lies there does.
    return replace(best, frames=best.whole(size)) if best.frames == FULL < best.whole(size) else best


def _choices(*said: float | None) -> list[int]:
    """Whole positive numbers, each once, the most trusted first."""
    return list(dict.fromkeys(int(value) for value in said if value is not None and 1 <= value < 2**31))


def _analog(parameters: Parameters, words: list[int]) -> list[int]:
    """Analog values in a frame: the header's word, then channels × the samples of each."""
    used, rate = parameters.number("ANALOG:USED") or 0.0, parameters.number("ANALOG:RATE")
    points_rate = parameters.number("POINT:RATE")
    samples = [words[10], round(min(rate / points_rate, 1e6)) if rate and points_rate and rate > 0 < points_rate else 0]
    return [words[3], *(n for s in samples if (n := int(used) * s) != words[3])]


def _scales(parameters: Parameters, header: bytes, path: Path) -> list[float]:
    said = [parameters.number("POINT:SCALE"), float(parameters.numbers.floats(header[12:16])[0])]
    good = [value for value in said if value is not None and np.isfinite(value) and value != 0]
    if not good:
        raise FormatError(f"{path}: neither its header nor POINT:SCALE says the scale of its points ({said} found)")
    return list(dict.fromkeys(good))


def _frames(parameters: Parameters, words: list[int]) -> list[int]:
    """How many frames there might be: by Vicon's double words, Qualisys' own parameter, the usual one, the header.

    What most of them say comes first; a full counter is passed over where another goes on.
    """
    first, last = (_long_word(parameters, f"TRIAL:ACTUAL_{end}_FIELD") for end in ("START", "END"))
    trial = last - first + 1 if first is not None and last is not None else None
    said = [trial, parameters.number("POINT:LONG_FRAMES"), parameters.number("POINT:FRAMES"), words[5] - words[4] + 1]
    choices = _choices(*said)
    if max(choices, default=0) > FULL:
        return [value for value in choices if value != FULL]
    return sorted(choices, key=lambda value: -sum(other is not None and int(other) == value for other in said))


def _long_word(parameters: Parameters, name: str) -> float | None:
    """A number in two words, the low one first."""
    values = parameters.numbers_of(name)
    if len(values) == 2 and parameters.found[name].type == 2:
        return values[0] + values[1] * 65536
    return parameters.number(name)
