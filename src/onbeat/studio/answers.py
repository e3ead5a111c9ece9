"""Answers to requests: JSON, refusals in a sentence, and what was sent read as what it should be."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, TypeVar

import msgspec
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, Response

from onbeat.errors import OnbeatError
from onbeat.studio.studio import InUseError, NotHereError
from onbeat.studio.uploads import FullError, TooLargeError
from onbeat.studio.wire import ErrorData

LONGEST = 4 << 20
"""Bytes of an order: twenty thousand beats are 0.4 MB."""
STATUS = ((NotHereError, 404), (InUseError, 409), (TooLargeError, 413), (FullError, 507))
"""Of each kind of refusal its status; 422 of all others."""
_AT = re.compile(r" - at `\$\.?([^`]*)`$")
_T = TypeVar("_T")


class FieldError(OnbeatError):
    """One field of what was sent is wrong."""

    def __init__(self, field: str, text: str) -> None:
        super().__init__(text)
        self.field = field


def answer(what: Any, status: int = 200) -> Response:
    """Something as JSON."""
    return Response(msgspec.json.encode(what), status, media_type="application/json")


def file_answer(path: Path, mime: str, name: str | None = None) -> Response:
    """A file or the range of it that is asked for; with a ``name``, to be kept under it. ``OSError`` if it is gone."""
    return FileResponse(path, media_type=mime, filename=name, stat_result=path.stat())


def refusal(status: int, error: str, field: str | None = None) -> Response:
    """Why something is refused, as JSON."""
    return answer(ErrorData(error, field), status)


def refused(error: OnbeatError) -> Response:
    """The refusal that an error is."""
    status = next((status for kind, status in STATUS if isinstance(error, kind)), 422)
    return refusal(status, " ".join(str(error).split()), error.field if isinstance(error, FieldError) else None)


async def order(request: Request, kind: type[_T]) -> _T:
    """What was sent, as an order of a kind.

    Raises
    ------
    FieldError
        If it is none: which field is wrong, and how.
    TooLargeError
        If it is far too long.
    """
    body = bytearray()
    try:
        async for chunk in request.stream():
            body += chunk
            if len(body) > LONGEST:
                raise TooLargeError(f"the order is longer than {LONGEST >> 20} MB")
    except ClientDisconnect:
        raise OnbeatError("the order ended early; send it again") from None
    return read(bytes(body), kind)


def read(body: bytes, kind: Any) -> Any:
    """An order out of JSON; errors as of :func:`order`.

    Examples
    --------
    >>> from onbeat.studio.wire import RetimeOrder
    >>> read(b'{"speed": "fast"}', RetimeOrder)
    Traceback (most recent call last):
    onbeat.studio.answers.FieldError: speed: Expected `float`, got `str`
    """
    try:
        return msgspec.json.decode(body, type=kind)
    except (msgspec.DecodeError, RecursionError, UnicodeError) as error:
        text = str(error)
        at = _AT.search(text)
        field = at[1] if at else ""
        said = _AT.sub("", text)
        raise FieldError(
            field, f"{field}: {said}" if field else f"not the JSON that is expected here: {said}"
        ) from None
