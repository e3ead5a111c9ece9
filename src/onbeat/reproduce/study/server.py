"""A small server for a study: it gives the page, and keeps each person's answers as a file of a folder.

It is reached from this machine alone unless it is told otherwise; then the address that it prints holds a token.
Nothing is written but ``answers/ID.json``, an id of hexadecimal digits, by answers that this very page can give.
"""

from __future__ import annotations

import contextlib
import hmac
import logging
import re
import secrets
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import msgspec
import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

from onbeat.errors import OnbeatError
from onbeat.files import make_folder, write_atomically
from onbeat.keyposes.judging import Trial
from onbeat.live.page.http import is_loopback, welcome
from onbeat.reproduce.study.answers import PersonAnswers, StudyDocument
from onbeat.reproduce.study.plans import ANSWERS, PAGE

PORT = 8652
LARGEST = 1 << 20
"""Bytes of answers that are taken at once: those of a thousand people."""
MOST_PEOPLE = 20_000
"""Files of answers that are kept."""
_DATA = re.compile(rb'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
_ALWAYS = {"X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY", "Referrer-Policy": "no-referrer",
           "Cache-Control": "no-store"}  # fmt: skip


class Study(NamedTuple):
    """What a page asks.

    Parameters
    ----------
    page : its bytes.
    key : which study it is of.
    dims : dimensions of the motions.
    plans : what each person is asked, in order.
    """

    page: bytes
    key: str
    dims: int
    plans: frozenset[tuple[Trial, ...]]


class _Asked(msgspec.Struct):
    motion: str
    a: str
    b: str
    stretch: int


class _Data(msgspec.Struct):
    key: str
    dims: int
    plans: list[list[_Asked]]


def open_study(folder: Path) -> Study:
    """The study whose page lies in a folder.

    Raises
    ------
    OnbeatError
        If there is no page, or it is none of a study.
    """
    path = folder / PAGE
    try:
        page = path.read_bytes()
    except OSError as error:
        raise OnbeatError(
            f"cannot read {path}: {error.strerror or error}; make it with `onbeat reproduce study`"
        ) from None
    found = _DATA.search(page)
    try:
        data = msgspec.json.decode(found[1] if found else b"", type=_Data)
    except msgspec.DecodeError:
        raise OnbeatError(f"{path} is no page of a study; remove it and make it anew") from None
    return Study(
        page,
        data.key,
        data.dims,
        frozenset(tuple(Trial(*msgspec.structs.astuple(one)) for one in plan) for plan in data.plans),
    )


def keep_answers(folder: Path, study: Study, document: StudyDocument) -> int:
    """Write each person's answers to a file; how many were new.

    Raises
    ------
    OnbeatError
        If they are not answers to this study, a person is there already with other answers, or the folder is full.
    """
    if (document.study, document.dims) != (study.key, study.dims):
        raise OnbeatError(f"answers of another study, {document.study[:40]!r}; open the page anew")
    for person in document.people:
        asked = tuple(Trial(one.motion, one.a, one.b, one.stretch) for one in person.answers)
        if asked not in study.plans:
            raise OnbeatError(f"{person.id} answers what the page does not ask; open it anew")
    place = make_folder(folder / ANSWERS)
    return sum(_keep(place, document, person) for person in document.people)


def _keep(place: Path, document: StudyDocument, person: PersonAnswers) -> bool:
    path = place / f"{person.id}.json"
    data = StudyDocument(document.version, document.study, document.dims, [person]).to_json()
    if path.exists():
        if path.read_bytes() != data:
            raise OnbeatError(f"{person.id} has answered otherwise before; what was kept first stays")
        return False
    if sum(1 for _ in place.iterdir()) >= MOST_PEOPLE:
        raise OnbeatError(f"{MOST_PEOPLE} people have answered; no more are taken")
    write_atomically(path, data)
    return True


def study_app(folder: Path, study: Study, host: str = "127.0.0.1", token: str = "") -> Starlette:
    """The app: ``GET /`` is the page, ``POST /answers`` takes answers; both under ``/token`` where there is one."""
    lock = threading.Lock()

    def kept(body: bytes) -> None:
        with lock:
            keep_answers(folder, study, StudyDocument.from_json(body, "the answers"))

    async def page(request: Request) -> Response:
        return _refused(request, host, token) or Response(study.page, headers=_ALWAYS, media_type="text/html")

    async def answers(request: Request) -> Response:
        if refused := _refused(request, host, token):
            return refused
        body = await _body(request)
        if body is None:
            return _plain(413, f"more than {LARGEST} bytes; hand the file in instead")
        try:
            await run_in_threadpool(kept, body)
        except OnbeatError as error:
            return _plain(400, str(error))
        return Response(status_code=204, headers=_ALWAYS)

    before = "/{token}" if token else ""
    return Starlette(
        routes=[Route(f"{before}/", page), Route(f"{before}/{ANSWERS}", answers, methods=["POST"])],
    )


async def _body(request: Request) -> bytes | None:
    """What was sent; None where it is too much."""
    parts, size = [], 0
    try:
        async for part in request.stream():
            size += len(part)
            if size > LARGEST:
                return None
            parts.append(part)
    except ClientDisconnect:
        return b""
    return b"".join(parts)


def _refused(request: Request, host: str, token: str) -> Response | None:
    """The refusal of a request, or none: by the name that was asked for, the page it comes from, and the token."""
    headers = request.headers
    origin = headers.get("origin") if request.method == "POST" else None
    if not welcome(headers.get("host"), origin, host):
        return _plain(403, "open the study by the address that was printed")
    if not hmac.compare_digest(request.path_params.get("token", "").encode(), token.encode()):
        return _plain(404, "nothing here; open the study by the address that was printed")
    if request.method == "POST" and headers.get("content-type", "").partition(";")[0] != "application/json":
        return _plain(415, "answers are JSON")
    return None


def _plain(status: int, why: str) -> Response:
    return PlainTextResponse(why + "\n", status, headers=_ALWAYS)


def serve_study(folder: Path, host: str = "127.0.0.1", port: int = PORT, said: Callable[[str], None] = print) -> None:
    """Serve the study of a folder until Ctrl-C.

    Parameters
    ----------
    folder : with the page; answers go into its folder ``answers``.
    host, port : what to bind to; 0 is any port that is free.
    said : is told the page's address.

    Raises
    ------
    OnbeatError
        If there is no page, or the port cannot be had.
    """
    study, token = open_study(folder), "" if is_loopback(host) else secrets.token_urlsafe(12)
    with contextlib.closing(_bound(host, port)) as bound:
        shown = {"0.0.0.0": socket.gethostname(), "::": socket.gethostname()}.get(host, host)
        shown = f"[{shown}]" if ":" in shown else shown
        said(f"http://{shown}:{bound.getsockname()[1]}/" + (f"{token}/" if token else ""))
        config = uvicorn.Config(
            study_app(folder, study, host, token), log_level=logging.WARNING, access_log=False, server_header=False,
            timeout_graceful_shutdown=1, proxy_headers=False, ws="none",
        )  # fmt: skip
        with contextlib.suppress(KeyboardInterrupt):  # it is how a study ends
            uvicorn.Server(config).run(sockets=[bound])


def _bound(host: str, port: int) -> socket.socket:
    if not 0 <= port <= 65535:  # others are taken modulo 65,536 by some systems
        raise OnbeatError(f"--port {port}: give a number from 1 to 65535, or 0 for any that is free")
    try:
        family, kind, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        bound = socket.socket(family, kind)
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        bound.bind(place)
    except (OSError, OverflowError, UnicodeError) as error:
        raise OnbeatError(
            f"cannot serve at {host}:{port}: {getattr(error, 'strerror', None) or error}; give another --port, 0 for "
            "any that is free, or an address of this machine"
        ) from None
    return bound
