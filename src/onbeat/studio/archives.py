"""Archives of motion files: unpacked with care, for whoever made one may mean ill.

A name that leads out of the folder and a link are refused with the whole archive. How much comes out is counted while
it comes, not believed; of what is in it only files that may be motion are taken.
"""

from __future__ import annotations

import re
import shutil
import stat
import zipfile
import zlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import IO, NamedTuple

from onbeat.errors import OnbeatError

BESIDE = (".asf", ".toml")
"""Endings of what motion files need beside them."""
MOST_FILES, MOST_ENTRIES = 2000, 20000
RATIO, FREE = 200, 10 << 20
"""By how much a file may have been packed, counted from so many bytes on."""
BLOCK = 1 << 16
TAIL, DIRECTORY = 66_000, 8 << 20
"""Bytes at the end in which the table of contents is told of, and those that it may have."""
DEEPEST = 16
"""Folders in folders."""


# Readers are imported where they are asked: a studio opens without them.


@cache
def motion_endings() -> tuple[str, ...]:
    """Endings of motion files.

    Examples
    --------
    >>> motion_endings()[:3]
    ('.bvh', '.amc', '.c3d')
    """
    from onbeat.formats.registry import FORMATS

    return tuple(dict.fromkeys(known.suffix for known in FORMATS if known.read))


@dataclass
class _Left:
    """Bytes that may still come out."""

    total: int
    files: int = MOST_FILES
    names: Counter[str] = field(default_factory=Counter[str])


def is_archive(path: Path) -> bool:
    """Whether a file is a zip archive by its first bytes."""
    with path.open("rb") as file:
        return file.read(4) in (b"PK\x03\x04", b"PK\x05\x06")


class Found(NamedTuple):
    """Motion files, and skeletons beside none, with the names that they had; and the names of what is neither."""

    files: list[tuple[Path, str]]
    passed_over: list[str]


def unpacked(archive: Path, folder: Path, largest: int) -> Found:
    """The motion files of an archive, written into a folder, and what else is in it.

    Parameters
    ----------
    archive : the zip file.
    folder : empty; names in it are made of those in the archive, of letters, digits, dots and dashes only.
    largest : bytes that may come out in all.

    Raises
    ------
    OnbeatError
        If it is damaged, locked by a password, too large when unpacked, or holds names that lead out of it, links or no
        motion.
    """
    from onbeat.formats.read import motion_files

    told: dict[Path, str] = {}
    other: list[str] = []
    _check_directory(archive)
    try:
        with zipfile.ZipFile(archive) as opened:
            left, entries = _Left(largest), opened.infolist()
            if len(entries) > MOST_ENTRIES:
                raise OnbeatError(f"the archive has {len(entries)} entries; up to {MOST_ENTRIES} are taken")
            for entry in entries:
                _check_name(entry)
            for entry in entries:
                if _is_wanted(entry):
                    path = _place(folder, entry.filename, left)
                    _unpack(opened, entry, path, left)
                    told[path] = entry.filename
                elif not _is_hidden(entry):
                    other.append(entry.filename)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise OnbeatError(f"the archive cannot be read: {error}; pack it again without a password") from None
    found = [file for file in motion_files(folder) if file in told] if told else []
    used = {*found, *_beside(found)}
    found += [path for path in told if path.suffix == ".asf" and path.parent not in used]
    used.update(found)
    for path in [path for path in told if path not in used and not (path.suffix == ".asf" and path.parent in used)]:
        path.unlink()
        other.append(told.pop(path))
    if not found:
        raise OnbeatError(f"no motion files in the archive; expected some of {', '.join(motion_endings())}")
    return Found([(file, told[file]) for file in found], sorted(other))


def plain_name(name: str) -> str:
    """A name of letters, digits, dots and dashes, which every file system takes; the last ending is in lower case.

    Examples
    --------
    >>> plain_name("Wałek 1.BVH"), plain_name("../..")
    ('Wa_ek_1.bvh', '_')
    """
    stem, dot, ending = re.sub(r"[^A-Za-z0-9._-]", "_", name).strip(".").rpartition(".")
    plain = f"{stem[:80]}{dot}{ending[:40].lower()}".lstrip(".-")
    plain = re.sub(r"(^|\.)roles\.toml$", r"\1roles.toml", plain, flags=re.IGNORECASE)
    return plain or "_"


def _check_directory(archive: Path) -> None:
    """Refuse a table of contents that would fill the memory, before it is read."""
    with archive.open("rb") as file:
        file.seek(max(archive.stat().st_size - TAIL, 0))
        tail = file.read()
    end, long_end = tail.rfind(b"PK\x05\x06"), tail.rfind(b"PK\x06\x06")
    size = int.from_bytes(tail[end + 12 : end + 16], "little") if end >= 0 else 0
    if size == 0xFFFFFFFF and long_end >= 0:
        size = int.from_bytes(tail[long_end + 40 : long_end + 48], "little")
    if size > DIRECTORY:
        raise OnbeatError(f"the archive's table of contents has {size} bytes; up to {DIRECTORY} are taken")


def _check_name(entry: zipfile.ZipInfo) -> None:
    """Refuse what leads out of the folder; a link may."""
    name = entry.filename.replace("\\", "/")
    parts = name.split("/")
    if name.startswith("/") or ".." in parts or re.match(r"[A-Za-z]:", name) or "\0" in entry.orig_filename:
        raise OnbeatError(f"the archive holds the name {entry.filename[:80]!r}, which leads out of it; it is refused")
    if stat.S_ISLNK(entry.external_attr >> 16):
        raise OnbeatError(f"the archive holds a link ({entry.filename[:80]!r}); it is refused: pack the files")
    if len(parts) > DEEPEST:
        raise OnbeatError(f"the archive holds folders in folders, {len(parts)} deep; {DEEPEST} are taken")


def _is_hidden(entry: zipfile.ZipInfo) -> bool:
    """Whether nobody means it to be seen: folders, and what systems leave in archives."""
    parts = entry.filename.replace("\\", "/").split("/")
    return entry.is_dir() or any(part.startswith(".") or part == "__MACOSX" for part in parts)


def _is_wanted(entry: zipfile.ZipInfo) -> bool:
    return not _is_hidden(entry) and entry.filename.lower().endswith((*motion_endings(), *BESIDE))


def _beside(motions: Sequence[Path]) -> set[Path | None]:
    """The files of roles that motions have, and the folders of those that have their skeleton beside them."""
    from onbeat.motion.role_file import roles_beside

    return {*map(roles_beside, motions), *(motion.parent for motion in motions if motion.suffix == ".amc")}


def _place(folder: Path, name: str, left: _Left) -> Path:
    """Where a file goes: in folders as in the archive, under plain names of which no two are alike."""
    left.files -= 1
    if left.files < 0:
        raise OnbeatError(f"the archive holds more than {MOST_FILES} files that may be motion; pack fewer")
    *folders, last = name.replace("\\", "/").split("/")
    parts = [plain_name(part) for part in folders if part not in ("", ".")]
    place = folder.joinpath(*parts)
    place.mkdir(parents=True, exist_ok=True)
    plain = plain_name(last)
    left.names[(place / plain).as_posix().lower()] += 1
    count = left.names[(place / plain).as_posix().lower()]
    return place / (plain if count == 1 else f"{count}-{plain}")


def _unpack(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, path: Path, left: _Left) -> None:
    with archive.open(entry) as source, path.open("xb") as file:
        size = _copied(source, file, entry, left)
    if size != entry.file_size:
        raise zipfile.BadZipFile(f"{entry.filename[:80]!r} has {size} bytes, not {entry.file_size}")


def _copied(source: IO[bytes], file: IO[bytes], entry: zipfile.ZipInfo, left: _Left) -> int:
    size = 0
    while block := source.read(BLOCK):
        size += len(block)
        left.total -= len(block)
        if left.total < 0:
            raise OnbeatError("the archive is too large when it is unpacked; pack fewer files")
        if size > FREE and size > RATIO * max(entry.compress_size, 1):
            raise OnbeatError(f"{entry.filename[:80]!r} in the archive grows more than {RATIO} times; it is refused")
        file.write(block)
    return size


def one_file(upload: Path, folder: Path, name: str) -> Found:
    """A single motion file or skeleton, moved into a folder under a plain name.

    Raises
    ------
    OnbeatError
        If its ending is that of no motion file.
    """
    if name.lower().endswith(".toml"):
        if not is_roles_file(name):
            raise OnbeatError(
                f"{name!r} is nothing that is taken here; roles of joints are told by a file called roles.toml, "
                "or NAME.roles.toml for one motion file"
            )
        raise OnbeatError(f"{name!r} is no motion by itself: drop it together with its motion files, or in one .zip")
    if not name.lower().endswith((*motion_endings(), ".asf")):
        endings = ", ".join(motion_endings())
        raise OnbeatError(f"{name!r} has the ending of no motion file; expected one of {endings}, or a .zip of them")
    path = folder / plain_name(name)
    shutil.move(upload, path)
    return Found([(path, name)], [])


def is_roles_file(name: str) -> bool:
    """Whether a file is called as one that tells roles.

    Examples
    --------
    >>> [is_roles_file(name) for name in ("roles.toml", "Walk.roles.toml", "limits.toml")]
    [True, True, False]
    """
    from onbeat.motion.role_file import FOLDER_FILE, SUFFIX

    return name.lower() == FOLDER_FILE or name.lower().endswith(SUFFIX)


def shown_names(found: Sequence[tuple[Path, str]]) -> list[str]:
    """What files of an archive are called: by their last names where no two are alike, else by their whole.

    Examples
    --------
    >>> shown_names([(Path("a"), "x/walk.bvh"), (Path("b"), "x/run.bvh"), (Path("c"), "y/run.bvh")])
    ['walk.bvh', 'x/run.bvh', 'y/run.bvh']
    """
    last = [name.replace("\\", "/").rpartition("/")[2] for _, name in found]
    counts = Counter(last)
    return [short if counts[short] == 1 else name for short, (_, name) in zip(last, found, strict=True)]
