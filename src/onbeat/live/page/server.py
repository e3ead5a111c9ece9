"""The page's server: HTTP gives the page and the sound, a WebSocket the session, all on one port of this machine.

An asyncio loop on a thread of its own; the session's side only hands it ready messages. What goes over the WebSocket is
in :mod:`onbeat.live.page.wire`, who is let in in :mod:`onbeat.live.page.http`, who is too slow in
:mod:`onbeat.live.page.clients`.
"""

from __future__ import annotations

import asyncio
import errno
import logging
import socket
import threading
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from http import HTTPStatus
from importlib import import_module
from typing import Any

from onbeat.errors import MissingExtraError, OnbeatError
from onbeat.live.page import wire
from onbeat.live.page.clients import WRONG, Client, Clients
from onbeat.live.page.http import LIVE, Reply, Sound, answered, refused, welcome
from onbeat.live.protocol import Command, Event, Note, Pose, Status, Who

PORTS = tuple(range(8740, 8750))
"""Tried in turn where no port is asked for."""
POSE_EVERY = 2
"""Poses of which one is sent, 50 a second: the page draws between them."""
LINGER = 0.4
"""Seconds that clients have to say goodbye."""
_SEND_BUFFER = 65536
_SLOW = 60.0  # [s] that a page or a sound may take to be fetched
_SILENT = logging.Logger("onbeat.live.page.server", logging.CRITICAL + 1)


class Server:
    """A mouth that speaks to pages, and hears what they want.

    Parameters
    ----------
    page : HTML of ``GET /``.
    hello : tells who dances, as it is now; called for each client, on the server's thread.
    heard : is called with each command, on the server's thread.
    sound : what is heard, for ``GET /sound``; none where there is no file.
    host : the address to listen at; others than this machine's own let others in.
    port : that one or an error; 0 any that is free; None the first free one of :data:`PORTS`.
    origins : of others' pages that may connect too, as browsers write them: "http://localhost:5173".
    """

    quick = True

    def __init__(
        self,
        page: bytes,
        hello: Callable[[], wire.HelloData],
        heard: Callable[[Command], None],
        sound: Sound | None = None,
        host: str = "127.0.0.1",
        port: int | None = None,
        origins: Collection[str] = (),
    ) -> None:
        self.name = "the page's server"
        self.note = ""
        self._page, self._hello, self._heard, self._sound = page, hello, heard, sound
        self._host, self._origins = host, origins
        self._ports: Sequence[int] = PORTS if port is None else (port,)
        self._clients: Clients | None = None  # none before it is open
        self._status: str | None = None
        self._time = 0.0
        self._thread: threading.Thread | None = None

    @property
    def address(self) -> str:
        """Where the page is, once it is open; ``note`` says so if that is not the port that was meant."""
        shown = f"[{self._host}]" if ":" in self._host else self._host
        return f"http://{'127.0.0.1' if self._host == '0.0.0.0' else shown}:{self._ports[0]}/"

    @property
    def listeners(self) -> int:
        """How many clients there are."""
        return len(self._clients) if self._clients is not None else 0

    def open(self, who: Who) -> None:
        """Begin to serve.

        Raises
        ------
        MissingExtraError
            If websockets is not installed.
        OnbeatError
            If the port is taken or the address is none of this machine.
        """
        self._library = websockets()
        self._clients = Clients(self._library.asyncio.server.broadcast)
        ready: Future[int] = Future()
        self._thread = threading.Thread(target=self._run, args=(self._clients, ready), name="onbeat page", daemon=True)
        self._thread.start()
        port = ready.result()
        if self._ports == PORTS and port != PORTS[0]:
            self.note = f"port {PORTS[0]} is taken; the page is at port {port}"
        self._ports = (port,)

    def pose(self, pose: Pose) -> None:
        """Hand a pose to the loop, if anybody is there."""
        self._time = pose.time
        if self._clients and pose.number % POSE_EVERY == 0:
            self._call(self._clients.pose, wire.packed(pose))

    def say(self, event: Event) -> None:
        """Hand an event to the loop, if anybody is there."""
        message = wire.text(event)
        if isinstance(event, Status):
            self._status = message
        if self._clients:
            self._call(self._clients.text, message)

    def close(self) -> None:
        """Say goodbye and end."""
        if self._thread is None:
            return
        with suppress(OnbeatError):
            self._call(self._stop.set)
        self._thread.join(2 * LINGER)
        self._thread = None

    def _call(self, what: Callable[..., Any], *of: Any) -> None:
        try:
            self._loop.call_soon_threadsafe(what, *of)
        except RuntimeError:
            raise OnbeatError("the server has ended") from None

    def _run(self, clients: Clients, ready: Future[int]) -> None:
        try:
            asyncio.run(self._serve(clients, ready))
        except BaseException as error:
            if not ready.done():
                ready.set_exception(error)

    async def _serve(self, clients: Clients, ready: Future[int]) -> None:
        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        server = await self._bound(clients)
        ready.set_result(next(iter(server.sockets)).getsockname()[1])
        await self._stop.wait()
        server.close()
        try:
            await asyncio.wait_for(server.wait_closed(), LINGER)
        except TimeoutError:
            clients.abort()

    async def _bound(self, clients: Clients) -> Any:
        for port in self._ports:
            try:
                return await self._library.asyncio.server.serve(
                    partial(self._listen, clients), self._host, port, process_request=partial(self._answer, clients),
                    compression=None, max_size=wire.LONGEST, open_timeout=_SLOW, close_timeout=_SLOW, logger=_SILENT,
                    server_header=None,
                )  # fmt: skip
            except (OSError, OverflowError, UnicodeError) as error:
                taken = getattr(error, "errno", None) == errno.EADDRINUSE
                if not taken or port == self._ports[-1]:
                    raise OnbeatError(_why(self._host, port, taken, error)) from None
        raise AssertionError("a port is tried")

    def _answer(self, clients: Clients, _: Any, request: Any) -> Any:
        """The reply to a request; None lets a WebSocket open."""
        host, origin, wanted = (_header(request, name) for name in ("Host", "Origin", "Range"))
        if not welcome(host, origin, self._host, self._origins):
            return self._response(refused(HTTPStatus.FORBIDDEN, "only the page's own address is answered"))
        if request.path.partition("?")[0] != LIVE:
            return self._response(answered(request.path, self._page, self._sound, wanted))
        if clients.full:
            return self._response(refused(HTTPStatus.SERVICE_UNAVAILABLE, "too many pages are open; close some"))
        return None

    def _response(self, reply: Reply) -> Any:
        headers = reply.headers | {"Content-Length": str(len(reply.body)), "Connection": "close"}
        kind = self._library.http11.Response
        return kind(reply.status.value, reply.status.phrase, self._library.datastructures.Headers(headers), reply.body)

    async def _listen(self, clients: Clients, connection: Any) -> None:
        """Tell a client who dances, then hear what it wants until it goes."""
        # Little waits in the system's own buffer, so that who is behind is seen to be.
        connection.transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        await connection.send(wire.text(self._hello()))
        if self._status is not None:
            await connection.send(self._status)
        client = clients.add(connection)
        try:
            async for message in connection:
                await self._hear(client, message)
        except self._library.exceptions.ConnectionClosed:
            pass
        finally:
            clients.remove(client)

    async def _hear(self, client: Client, message: str | bytes) -> None:
        try:
            command = wire.read_command(message)
        except OnbeatError as error:
            client.wrong += 1
            if client.wrong == 1:
                await client.connection.send(wire.text(Note(self._time, str(error))))
            if client.wrong > WRONG:
                await client.connection.close(1008, "no commands")
            return
        if client.may_ask():
            self._heard(command)


def websockets() -> Any:
    """The package ``websockets``.

    Raises
    ------
    MissingExtraError
        If it is not installed, or older than its asyncio server.
    """
    try:
        import_module("websockets.asyncio.server")
    except ImportError:
        raise MissingExtraError('the live page needs websockets 13 or later: pip install "onbeat[live]"') from None
    return import_module("websockets")


def _header(request: Any, name: str) -> str | None:
    """A header's value; of one that is there more than once all, which no good one is."""
    return ", ".join(request.headers.get_all(name)) or None


def _why(host: str, port: int, taken: bool, error: Exception) -> str:
    if taken:
        return f"port {port} of {host} is taken; choose another, or 0 for any that is free"
    return (
        f"cannot serve the page at {host}:{port}: {error}; expected an address of this machine and a port up to 65535"
    )
