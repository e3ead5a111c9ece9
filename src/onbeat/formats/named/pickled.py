"""Dictionaries of arrays out of Python pickles (AIST++, GMR and their like) without ever unpickling.

A pickle is a program: Python's own reader imports and calls whatever it names. Here ``pickletools.genops`` only lists
the instructions, and a small machine of our own follows those that make dictionaries, lists, tuples, texts and numbers.
Names are looked up in a table of words (:mod:`onbeat.formats.named.pickled_numpy`), never in Python; whatever else is
named is refused, and so are objects, extension codes and things kept outside the file.

The work is bounded: 256 MB of file, 300,000 instructions, nothing that is larger than the file, nesting to 8.
"""

from __future__ import annotations

import os
import pickletools
import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np
from numpy.typing import NDArray

from onbeat.errors import FormatError
from onbeat.formats.named.pickled_numpy import KNOWN, Name, Pending, Refusal, called, set_state

MAX_FILE, MAX_STEPS, MAX_LINE, MAX_KEYS, MAX_DEPTH, MAX_TEXT = 256_000_000, 300_000, 16_000_000, 10_000, 8, 10_000
RECIPE = (
    "nothing was executed. If you trust the file, load it where it was made and save its arrays: "
    "np.savez('motion.npz', **{key: np.asarray(value) for key, value in data.items()})"
)


def load_pickled_arrays(path: str | Path) -> dict[str, NDArray[Any]]:
    """The arrays, numbers and texts of a pickled dictionary by their keys; nothing in the file is ever executed.

    Numbers and texts are arrays without axes; lists of numbers or of texts are arrays. What is none of these (None,
    dictionaries in it, ragged lists) is left out. A dictionary that holds nothing but one other is taken for that one.

    Raises
    ------
    FormatError
        If the file is damaged or too large, or needs anything but plain arrays; it says what was named.
    """
    path = Path(path)
    try:
        with path.open("rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of backslashes in the texts of a damaged file
            found = _followed(file)
    except OSError as error:
        raise FormatError(f"cannot read {path}: {error.strerror or error}") from None
    except Refusal as refusal:
        raise FormatError(f"{path} is not read: {refusal}; {RECIPE}") from None
    except (ValueError, IndexError, KeyError, TypeError, OverflowError, struct.error, RecursionError) as error:
        raise FormatError(f"{path} is not a whole pickle: {str(error)[:100]!a}") from None
    if not isinstance(found, dict):
        raise FormatError(f"{path} holds a {type(found).__name__}; a dictionary of arrays is expected")
    return _arrays(cast("dict[str, object]", found), path)


def _followed(file: BinaryIO) -> object:
    """What the program makes."""
    window = _Window(file, os.fstat(file.fileno()).st_size)
    machine = _Machine(window.size)
    for step, (opcode, argument, _) in enumerate(pickletools.genops(cast("Any", window))):
        if step >= MAX_STEPS:
            raise Refusal(f"it has more than {MAX_STEPS:,} instructions; arrays need a few")
        machine.follow(opcode.name, argument)
    if window.tell() < window.size:
        raise Refusal(f"{window.size - window.tell():,} bytes follow the end of the first pickle; one is expected")
    return machine.stack[-1]


class _Window:
    """A file of which no more can be asked than it holds, so that a promise of gigabytes allocates nothing."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        start = file.read(4)
        file.seek(0)
        packed = {b"\x1f\x8b": "gzip", b"PK\x03": "a zip (PyTorch?)", b"BZh": "bzip2", b"\xfd7z": "xz", b"\x78": "zlib"}
        for magic, name in packed.items():
            if start.startswith(magic):
                raise Refusal(f"it is packed by {name}, not a plain pickle")
        if size > MAX_FILE:
            raise Refusal(f"it is of {size:,} bytes; at most {MAX_FILE:,} are read of a pickle")
        self.file, self.size, self.tell = file, size, file.tell

    def read(self, count: int) -> bytes:
        return self.file.read(max(0, min(count, self.size - self.tell())))

    def readline(self) -> bytes:
        return self.file.readline(MAX_LINE)


class _Machine:
    """The stack, the marks on it and the memo of a pickle's program, whose values are all our own."""

    def __init__(self, size: int) -> None:
        self.stack: list[object] = []
        self.below: list[list[object]] = []
        self.memo: dict[int, object] = {}
        self.encoded, self.keys = size + 1000, 0

    def follow(self, name: str, argument: Any) -> None:
        """Follow one instruction."""
        if name in _VALUES:
            self.stack.append(_value(argument))
        elif name in _CONSTANTS:
            self.stack.append(_CONSTANTS[name])
        elif name in _STEPS:
            _STEPS[name](self, argument)
        elif name not in ("PROTO", "FRAME", "STOP"):
            raise Refusal(f"it uses the instruction {name}, which plain arrays do not need")

    def mark(self, _: Any) -> None:
        self.below.append(self.stack)
        self.stack = []

    def push(self, value: object) -> None:
        self.stack.append(value)

    def since_mark(self) -> list[object]:
        items, self.stack = self.stack, self.below.pop()
        return items

    def top(self, count: int) -> tuple[object, ...]:
        if len(self.stack) < count:
            raise IndexError("it takes more than there is")
        items = self.stack[len(self.stack) - count :]
        del self.stack[len(self.stack) - count :]
        return tuple(items)

    def put(self, index: Any) -> None:
        self.memo[len(self.memo) if index is None else _small(int(index))] = self.stack[-1]

    def extend(self, items: list[object]) -> None:
        kept = self.stack[-1]
        if not isinstance(kept, list):
            raise Refusal("it appends to something that is no list")
        cast("list[object]", kept).extend(items)

    def set_items(self, items: list[object]) -> None:
        kept = self.stack[-1]
        if not isinstance(kept, dict) or len(items) % 2:
            raise Refusal("it sets items of something that is no dictionary")
        self.keys += len(items) // 2
        if self.keys > MAX_KEYS:
            raise Refusal(f"its dictionaries have more than {MAX_KEYS:,} keys")
        for key, value in zip(items[::2], items[1::2], strict=True):
            if not isinstance(key, str | int):
                raise Refusal(f"it has a {type(key).__name__} as a key; texts are expected")
            cast("dict[object, object]", kept)[key] = value

    def name(self, full: str) -> None:
        if full not in KNOWN:
            shown = full.replace(" ", ".", 1)[:100].encode("ascii", "backslashreplace").decode()
            raise Refusal(f"it asks for {shown}, which is no part of a plain array")
        self.stack.append(Name(KNOWN[full]))

    def stack_name(self) -> None:
        module, name = self.top(2)
        self.name(f"{module} {name}" if isinstance(module, str) and isinstance(name, str) else "?")

    def reduce(self) -> None:
        name, arguments = self.top(2)
        made = called(name, arguments)
        # One text may be encoded again and again: all that is made so is no more than the file.
        self.encoded -= len(made) if isinstance(made, bytes) else 0
        if self.encoded < 0:
            raise Refusal("it makes more bytes than it has")
        self.stack.append(made)

    def build(self) -> None:
        (state,) = self.top(1)
        set_state(self.stack[-1], state)


def _small(index: int) -> int:
    if not 0 <= index < 2**31:
        raise Refusal("it keeps things under numbers that are too large")
    return index


def _value(argument: Any) -> object:
    if isinstance(argument, int) and not -(2**63) <= argument < 2**64:
        raise Refusal("it has a whole number of more than 64 bits")
    return argument


def _pairs(machine: _Machine) -> None:
    items = machine.since_mark()
    machine.stack.append({})
    machine.set_items(items)


_VALUES = {
    *("INT", "BININT", "BININT1", "BININT2", "LONG", "LONG1", "LONG4", "FLOAT", "BINFLOAT"),
    *("STRING", "BINSTRING", "SHORT_BINSTRING", "UNICODE", "BINUNICODE", "SHORT_BINUNICODE", "BINUNICODE8"),
    *("BINBYTES", "SHORT_BINBYTES", "BINBYTES8", "BYTEARRAY8"),
}
_CONSTANTS: dict[str, object] = {"NONE": None, "NEWTRUE": True, "NEWFALSE": False, "EMPTY_TUPLE": ()}
_STEPS: dict[str, Callable[[_Machine, Any], object]] = {
    "MARK": _Machine.mark,
    "POP": lambda m, _: m.top(1) if m.stack else m.since_mark(),
    "POP_MARK": lambda m, _: m.since_mark(),
    "DUP": lambda m, _: m.push(m.stack[-1]),
    "EMPTY_LIST": lambda m, _: m.push([]),
    "EMPTY_DICT": lambda m, _: m.push({}),
    "LIST": lambda m, _: m.push(m.since_mark()),
    "TUPLE": lambda m, _: m.push(tuple(m.since_mark())),
    "TUPLE1": lambda m, _: m.push(m.top(1)),
    "TUPLE2": lambda m, _: m.push(m.top(2)),
    "TUPLE3": lambda m, _: m.push(m.top(3)),
    "DICT": lambda m, _: _pairs(m),
    "APPEND": lambda m, _: m.extend(list(m.top(1))),
    "APPENDS": lambda m, _: m.extend(m.since_mark()),
    "SETITEM": lambda m, _: m.set_items(list(m.top(2))),
    "SETITEMS": lambda m, _: m.set_items(m.since_mark()),
    "PUT": _Machine.put,
    "BINPUT": _Machine.put,
    "LONG_BINPUT": _Machine.put,
    "MEMOIZE": _Machine.put,
    "GET": lambda m, index: m.push(m.memo[int(index)]),
    "BINGET": lambda m, index: m.push(m.memo[index]),
    "LONG_BINGET": lambda m, index: m.push(m.memo[index]),
    "GLOBAL": _Machine.name,
    "STACK_GLOBAL": lambda m, _: m.stack_name(),
    "REDUCE": lambda m, _: m.reduce(),
    "BUILD": lambda m, _: m.build(),
}


def _arrays(found: dict[str, object], path: Path) -> dict[str, NDArray[Any]]:
    """What a dictionary holds as arrays; lists are copied, so all of them together have a bound of their own."""
    inner = next(iter(found.values())) if len(found) == 1 else None
    if isinstance(inner, dict):
        found = cast("dict[str, object]", inner)
    elif found and all(isinstance(value, dict) for value in found.values()):
        names = ", ".join(ascii(key) for key in list(found)[:5])
        raise FormatError(f"{path} holds {len(found)} motions ({names}, …); save each as a file of its own")
    left = [MAX_STEPS]
    arrays = {str(key): _array(value, left) for key, value in found.items()}
    return {key: array for key, array in arrays.items() if array is not None}


def _array(value: object, left: list[int]) -> NDArray[Any] | None:
    if isinstance(value, Pending):
        return value.array
    if isinstance(value, bool | int | float) or (isinstance(value, str) and len(value) <= MAX_TEXT):
        return np.array(value)
    if not isinstance(value, list | tuple):
        return None
    return _listed(cast("list[object] | tuple[object, ...]", value), left)


def _listed(values: list[object] | tuple[object, ...], left: list[int]) -> NDArray[Any] | None:
    """A list of numbers, of lists of them, or of short texts; None where it is none or ragged."""
    if all(isinstance(v, str) and len(v) <= 200 for v in values) and 0 < len(values) <= MAX_KEYS:
        return np.array(values)
    plain = _plain(values, left, 0)
    try:
        return None if plain is None else np.array(plain, np.float64)
    except (ValueError, OverflowError):
        return None


def _plain(value: object, left: list[int], depth: int) -> object:
    """Numbers in lists as they are. Every visit counts: one list may stand in a million places."""
    left[0] -= 1
    if depth > MAX_DEPTH or left[0] < 0:
        raise FormatError(f"lists in a pickle are nested deeper than {MAX_DEPTH} or too long; {RECIPE}")
    if isinstance(value, bool | int | float):
        return float(value)
    if isinstance(value, Pending) and value.array is not None and value.array.dtype.kind in "biuf":
        left[0] -= value.array.size
        return cast("object", value.array.astype(np.float64)) if left[0] >= 0 else None
    if not isinstance(value, list | tuple):
        return None
    parts = [_plain(v, left, depth + 1) for v in cast("list[object]", value)]
    return None if any(part is None for part in parts) else parts
