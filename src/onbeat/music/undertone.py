"""What decoders of sound write to the screen, kept from the user: onbeat says in its own words what is wrong.

The MP3 decoder inside libsndfile writes to file descriptor 2, whatever is asked of it. While it works, that descriptor
leads to nowhere; but only where Python's own ``sys.stderr`` has another one (the command line gives it one), so that no
word of onbeat, of its threads or of a program that uses it is ever lost.
"""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Generator

STDERR = 2
_lock = threading.Lock()
_inside = 0
_kept = -1


@contextlib.contextmanager
def unheard() -> Generator[None]:
    """While inside, what libraries write to file descriptor 2 is not seen, if Python's own stderr has another."""
    if _is_shared():
        yield
        return
    _enter()
    try:
        yield
    finally:
        _leave()


def _enter() -> None:
    global _inside, _kept
    with _lock:
        _inside += 1
        if _inside > 1 or _kept >= 0:
            return
        with contextlib.suppress(OSError):  # a process without descriptor 2 has nothing to keep quiet
            kept = os.dup(STDERR)
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, STDERR)
            os.close(nowhere)
            _kept = kept


def _leave() -> None:
    global _inside, _kept
    with _lock:
        _inside -= 1
        if _inside == 0 and _kept >= 0:
            os.dup2(_kept, STDERR)
            os.close(_kept)
            _kept = -1


def _is_shared() -> bool:
    """Whether Python writes to the descriptor to which libraries write, or it is not known to which."""
    try:
        return sys.stderr.fileno() == STDERR
    except (AttributeError, OSError, ValueError):  # there is none, or it is no file
        return True
