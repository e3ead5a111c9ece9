"""One builder at a time: a lock that dies with its holder."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from onbeat.errors import LibraryError
from onbeat.files import lock_file

LOCK = ".lock"


class StorageError(LibraryError):
    """A folder in which no library can be kept now: it cannot be written, or another builder is at work there."""


class BusyError(StorageError):
    """Another builder is at work."""


@contextmanager
def building(folder: Path) -> Generator[None, None, None]:
    """Make a library's folder and hold its lock.

    The operating system drops the lock when its process ends, however it ends, so no stale lock is ever left; the file
    stays and holds the number of the last process for the message. A folder made here in vain is taken away again.

    Raises
    ------
    StorageError
        If another builder holds it, or the folder cannot be made or written.
    """
    new = not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise StorageError(f"cannot write in {folder}: {error.strerror or error}; choose another folder") from None
    try:
        try:
            lock_file(handle)
        except OSError:
            holder = os.read(handle, 20).decode(errors="replace").strip() or "another"
            raise BusyError(
                f"{folder} is being built by process {holder}; wait until it is done, or choose another folder"
            ) from None
        with contextlib.suppress(OSError):  # a full disk: the number is for a message only
            os.ftruncate(handle, 0)
            os.lseek(handle, 0, os.SEEK_SET)
            os.write(handle, str(os.getpid()).encode())
        yield
    except BaseException:
        if new and [path.name for path in folder.iterdir()] == [LOCK]:
            with contextlib.suppress(OSError):
                (folder / LOCK).unlink()
                folder.rmdir()
        raise
    finally:
        os.close(handle)
