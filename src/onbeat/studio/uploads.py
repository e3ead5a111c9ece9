"""What a user sends: streamed into a file of the project's, and cut off where it is too large."""

from __future__ import annotations

import shutil
from pathlib import Path

from starlette.requests import ClientDisconnect, Request

from onbeat.errors import OnbeatError
from onbeat.studio.project import INCOMING, Project

SPARE = 64 << 20
"""Bytes of the disk that stay free."""
UPLOAD = "upload"
"""Name of the file while it comes in: none of the user's."""


class TooLargeError(OnbeatError):
    """More is sent than is taken."""


class FullError(OnbeatError):
    """The disk is full."""


async def received(request: Request, project: Project, largest: int) -> Path:
    """The body of a request as a file in a folder of its own, which is the caller's to remove (:func:`discard`).

    Raises
    ------
    TooLargeError
        If it is, or says it is, longer than ``largest`` bytes; nothing of it is kept.
    OnbeatError
        If nothing comes, it ends early, or it cannot be written.
    """
    promised = request.headers.get("content-length", "")
    if promised.isdecimal():
        _check(int(promised), largest)
    _check_room(project, int(promised) if promised.isdecimal() else 0)
    folder = project.scratch(INCOMING)
    try:
        size = await _written(request, folder / UPLOAD, largest)
        if not size:
            raise OnbeatError("the file is empty (0 bytes): save or copy it again")
    except OSError as error:
        discard(folder / UPLOAD)
        raise FullError(f"the file cannot be kept: {error.strerror or error}") from None
    except BaseException:
        discard(folder / UPLOAD)
        raise
    return folder / UPLOAD


def discard(upload: Path) -> None:
    """Remove an upload and its folder."""
    shutil.rmtree(upload.parent, ignore_errors=True)


async def _written(request: Request, path: Path, largest: int) -> int:
    size = 0
    with path.open("xb") as file:
        try:
            async for chunk in request.stream():
                size += len(chunk)
                _check(size, largest)
                file.write(chunk)
        except ClientDisconnect:
            raise OnbeatError(f"the file ended after {size} bytes; send it again") from None
    return size


def _check(size: int, largest: int) -> None:
    if size > largest:
        raise TooLargeError(
            f"the file is larger than {largest / 1e6:.0f} MB, the most that is taken (--largest of `onbeat studio`)"
        )


def _check_room(project: Project, size: int) -> None:
    if shutil.disk_usage(project.folder).free < size + SPARE:
        raise FullError(f"the disk of {project.name} is full; delete something first")
