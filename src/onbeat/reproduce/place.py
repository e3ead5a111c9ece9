"""The folder of results: tried before the work begins, held until it is over, as it was if nothing came of it."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path

from onbeat.errors import OnbeatError
from onbeat.files import lock_file

LOCK = ".lock"
"""Held by the process that writes into the folder; there for as long."""
TRIES = 100
"""How often a lock is made anew that others, who are done, take away."""


@contextmanager
def place_for(folder: str | Path, names: Sequence[str]) -> Generator[None, None, None]:
    """A folder into which files of some names can be written, held while they are made.

    It is made if it is not there, its parents too, and what was made is taken away again if nothing came of it.

    Raises
    ------
    OnbeatError
        If it cannot be made or written, somebody else is at work in it, or a file to be written is a folder there.
    """
    place = Path(folder)
    made = _not_there(place)
    try:
        with _held(place):
            taken = [name for name in names if (place / name).is_dir()]
            if taken:
                raise OnbeatError(f"cannot write {place / taken[0]}: a folder is there; choose another folder")
            yield
    except BaseException:
        with contextlib.suppress(OSError):  # not empty, or another's by now
            for one in made:
                one.rmdir()
        raise


def _not_there(place: Path) -> list[Path]:
    """The folder and its parents that have to be made, the deepest first."""
    made: list[Path] = []
    try:
        for one in (place, *place.absolute().parents):
            if one.exists():
                break
            made.append(one)
        else:
            return made
    except OSError as error:
        raise OnbeatError(f"cannot write into {place}: {error.strerror or error}; choose another folder") from None
    if not one.is_dir():
        raise OnbeatError(f"cannot write into {place}: {one} is not a folder; choose another folder")
    return made


@contextmanager
def _held(place: Path) -> Generator[None, None, None]:
    """Hold a folder's lock, which dies with the process, and take it away before it is let go."""
    handle = _locked(place)
    try:
        with contextlib.suppress(OSError):  # a full disk: the number is for a message only
            os.ftruncate(handle, 0)
            os.lseek(handle, 0, os.SEEK_SET)
            os.write(handle, str(os.getpid()).encode())
        yield
    finally:
        with contextlib.suppress(OSError):  # where files that are open cannot be taken away it stays, and does no harm
            if _is_there(handle, place / LOCK):  # who took it away by hand let another in, whose lock is now there
                (place / LOCK).unlink()
        os.close(handle)


def _locked(place: Path) -> int:
    """The lock of a folder, open; whoever took away the file that was opened here was done, and it is made anew."""
    for _ in range(TRIES):
        try:
            place.mkdir(parents=True, exist_ok=True)
            handle = _opened(place / LOCK)
        except OSError as error:
            raise OnbeatError(f"cannot write in {place}: {error.strerror or error}; choose another folder") from None
        if handle is not None and _is_ours(handle, place):
            return handle
    raise OnbeatError(f"cannot hold {place}: its {LOCK} is taken away again and again; choose another folder")


def _is_ours(handle: int, place: Path) -> bool:
    """Lock an open file; False, and closed again, where it was taken away in the meantime."""
    try:
        lock_file(handle)
    except OSError:
        holder = os.read(handle, 20).decode(errors="replace").strip() or "another"
        os.close(handle)
        raise OnbeatError(
            f"{place} is being written by process {holder}; wait until it is done, or choose another folder"
        ) from None
    if _is_there(handle, place / LOCK):
        return True
    os.close(handle)
    return False


def _opened(path: Path) -> int | None:
    """A file, made if it is not there; None where another run that came to nothing just took the folder away."""
    try:
        return os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except FileNotFoundError:
        if path.parent.exists():
            raise
        return None


def _is_there(handle: int, path: Path) -> bool:
    """Whether an open file is still the one of a name."""
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except FileNotFoundError:
        return False
