"""The process of one job: a task on stdin, progress and what came of it on stdout, a line of JSON each.

It ends when its stdin does: then its studio is gone.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, BinaryIO

import msgspec

from onbeat.errors import OnbeatError
from onbeat.studio.advice import here
from onbeat.studio.tasks import (
    BuildTask,
    DanceTask,
    Done,
    ExportTask,
    Failed,
    ListenTask,
    LookTask,
    Progress,
    RetimeTask,
    Said,
    Task,
)
from onbeat.studio.telling import Tell

OFTEN = 0.1
"""Seconds between two words about how far it is."""
_SET_PARENT_DEATH_SIGNAL = 1


def main() -> None:
    """Do the task that comes on stdin."""
    out = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what libraries print is no word of ours
    if not (line := sys.stdin.buffer.readline()):
        return  # its studio has died already
    task = msgspec.json.decode(line, type=Task)
    _die_with_parent()
    threading.Thread(target=_end_with_studio, daemon=True).start()
    say = _Mouth(out)
    try:
        say(work_of(task)(task, Tell(say.progress)))
    except OnbeatError as error:
        say(Failed(here(str(error))))
    except MemoryError:
        say(Failed("there was not enough memory; try a shorter stretch of the song or fewer clips"))
    except OSError as error:
        say(Failed(f"{error.filename or 'the project'}: {error.strerror or error}"))
    except Exception as error:
        say(Failed(f"onbeat has a fault here ({type(error).__name__}: {error}); please report it with the file"))
        raise


def work_of(task: Task) -> Callable[[Any, Tell], Done]:
    """What does a task: called with it and with who is told how far it is."""
    # Imported when it is done: no job needs what all need.
    match task:
        case ListenTask():
            from onbeat.studio.work_listen import listened as work
        case LookTask():
            from onbeat.studio.work_look import looked as work
        case BuildTask():
            from onbeat.studio.work_build import built as work
        case DanceTask():
            from onbeat.studio.work_dance import danced as work
        case RetimeTask():
            from onbeat.studio.work_retime import retimed as work
        case ExportTask():
            from onbeat.studio.work_export import exported as work
    return work


class _Mouth:
    """Says how far it is, not too often, and never less than it was."""

    def __init__(self, out: BinaryIO) -> None:
        self._out = out
        self._at, self._share, self._message = -1.0, 0.0, ""

    def __call__(self, said: Said) -> None:
        self._out.write(msgspec.json.encode(said) + b"\n")

    def progress(self, share: float, message: str) -> None:
        now = time.monotonic()
        if now - self._at < OFTEN and message == self._message:
            return
        self._at, self._message, self._share = now, message, max(self._share, min(share, 1.0))
        self(Progress(self._share, message))


def _die_with_parent() -> None:
    """On Linux the system ends us with our studio, in the middle of a compiled loop, too, which holds up threads."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)


def _end_with_studio() -> None:
    """End with all processes that were begun here, as soon as nobody can tell us anything any more."""
    while os.read(0, 4096):
        pass
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        with contextlib.suppress(OSError):
            os.killpg(os.getpgrp(), signal.SIGKILL)
    os._exit(1)


if __name__ == "__main__":
    main()
