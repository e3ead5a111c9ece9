"""What the few names that a pickle of NumPy arrays uses stand for, without looking any of them up.

A pickle says "call ``numpy.core.multiarray._reconstruct``, then set this state". Here such a name is only a word out of
:data:`KNOWN`, and what it would have made is made by this file: plain item types and arrays over the pickle's own
bytes. No name is ever imported or called. The forms are those of NumPy 1 and 2 with protocols 0 to 5.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from onbeat.formats.named.arrays import has_text_of, plain_dtype, shape_size

KNOWN: Mapping[str, str] = {
    "numpy ndarray": "ndarray",
    "numpy dtype": "dtype",
    "_codecs encode": "encode",
    "__builtin__ bytes": "bytes",
    "builtins bytes": "bytes",
    **{
        f"numpy.{core}.{name}": meaning
        for core in ("core", "_core")
        for name, meaning in (
            ("multiarray _reconstruct", "reconstruct"),
            ("multiarray scalar", "scalar"),
            ("numeric _frombuffer", "frombuffer"),
        )
    },
}
"""The names (module, space, name) that are understood, and what each means."""


class Refusal(Exception):
    """Something in a pickle that is not understood; the message tells what."""


@dataclass(frozen=True)
class Name:
    """One of the meanings of :data:`KNOWN`, as a pickle names it."""

    meaning: str


@dataclass
class ItemType:
    """An item type: NumPy's short text (``f8``) and its byte order, which comes later."""

    text: str
    order: str = "<"

    def dtype(self) -> np.dtype[Any]:
        """As NumPy's; a ``Refusal`` where it is not plain."""
        dtype = plain_dtype(("|" if self.text[:1] in "bS" else self.order) + self.text)
        if dtype is None:
            found = "Python objects" if self.text.startswith("O") else f"items of type {self.text[:20]!a}"
            raise Refusal(f"it holds an array of {found}; only numbers and text are read")
        return dtype


@dataclass
class Pending:
    """An array that is there before its content is."""

    array: NDArray[Any] | None = None


def called(name: object, arguments: object) -> object:
    """What calling ``name`` with ``arguments`` stands for."""
    if not isinstance(name, Name) or not isinstance(arguments, tuple):
        raise Refusal("it calls something that is no known name")
    given = cast("tuple[object, ...]", arguments)
    if name.meaning == "reconstruct" and len(given) == 3 and given[0] == Name("ndarray"):
        return Pending()
    if name.meaning == "dtype" and given and isinstance(given[0], str):
        return ItemType(given[0])
    if name.meaning == "scalar" and len(given) == 2:
        return Pending(_array(given[1], given[0], (), "C"))
    if name.meaning == "frombuffer" and len(given) == 4:
        return Pending(_array(*given))
    if name.meaning == "encode" and len(given) == 2 and isinstance(given[0], str) and given[1] in ("latin1", "latin-1"):
        return given[0].encode("latin-1")
    if name.meaning == "bytes" and not given:
        return b""
    raise Refusal(f"it calls numpy's {name.meaning} in a way that is not known")


def set_state(target: object, state: object) -> None:
    """Give an array or an item type the state that the pickle has for it."""
    given = cast("tuple[object, ...]", state) if isinstance(state, tuple) else ()
    if isinstance(target, ItemType) and len(given) >= 5 and given[1] in ("<", ">", "|", "="):
        if any(part is not None for part in given[2:5]):
            raise Refusal("it holds an array of structures; only numbers and text are read")
        target.order = ">" if given[1] == ">" else "<"
    elif isinstance(target, Pending) and len(given) == 5:
        target.array = _array(given[4], given[2], given[1], "F" if given[3] else "C")
    else:
        raise Refusal("it sets the state of something that is no array")


def _array(raw: object, item: object, shape: object, order: object) -> NDArray[Any]:
    """A read-only array over the bytes themselves; Python 2 wrote them as text."""
    if not isinstance(item, ItemType) or not isinstance(shape, tuple) or order not in ("C", "F"):
        raise Refusal("it has an array without item type, shape or order")
    dtype, raw = item.dtype(), raw.encode("latin-1") if isinstance(raw, str) else raw
    if not isinstance(raw, bytes | bytearray):
        raise Refusal("it has an array whose content is no bytes")
    sizes = tuple(n for n in cast("tuple[object, ...]", shape) if isinstance(n, int))
    count = shape_size(sizes)
    if len(sizes) < len(cast("tuple[object, ...]", shape)) or count is None or count * dtype.itemsize != len(raw):
        raise Refusal(f"an array of type {dtype} does not have as many bytes as its shape needs, but {len(raw)}")
    flat = np.frombuffer(raw, dtype) if raw else np.zeros(0, dtype)
    array = flat.reshape(sizes, order=cast("Any", order))
    if not has_text_of(array):
        raise Refusal("it has text with characters that do not exist")
    array.setflags(write=False)
    return array
