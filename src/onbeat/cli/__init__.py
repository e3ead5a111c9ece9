"""The command line: one short file per command."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from typing import NoReturn

from onbeat.cli.own_stderr import own_stderr
from onbeat.errors import OnbeatError


def main() -> None:
    """Run the command line; a user's error becomes one line on stderr and exit status 1, of usage 2."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # names of files may hold what a terminal cannot show
            stream.reconfigure(errors="backslashreplace")
    own_stderr()
    try:
        # Imported here, so that Ctrl-C is a word and no traceback from the first moment on.
        from onbeat.cli.commands import app

        app()
        sys.stdout.flush()
    except OnbeatError as error:
        _stop(str(error), 1)
    except MemoryError:
        _stop("not enough memory; choose a shorter stretch of the song or fewer clips", 1)
    except KeyboardInterrupt:
        _stop("stopped", 130)
    except SystemError as error:
        if not _is_stopped(error):
            raise
        _stop("stopped", 130)  # Ctrl-C while a compiled loop ran
    except OSError as error:  # of files, onbeat's own errors tell; this is the screen, or the pipe, that is printed to
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left to print would only fail again
        if isinstance(error, BrokenPipeError):  # who reads our output has seen enough
            sys.exit(1)
        _stop(f"{error.filename or 'standard output'}: {error.strerror or error}", 1)


def _is_stopped(error: BaseException | None) -> bool:
    """Whether Ctrl-C is at the bottom of an error: every compiled loop on the way wraps it once more."""
    while isinstance(error, SystemError):
        error = error.__cause__ or error.__context__
    return isinstance(error, KeyboardInterrupt)


def _stop(message: str, status: int) -> NoReturn:
    print(f"onbeat: {' '.join(message.split())}", file=sys.stderr)  # noqa: T201
    sys.exit(status)
