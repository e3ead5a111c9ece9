"""The page's view of the contract, written as TypeScript from the Python classes.

``python -m onbeat.viewer.typescript > viewer-js/src/contract.ts`` after every change of ``contract.py``.
"""

from __future__ import annotations

import inspect
import sys
import types
from collections.abc import Sequence
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec

from onbeat.viewer import contract

_PLAIN = {int: "number", float: "number", str: "string", bool: "boolean", type(None): "null"}


def typescript_type(hint: Any) -> str:
    """The TypeScript type of a Python type hint.

    Examples
    --------
    >>> typescript_type(list[float])
    'number[]'
    """
    if hint in _PLAIN:
        return _PLAIN[hint]
    if get_origin(hint) is list:
        return f"{typescript_type(get_args(hint)[0])}[]"
    if get_origin(hint) is Literal:
        return " | ".join(f'"{word}"' for word in get_args(hint))
    if get_origin(hint) in (types.UnionType, Union):  # of a Literal and None, it is the older of the two
        return " | ".join(typescript_type(part) for part in get_args(hint))
    return hint.__name__


def declarations(
    structs: Sequence[type[msgspec.Struct]] = contract.STRUCTS,
    version: int = contract.VERSION,
    command: str = "python -m onbeat.viewer.typescript",
    sources: str = "contract.py",
) -> str:
    """Classes as TypeScript interfaces, parts before the whole; without arguments those of the contract.

    A tag by which JSON tells classes apart is a field too. ``command`` and ``sources`` are named at the top.
    """
    return (
        "\n\n".join(
            [
                f"// Written by `{command}` from {sources}. Do not edit.",
                f"export const VERSION = {version};",
                *(_interface(struct) for struct in structs),
            ]
        )
        + "\n"
    )


def _interface(struct: type[msgspec.Struct]) -> str:
    config = struct.__struct_config__
    tag = [f'  {config.tag_field}: "{config.tag}";'] if config.tag is not None else []
    fields = [f"  {name}: {typescript_type(hint)};" for name, hint in get_type_hints(struct).items()]
    first_line = (inspect.getdoc(struct) or "").splitlines()[0]
    return "\n".join([f"/** {first_line} */", f"export interface {struct.__name__} {{", *tag, *fields, "}"])


if __name__ == "__main__":
    sys.stdout.write(declarations())
