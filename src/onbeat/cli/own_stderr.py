"""A file descriptor of their own for onbeat's words on stderr, beside the one to which libraries write theirs."""

from __future__ import annotations

import contextlib
import io
import os
import sys

STDERR = 2


def own_stderr() -> None:
    """Give ``sys.stderr`` another descriptor to the same place, so that decoders of sound can be kept from 2.

    See :mod:`onbeat.music.undertone`. Where Python's stderr is no longer the process's, nothing is done.
    """
    stream = sys.stderr
    if stream is not sys.__stderr__ or not isinstance(stream, io.TextIOWrapper):
        return
    with contextlib.suppress(OSError, ValueError):
        if stream.fileno() == STDERR:
            stream.flush()
            sys.stderr = open(  # noqa: SIM115 - it stays open as long as the process lives
                os.dup(STDERR), "w", encoding=stream.encoding, errors=stream.errors, buffering=1, closefd=False
            )
