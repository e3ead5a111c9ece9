"""Finding a cluster: a scheduler that answers, workers that are there and have the same code."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

from onbeat.errors import MissingExtraError
from onbeat.moves.engines.crew import EngineError
from onbeat.moves.engines.orders import identity, refusal

CONNECT = 10.0
"""Seconds that a scheduler may take to answer."""
PATIENCE = 60.0
"""Seconds for which there may be no worker."""
MARK = ".run-"
"""How the name of a file begins that says whose run a folder is of."""


def connected(address: str) -> Any:
    """A client of a scheduler, whose workers were asked for their versions.

    Raises
    ------
    EngineError
        If it does not answer, has no workers, or they have other code than this machine.
    MissingExtraError
        If dask.distributed is not installed.
    """
    try:
        from distributed import Client, Security
        from distributed.comm.core import connect
    except ImportError:
        raise MissingExtraError('a cluster needs dask.distributed: pip install "onbeat[scale]"') from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # what it tells is seen to here

    arguments: dict[str, Any] = Security().get_connection_args("client")

    async def knock() -> None:
        comm = await connect(address, timeout=CONNECT, **arguments)
        await comm.close()

    _in_time(lambda: asyncio.run(knock()), address)  # a client that finds no scheduler does not go quietly
    client = _in_time(partial(Client, address, timeout=CONNECT, set_as_default=False, direct_to_workers=True), address)
    try:
        _check(client, address)
    except BaseException:
        client.close()
        raise
    return client


def _in_time(connect: Callable[[], Any], address: str) -> Any:
    """A client, or an error when it is time: what listens there may be no scheduler and never say a word."""
    back: SimpleQueue[Any] = SimpleQueue()

    def go() -> None:
        try:
            back.put(connect())
        except BaseException as error:  # OSError, ValueError of the address, or of a scheduler of another version
            back.put(error)

    Thread(target=go, daemon=True).start()
    try:
        found = back.get(timeout=2 * CONNECT)
    except Empty:
        found = TimeoutError("what listens there does not talk as one")
    if isinstance(found, BaseException):
        raise EngineError(f"no scheduler answers at {address} ({words(found)}); start one there with `dask scheduler`")
    return found


def _check(client: Any, address: str) -> None:
    """Wait for a worker, and compare the code of all."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
        answers = client.run(identity, on_error="return")
    except (OSError, TimeoutError):
        raise alone(address) from None
    for worker, answer in sorted(answers.items()):
        if isinstance(answer, OSError):  # it has gone meanwhile
            continue
        theirs = answer if isinstance(answer, str) else f"no onbeat that fits ({words(answer)})"
        if theirs != _ours():
            raise refusal(f"the worker {worker}", theirs, _ours())


def _ours() -> str:
    return identity()


def alone(address: str) -> EngineError:
    """The error that a scheduler has no workers."""
    return EngineError(
        f"the scheduler at {address} has had no worker for {PATIENCE:.0f} s; start some with `dask worker {address} "
        "--nthreads 1` (what is done is kept)"
    )


def words(error: BaseException) -> str:
    """The first line of an error."""
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__


def marked(folder: Path) -> str:
    """A file in a folder by which workers know it; "" if there can be none. Those that stopped builders left go."""
    try:
        for old in folder.glob(f"{MARK}*"):
            old.unlink()
        handle, path = tempfile.mkstemp(prefix=MARK, dir=folder.absolute())
    except OSError:
        return ""
    os.close(handle)
    with contextlib.suppress(OSError):
        os.chmod(path, 0o644)
    return path
