"""XML of robots' descriptions, read without the parts of XML that can harm: no document types, no entities."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from onbeat.errors import LimitError

LARGEST = 32 << 20
"""Bytes; descriptions of whole robots have some hundred thousand."""
_DEEPEST = 1000


def read_xml(path: Path, expected: str) -> Element:
    """The root element of an XML file; prefixes of names are kept as they are written.

    Raises
    ------
    LimitError
        If it cannot be read, is over 32 MB, is no XML, has a document type or is nested a thousand deep.
    """
    return parse_xml(read_bounded(path, LARGEST), str(path), expected)


def read_bounded(path: Path, most: int) -> bytes:
    """What is in a file; a ``LimitError`` where it cannot be read or has more than ``most`` bytes."""
    try:
        with path.open("rb") as file:
            data = file.read(most + 1)
    except (OSError, ValueError) as error:  # ValueError: a null in the name
        told = error.strerror if isinstance(error, OSError) else ""
        raise LimitError(f"cannot read {path}: {told or error}") from None
    if len(data) > most:
        raise LimitError(f"{path}: more than {most} bytes found; a robot's limits are in less")
    return data


def parse_xml(data: bytes, label: str, expected: str) -> Element:
    """The root element of an XML document; ``expected`` says what it should be.

    Examples
    --------
    >>> parse_xml(b'<robot name="arm"/>', "arm.urdf", "a URDF").get("name")
    'arm'
    """
    builder, depth = TreeBuilder(), 0
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > _DEEPEST:
            raise LimitError(f"{label}:{parser.CurrentLineNumber}: elements are nested over {_DEEPEST} deep")
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def document_type(*_: object) -> None:
        raise LimitError(f"{label}: a document type (DOCTYPE) found; take it out: {expected} needs none")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = document_type
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        why = f"{expat.errors.messages.get(error.code, 'not well-formed')} at line {error.lineno}"
        raise LimitError(f"{label} is no XML ({why}); {expected} is expected") from None
    except (LookupError, ValueError) as error:  # an encoding that is none
        raise LimitError(f"{label} is no XML that can be read ({str(error)[:100]}); save it as UTF-8") from None
    return builder.close()


def number(element: Element, key: str, where: str, default: float) -> float:
    """An attribute that is a number, or the default where it is not there."""
    text = element.get(key)
    return default if text is None else as_number(text, f"{where}: {key}")


def as_number(text: str, where: str) -> float:
    """A number as XML spells it; a ``LimitError`` says where it is none.

    Examples
    --------
    >>> as_number(" -1.5e-1 ", "elbow: lower")
    -0.15
    """
    try:
        value = math.nan if "_" in text else float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        hint = "; run xacro on the file first" if "${" in text else ""
        raise LimitError(f"{where}: a number is expected, {text[:40]!r} found{hint}")
    return value
