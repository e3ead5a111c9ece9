"""Reading text files of any size in pieces of bounded memory, and in whatever encoding they came."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import msgspec
import numpy as np

from onbeat._shapes import Array
from onbeat.errors import FormatError

CHUNK = 1 << 17
"""Bytes read at once: small enough for the numbers in it to stay in the processor's cache."""
BLANK = 1 << 26
"""Bytes of white space in a row that no real file has."""
LONGEST_WORD = 1 << 16
"""Bytes of the longest word there may be."""
_COMMAS = bytes.maketrans(b" \t\n\r", b",,,,")
_PLAIN = msgspec.json.Decoder(list[float])
_NUMBER = re.compile(r"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|nan|inf|infinity)", re.ASCII | re.IGNORECASE)
_ENDS = (b" ", b"\n", b"\t", b"\r")
_AFTER_THE_END = b" \t\r\n\x00\x1a"
"""What may follow the last word: old programs end a text with Ctrl-Z, interrupted ones with zeros."""


def open_text(path: Path) -> BinaryIO:
    """The file opened for reading bytes; a ``FormatError`` says why it cannot be."""
    try:
        return path.open("rb")
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None


def decoded(data: bytes) -> str:
    """Text of UTF-8 or UTF-16 (with a mark), else Latin-1, which loses nothing; all line ends become newlines.

    Examples
    --------
    >>> decoded("Ä".encode("utf-16")), decoded("Ä".encode("latin-1"))
    ('Ä', 'Ä')
    """
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def small_text(path: Path, limit: int, what: str) -> str:
    """The whole text of a file that is small by its nature; ``FormatError`` where it is larger than ``limit`` bytes."""
    with open_text(path) as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise FormatError(f"{path}: more than {limit >> 20} MB found; {what} is expected")
    return decoded(data)


def pieces(file: BinaryIO, label: str, rest: bytes = b"") -> Iterator[bytes]:
    """What is left of a file after ``rest``, about :data:`CHUNK` bytes of whole words at a time.

    Raises
    ------
    FormatError
        Where there is white space without end, or a word without end: it is no text of numbers.
    """
    blank, data, rest = 0, rest or file.read(CHUNK), b""
    while data:
        if data.isspace():
            blank += len(data)
            if blank > BLANK:
                raise FormatError(f"{label}: more than {BLANK >> 20} MB of white space in a row; it holds no motion")
            data = b"\n" * data.count(b"\n") or b" "
        else:
            blank = 0
        cut = max(data.rfind(end) for end in _ENDS) + 1
        if cut:
            yield rest + data[:cut]
            rest = data[cut:]
        else:
            rest += data
        if len(rest) > LONGEST_WORD:
            raise FormatError(f"{label}: a word of more than {LONGEST_WORD} letters found ({rest[:20]!r}…)")
        data = file.read(CHUNK)
    if rest := rest.rstrip(_AFTER_THE_END):
        yield rest


def numbers(piece: bytes, line: int, label: str) -> Array:
    """The numbers in a piece of text that begins on a line; ``FormatError`` names the line of what is none.

    What has single spaces is a list of JSON but for its commas, whose parser is nearly twice as fast as NumPy's.

    Examples
    --------
    >>> numbers(b"1.0 -2e3  3", 1, "a.txt").tolist()
    [1.0, -2000.0, 3.0]
    """
    words = piece.strip().replace(b" \n", b"\n").replace(b"\r\n", b"\n")
    if not words:  # NumPy reads one number from nothing
        return np.zeros(0)
    if b"," in words:
        raise _bad_number(decoded(piece), line, label)
    try:
        return np.array(_PLAIN.decode(b"[" + words.translate(_COMMAS) + b"]"), np.float64)
    except msgspec.DecodeError:
        pass
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(words, dtype=np.float64, sep=" ")  # pyright: ignore[reportArgumentType]
        except (DeprecationWarning, ValueError):
            raise _bad_number(decoded(piece), line, label) from None


def _bad_number(text: str, line: int, label: str) -> FormatError:
    for number, row in enumerate(text.split("\n"), line):
        for word in row.split():
            if not _NUMBER.fullmatch(word):
                hint = "; write decimals with a point" if word.count(",") == 1 else ""
                return FormatError(f"{label}:{number}: a number is expected, {word[:40]!r} found{hint}")
    return FormatError(f"{label}: the motion after line {line} is not all numbers")
