"""The page's view of the contract, written as TypeScript from the Python classes.

``python -m onbeat.viewer.typescript > viewer-js/src/contract.ts`` after every change of ``contract.py``.
"""

from __future__ import annotations

import inspect
import sys
import types
from typing import Any, get_args, get_origin, get_type_hints

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
    if isinstance(hint, types.UnionType):
        return " | ".join(typescript_type(part) for part in get_args(hint))
    return hint.__name__


def declarations() -> str:
    """All classes of the contract as TypeScript interfaces."""
    parts = [
        "// Written by `python -m onbeat.viewer.typescript` from contract.py. Do not edit.",
        f"export const VERSION = {contract.VERSION};",
    ]
    for struct in contract.STRUCTS:
        fields = [f"  {name}: {typescript_type(hint)};" for name, hint in get_type_hints(struct).items()]
        first_line = (inspect.getdoc(struct) or "").splitlines()[0]
        parts.append("\n".join([f"/** {first_line} */", f"export interface {struct.__name__} {{", *fields, "}"]))
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    sys.stdout.write(declarations())
