"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from pathlib import Path

from onbeat.errors import OnbeatError


def write_atomically(path: str | os.PathLike[str], data: bytes) -> None:
    """Write ``data`` to a temporary name beside ``path`` and rename it, so that nobody ever sees half a file.

    Raises
    ------
    OnbeatError
        If the folder is missing, not writable, or the disk is full; what was there before is kept.
    """
    path = Path(path)
    temporary = ""
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        raise OnbeatError(f"cannot write {path}: {error.strerror or error}; choose another folder") from None
    finally:
        if temporary:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(temporary)


def make_folder(path: str | os.PathLike[str]) -> Path:
    """Make a folder and its parents if they are not there; an ``OnbeatError`` says why it cannot be."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OnbeatError(f"cannot make the folder {folder}: {error.strerror or error}") from None
    return folder


def lock_file(handle: int) -> None:
    """Lock an open file for this process alone, or raise ``OSError`` at once; the lock dies with the process."""
    if sys.platform == "win32":
        import msvcrt

        os.lseek(handle, 64, os.SEEK_SET)  # past what is written in it, which others may read
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
