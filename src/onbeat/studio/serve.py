"""The studio's server: opened on a port of this machine, ended by Ctrl-C, its project closed whatever happens."""

from __future__ import annotations

import contextlib
import logging
import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable, Sequence
from pathlib import Path

import uvicorn

from onbeat.errors import OnbeatError
from onbeat.live.page.http import is_loopback
from onbeat.studio.app import make_app
from onbeat.studio.crew import COMMAND
from onbeat.studio.studio import LARGEST, Studio

PORT = 8642
LINGER = 1
"""Seconds that requests have to end."""
SHORTEST_TOKEN = 16


def serve(
    folder: Path,
    host: str = "127.0.0.1",
    port: int = PORT,
    token: str | None = None,
    workers: int = 2,
    largest: int = LARGEST,
    said: Callable[[str], None] = print,
    open_browser: bool = False,
    command: Sequence[str] = COMMAND,
) -> None:
    """Serve a project until the process is told to end.

    Parameters
    ----------
    folder : of the project.
    host, port : what to bind to; 0 is any port that is free. What other machines can reach needs a token.
    token : what has to be shown; made where it is needed and none is given.
    workers : jobs that run at once.
    largest : bytes of an upload.
    said : is told the address of the page.
    open_browser : whether it is opened.
    command : what a job's process runs.

    Raises
    ------
    OnbeatError
        If the project cannot be opened, or the port cannot be had.
    """
    token = _token(host, token)
    bound = _bound(host, port)
    with contextlib.closing(bound):
        studio = Studio.open(folder, workers, largest, command)
        port = bound.getsockname()[1]
        address = page_address(host, port, token)
        app = make_app(studio, host, token, port)
        config = uvicorn.Config(
            app, log_level=logging.WARNING, access_log=False, server_header=False, timeout_graceful_shutdown=LINGER,
            proxy_headers=False, ws="none",
        )  # fmt: skip

        def opened() -> None:
            said(address)
            if open_browser:
                threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()

        try:
            with contextlib.suppress(KeyboardInterrupt):  # it is how a studio ends
                _Server(config, studio, opened).run(sockets=[bound])
        finally:
            studio.folder.close()


def page_address(host: str, port: int, token: str | None) -> str:
    """Where the page is, as a user opens it.

    Examples
    --------
    >>> page_address("0.0.0.0", 8642, "abc"), page_address("::1", 80, None)
    ('http://127.0.0.1:8642/?token=abc', 'http://[::1]:80/')
    """
    name = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{name}:{port}/" + (f"?token={token}" if token else "")


def _token(host: str, token: str | None) -> str | None:
    if token is None:
        return None if is_loopback(host) else secrets.token_urlsafe(18)
    if len(token) < SHORTEST_TOKEN or not all(c.isascii() and (c.isalnum() or c in "-_") for c in token):
        raise OnbeatError(
            f"--token: give {SHORTEST_TOKEN} or more letters, digits, - and _; without it one is made where needed"
        )
    return token


def _bound(host: str, port: int) -> socket.socket:
    """The socket, bound before the project is opened."""
    try:
        family, kind, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        bound = socket.socket(family, kind)
        try:
            bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            bound.bind(place)
        except BaseException:
            bound.close()
            raise
    except (OSError, OverflowError, UnicodeError) as error:
        raise OnbeatError(
            f"cannot serve at {host}:{port}: {getattr(error, 'strerror', None) or error}; "
            "give another --port, 0 for any that is free, or an address of this machine"
        ) from None
    bound.set_inheritable(False)
    return bound


class _Server(uvicorn.Server):
    """A server that says when it answers, and lets those go who listen to events before it ends."""

    def __init__(self, config: uvicorn.Config, studio: Studio, opened: Callable[[], None]) -> None:
        super().__init__(config)
        self._studio, self._opened = studio, opened

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to answer."""
        await super().startup(sockets)
        if self.started:
            self._opened()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End."""
        self._studio.events.end()
        await super().shutdown(sockets)
