"""``onbeat studio``: songs and motion files in, dances out, in the browser."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import cyclopts

from onbeat.errors import OnbeatError

MOST_WORKERS = 64


def studio_command(
    project: Path = Path("studio"),
    /,
    *,
    host: str = "127.0.0.1",
    port: int = 8642,
    token: str | None = None,
    open_page: Annotated[bool, cyclopts.Parameter(name="--open", negative="--no-open")] = True,
    workers: int = 2,
    largest: float = 1000.0,
) -> None:
    """Open the studio, a local web app: drop a song and motion files in, look, correct, dance, compare, export.

    Example: ``onbeat studio my_project``

    Parameters
    ----------
    project
        Folder in which everything is kept; made if it is not there.
    host
        Address to serve at. Others than this machine's own let other machines in who have the token.
    port
        Port to serve at; 0 is any that is free.
    token
        What has to be shown to be let in; made and printed where other machines can reach the studio.
    open_page
        Open the page in the browser.
    workers
        Jobs that run at once, each in a process of its own.
    largest
        Megabytes of an upload.
    """
    if not 0 <= port <= 65535:
        raise OnbeatError(f"--port {port}: give 0 to 65535")
    if not 1 <= workers <= MOST_WORKERS:
        raise OnbeatError(f"--workers {workers}: give 1 to {MOST_WORKERS}")
    if not 0.001 <= largest <= 1e6:
        raise OnbeatError(f"--largest {largest:g}: give megabytes, 0.001 to 1000000")
    from onbeat.studio.serve import serve

    def said(address: str) -> None:
        print(address, flush=True)  # noqa: T201
        print(f"the studio of {project} is open; Ctrl-C ends it, and everything is kept", file=sys.stderr)  # noqa: T201

    serve(project, host, port, token, workers, round(largest * 1e6), said, open_browser=open_page)
