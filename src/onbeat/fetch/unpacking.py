"""Unpacking a zip that others made: nothing outside its folder, no links, no bombs, only what is wanted."""

from __future__ import annotations

import fnmatch
import hashlib
import shutil
import stat
import zipfile
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path, PurePosixPath, PureWindowsPath

from onbeat.errors import FetchError
from onbeat.fetch.receipts import LICENCE, RECEIPT

MOST_FILES = 100_000
MOST_TIMES, LEAST = 60, 64_000_000  # a zip of text holds at most so many times its size; small ones so many bytes
BLOCK = 1 << 20

Unpacked = tuple[str, int, str]
"""Path in the folder, bytes, SHA-256."""


def unpack(archive: Path, folder: Path, keep: Sequence[str], told: Callable[[float], None]) -> list[Unpacked]:
    """Unpack the files of a zip whose names fit one of ``keep`` into a folder; what they are.

    Parameters
    ----------
    keep : patterns of file names, without folders.
    told : is called with the share that is done.

    Raises
    ------
    FetchError
        If it is no whole zip, names a place outside of the folder, holds a link or more than a zip of its size may, or
        nothing that is wanted; some of it may be written then.
    """
    try:
        with zipfile.ZipFile(archive) as opened:
            wanted = _wanted(opened, archive, keep)
            _check_room(wanted, archive, folder)
            return _write(opened, wanted, archive, folder, told)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise FetchError(f"{archive.name} is no zip that can be unpacked ({error}); fetch it again") from None


def _wanted(opened: zipfile.ZipFile, archive: Path, keep: Sequence[str]) -> list[tuple[zipfile.ZipInfo, PurePosixPath]]:
    """The members that are wanted, each with its checked path."""
    members = opened.infolist()
    if len(members) > MOST_FILES:
        raise FetchError(f"{archive.name} holds {len(members):,} files, more than {MOST_FILES:,}; it is another file")
    placed = [(member, _place(member, archive)) for member in members]  # all are checked, not just those wanted
    kept = [(member, path) for member, path in placed if not member.is_dir() and _fits(path, keep)]
    if not kept:
        raise FetchError(f"{archive.name} holds none of {', '.join(keep)}; it is another file")
    if len({str(path).casefold() for _, path in kept}) < len(kept):
        raise FetchError(f"{archive.name} holds two files of one name; it is not unpacked")
    return kept


def _fits(path: PurePosixPath, keep: Sequence[str]) -> bool:
    hidden = any(part.startswith((".", "__MACOSX")) for part in path.parts)
    return not hidden and any(fnmatch.fnmatchcase(path.name.lower(), pattern.lower()) for pattern in keep)


def _place(member: zipfile.ZipInfo, archive: Path) -> PurePosixPath:
    name = member.filename
    path = PurePosixPath(name)
    outside = path.is_absolute() or ".." in path.parts or PureWindowsPath(name).drive or "\\" in name or ":" in name
    if outside or not path.parts or name.startswith("/"):
        raise FetchError(f"{archive.name} holds {name!r}, a path that leads out of its folder; it is not unpacked")
    if path.parts[0] in (RECEIPT, LICENCE) or any(ord(letter) < 32 for letter in name):
        raise FetchError(f"{archive.name} holds {name!r}, a name that is not taken; it is not unpacked")
    kind = stat.S_IFMT(member.external_attr >> 16)
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        raise FetchError(f"{archive.name} holds {name!r}, a link or device; it is not unpacked")
    if member.flag_bits & 1:
        raise FetchError(f"{archive.name} holds {name!r}, which is locked with a password; it is not unpacked")
    return path


def _most(archive: Path) -> int:
    return max(MOST_TIMES * archive.stat().st_size, LEAST)


def _check_room(wanted: list[tuple[zipfile.ZipInfo, PurePosixPath]], archive: Path, folder: Path) -> None:
    total = sum(member.file_size for member, _ in wanted)
    if total > _most(archive):
        raise FetchError(
            f"{archive.name} would unpack to {total:,} bytes, far more than its size may hold; it is no data"
        )
    free = shutil.disk_usage(folder).free
    if total > free:
        raise FetchError(
            f"{archive.name} unpacks to {total:,} bytes, {folder} has room for {free:,}; choose another folder"
        )


def _write(
    opened: zipfile.ZipFile,
    wanted: list[tuple[zipfile.ZipInfo, PurePosixPath]],
    archive: Path,
    folder: Path,
    told: Callable[[float], None],
) -> list[Unpacked]:
    most, total = _most(archive), sum(member.file_size for member, _ in wanted) or 1
    done: list[Unpacked] = []
    written = 0
    for member, path in wanted:
        target = folder.joinpath(*path.parts)
        target.parent.mkdir(parents=True, exist_ok=True)
        checksum = hashlib.sha256()
        begin = written
        with opened.open(member) as source, target.open("xb") as file:
            while block := source.read(BLOCK):
                written += len(block)
                if written > most:  # sizes that are told in a zip may be wrong
                    raise FetchError(f"{archive.name} unpacks to more than {most:,} bytes; it is no data")
                checksum.update(block)
                file.write(block)
                told(min(written / total, 1.0))
        done.append((path.as_posix(), written - begin, checksum.hexdigest()))
    return done
