"""The process of one job, seen from the studio: told its task on its stdin, heard on its stdout, ended by a kill.

Its stdin stays open as long as the studio lives: a process whose studio has died sees its end and ends, too.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections.abc import AsyncGenerator, Sequence

import msgspec

from onbeat.errors import OnbeatError
from onbeat.studio.tasks import LINE, Done, Failed, Progress, Said, Task

COMMAND = (sys.executable, "-P", "-m", "onbeat.studio.worker")
"""What a job's process runs."""
TOLD = 400
"""Characters of what a process printed before it died that are passed on."""
_GROUPS = hasattr(os, "killpg")


class Worker:
    """A process for one task; ``command`` is what it runs."""

    def __init__(self, task: Task, command: Sequence[str] = COMMAND) -> None:
        self._task, self._command = task, command
        self._process: asyncio.subprocess.Process | None = None
        self._killed = False

    async def work(self) -> AsyncGenerator[Progress | Done]:
        """Do it: progress comes, at last what came of it.

        Raises
        ------
        OnbeatError
            If it cannot be done, or the process died.
        """
        pipe = asyncio.subprocess.PIPE
        process = self._process = await asyncio.create_subprocess_exec(
            *self._command,
            stdin=pipe,
            stdout=pipe,
            stderr=pipe,
            limit=LINE,
            start_new_session=_GROUPS,
            cwd=self._task.out,
        )
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        printed = asyncio.create_task(_last_words(process.stderr))
        try:
            if self._killed:
                self.kill()
            with contextlib.suppress(ConnectionError):
                process.stdin.write(msgspec.json.encode(self._task) + b"\n")
                await process.stdin.drain()
            async for said in _said(process.stdout):
                if isinstance(said, Failed):
                    raise OnbeatError(said.error)
                yield said
                if isinstance(said, Done):
                    return
            raise OnbeatError(_died(await process.wait(), await printed))
        finally:
            self.kill()
            await process.wait()
            printed.cancel()
            process.stdin.close()

    def kill(self) -> None:
        """End it now, with all that it began."""
        self._killed = True
        if self._process is None or self._process.returncode is not None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if _GROUPS:
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()


async def _said(stream: asyncio.StreamReader) -> AsyncGenerator[Said]:
    decoder = msgspec.json.Decoder(Said)
    while line := await stream.readline():
        yield decoder.decode(line)


async def _last_words(stream: asyncio.StreamReader) -> str:
    """The end of what it printed on stderr, of which no more is held."""
    kept = b""
    while part := await stream.read(4096):
        kept = (kept + part)[-4 * TOLD :]
    return kept.decode(errors="replace")


def _died(status: int, printed: str) -> str:
    """What is said of a process that ended without a word.

    Examples
    --------
    >>> _died(-9, "")
    'its process was ended by signal 9 (SIGKILL): perhaps there was not enough memory; try a shorter stretch'
    """
    last = printed.strip().splitlines()[-1:] or ["it said nothing"]
    if status < 0:
        name = signal.Signals(-status).name
        return f"its process was ended by signal {-status} ({name}): perhaps there was not enough memory; " + (
            "try a shorter stretch"
        )
    return f"its process ended with status {status}: {last[0][-TOLD:]}"
