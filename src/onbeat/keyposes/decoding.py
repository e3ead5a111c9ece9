"""Reading JSON documents of a version: ``decoded``, which documents of keyposes, dances and results share."""

from __future__ import annotations

from typing import TypeVar

import msgspec

from onbeat.errors import MetricError, OnbeatError

T = TypeVar("T")


class _Version(msgspec.Struct):
    version: int


def decoded(
    data: bytes, type_: type[T], version: int, source: str, what: str, error: type[OnbeatError] = MetricError
) -> T:
    """The document in some bytes; an ``error`` says what is wrong with them: first the version, then the rest.

    Examples
    --------
    >>> decoded(b'{"version": 2}', dict, 2, "x.json", "a document of keyposes")
    {'version': 2}
    >>> decoded(b'{"version"}', dict, 2, "x.json", "a document of keyposes")
    Traceback (most recent call last):
    onbeat.errors.MetricError: x.json is not a document of keyposes: JSON is malformed: expected ':' (byte 10)
    """
    try:
        found = msgspec.json.decode(data, type=_Version).version
        if found != version:
            raise error(f"{source}: version {found}; this onbeat reads version {version}")
        return msgspec.json.decode(data, type=type_)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as problem:
        raise error(f"{source} is not {what}: {problem}") from None
