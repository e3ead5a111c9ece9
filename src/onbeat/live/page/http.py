"""What a browser gets by HTTP: the page and the sound; and who is let in at all.

A page of another site may make a browser speak to a server on this machine, under a name of its own that it lets point
here. So the name that was asked for has to be one of ours, and a WebSocket's origin our own page.
"""

from __future__ import annotations

import ipaddress
import re
import socket
from collections.abc import Collection
from dataclasses import dataclass, field
from http import HTTPStatus

LIVE = "/live"
"""Path of the WebSocket."""
_RANGE = re.compile(r"bytes=(\d{0,15})-(\d{0,15})")
_HOST = re.compile(r"(?:\[([0-9A-Fa-f:.]+)\]|([^:\[\]]+))(?::\d{1,5})?")
_ALWAYS = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY"}


@dataclass(frozen=True)
class Sound:
    """A sound file: its bytes and its MIME type."""

    data: bytes
    mime: str


@dataclass(frozen=True)
class Reply:
    """What is answered to a request."""

    status: HTTPStatus
    body: bytes = b""
    headers: dict[str, str] = field(default_factory=dict[str, str])


def refused(status: HTTPStatus, why: str) -> Reply:
    """A reply that says why not, in a line."""
    return Reply(status, f"{why}\n".encode(), {"Content-Type": "text/plain; charset=utf-8"} | _ALWAYS)


def welcome(host: str | None, origin: str | None, bound_to: str, origins: Collection[str] = ()) -> bool:
    """Whether who asked for ``host`` (with a port or without), from a page of ``origin``, is let in.

    Addresses cannot be made to point elsewhere as names can. Of names those of this machine are ours; of a server that
    others cannot reach, ``localhost`` alone. ``origins`` are those of others' pages that are let in too.

    Examples
    --------
    >>> welcome("localhost:8740", "http://localhost:8740", "127.0.0.1"), welcome("evil.example", None, "127.0.0.1")
    (True, False)
    >>> welcome("127.0.0.1:8740", "http://evil.example", "127.0.0.1")
    False
    """
    if host is None or not _ours(_without_port(host).lower(), bound_to):
        return False
    return origin is None or origin.lower() == f"http://{host.lower()}" or origin in origins


def answered(path: str, page: bytes, sound: Sound | None, wanted: str | None) -> Reply:
    """The reply to GET of a path; ``wanted`` is the header Range.

    Examples
    --------
    >>> answered("/sound", b"", Sound(b"abcdef", "audio/wav"), "bytes=2-3").body
    b'cd'
    >>> answered("/other", b"", None, None).status.value
    404
    """
    place = path.partition("?")[0]
    if place == "/":
        return Reply(HTTPStatus.OK, page, {"Content-Type": "text/html; charset=utf-8"} | _ALWAYS)
    if place == "/sound" and sound is not None:
        return _sounding(sound, wanted)
    return refused(HTTPStatus.NOT_FOUND, f"nothing here; the page is at /, the sound at /sound, the session at {LIVE}")


def _sounding(sound: Sound, wanted: str | None) -> Reply:
    headers = {"Content-Type": sound.mime, "Accept-Ranges": "bytes"} | _ALWAYS
    match = _RANGE.fullmatch(wanted.strip()) if wanted else None
    if match is None or match[1] == match[2] == "":
        return Reply(HTTPStatus.OK, sound.data, headers)
    size = len(sound.data)
    first = int(match[1]) if match[1] else max(size - int(match[2]), 0)
    last = min(int(match[2]), size - 1) if match[1] and match[2] else size - 1
    if first > last:
        where = {"Content-Range": f"bytes */{size}"}
        return Reply(HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE, b"", headers | where)
    where = {"Content-Range": f"bytes {first}-{last}/{size}"}
    return Reply(HTTPStatus.PARTIAL_CONTENT, sound.data[first : last + 1], headers | where)


def _without_port(host: str) -> str:
    match = _HOST.fullmatch(host)
    return (match[1] or match[2]) if match else ""


def _ours(name: str, bound_to: str) -> bool:
    if name == "localhost" or name == bound_to.lower():
        return True
    alone = is_loopback(bound_to)
    try:
        address = ipaddress.ip_address(name)
    except ValueError:
        here = socket.gethostname().lower()
        return not alone and name in (here, f"{here}.local")
    return address.is_loopback or not alone


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach a server that is bound to this.

    Examples
    --------
    >>> is_loopback("localhost"), is_loopback("0.0.0.0")
    (True, False)
    """
    try:
        return host.lower() == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
