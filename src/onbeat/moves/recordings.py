"""Recordings: the motion files a library is made of, known by their content."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import NamedTuple

from onbeat.errors import FormatError, LibraryError
from onbeat.fetch import Receipt, receipt_above
from onbeat.formats.acclaim.read import skeleton_file
from onbeat.formats.read import motion_files, read_motion
from onbeat.motion.motion import Motion
from onbeat.motion.role_file import roles_beside


class About(NamedTuple):
    """What is told of a recording, where it is: who dances, what, and under which licence it may be used."""

    performer: str | None = None
    genre: str | None = None
    licence: str | None = None


@dataclass(frozen=True)
class Recording:
    """One motion that can be read when it is needed.

    Parameters
    ----------
    name : for people and plans, no two alike in a library.
    file : where it was found, relative to the folder that was given.
    digest : SHA-256 of its content (with its skeleton and roles files'), so that what changed is known unread.
    read : reads it.
    path : where it lies; nowhere if a program made it.
    about : what is told of it.
    """

    name: str
    file: str
    digest: str
    read: Callable[[], Motion] = field(compare=False)
    path: Path | None = field(default=None, compare=False)
    about: About = field(default=About(), compare=False)

    @property
    def content(self) -> str:
        """What a reading of it depends on: its digest and the kind of file; nothing ("") if it cannot be read."""
        return self.digest and self.digest + Path(self.file).suffix.lower()

    def has_changed(self) -> bool:
        """Whether its content is no longer what it was when it was found."""
        return self.path is not None and content_digest(self.path) != self.digest


def find_recordings(paths: Sequence[Path], fps: float | None = None) -> list[Recording]:
    """The recordings in files and folders, in the order given and sorted within folders, each file once.

    Parameters
    ----------
    paths : motion files and folders of them.
    fps : the rate of files that store none.

    Raises
    ------
    LibraryError
        If a path does not exist or there is no motion file in all of them.
    """
    found: dict[Path, tuple[Path, str]] = {}
    for path in paths:
        for file, label in _files(Path(path)):
            found.setdefault(file.resolve(), (file, os.fsencode(label).decode(errors="replace")))
    if not found:
        places = ", ".join(str(path) for path in paths) or "no path"
        raise LibraryError(f"no motion files in {places}; give a folder of motion files (docs/files.md)")
    files = list(found.values())
    with ThreadPoolExecutor(4) as pool:  # most of the time is spent waiting for the disk
        digests = list(pool.map(content_digest, (file for file, _ in files)))
    names = _names([label for _, label in files])
    told = _told_by_receipts([file.resolve() for file, _ in files])
    return [
        Recording(name, label, digest, partial(read_motion, file, fps or rate), file, about)
        for (file, label), name, digest, (rate, about) in zip(files, names, digests, told, strict=True)
    ]


def _told_by_receipts(files: Sequence[Path]) -> list[tuple[float | None, About]]:
    """Of each file what the receipt of data that was fetched tells: its rate, where it stores none, and what it is."""
    receipts = {folder: receipt_above(folder / "file") for folder in {file.parent for file in files}}
    return [_told(receipts[file.parent], file.name) for file in files]


def _told(receipt: Receipt | None, file: str) -> tuple[float | None, About]:
    if receipt is None:
        return None, About()
    about = About(receipt.performer_of(file), receipt.genre or None, receipt.licence)
    return (None if receipt.fps_stored else receipt.fps), about


def _files(path: Path) -> list[tuple[Path, str]]:
    """The files of a path, of a folder all but the dances that onbeat made there, and what they are called in it."""
    if path.is_dir():
        return [(file, file.relative_to(path).as_posix()) for file in motion_files(path) if not _is_made(file)]
    if not path.exists():
        raise LibraryError(f"no file or folder {path}; give a folder of motion files (docs/files.md)")
    return [(path, path.name)]


def _is_made(file: Path) -> bool:
    """Whether a file is a dance that was made of clips: it is none itself, should it lie in their folder."""
    return file.name == "dance.bvh" and (file.parent / "dance.json").is_file()


def _names(labels: list[str]) -> list[str]:
    """File stems; where two are alike, with suffix, then with folders, then with a number."""
    named = labels
    choices = ([Path(label).stem for label in labels], [Path(label).name for label in labels], labels)
    for choice in reversed(choices):
        counts = Counter(choice)
        named = [short if counts[short] == 1 else name for short, name in zip(choice, named, strict=True)]
    seen: Counter[str] = Counter()
    unique: list[str] = []
    for name in named:
        seen[name] += 1
        unique.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return unique


def content_digest(file: Path) -> str:
    """SHA-256 of a motion file with its roles file and, for AMC, its skeleton file; unreadable files have none ("")."""
    files = [file]
    if file.suffix.lower() == ".amc":
        with contextlib.suppress(FormatError):  # an AMC without its ASF; reading says so
            files.append(skeleton_file(file))
    if (roles := roles_beside(file)) is not None:
        files.append(roles)
    total = hashlib.sha256()
    try:
        for part in files:
            with part.open("rb") as opened:
                while block := opened.read(1 << 20):
                    total.update(block)
    except OSError:
        return ""
    return total.hexdigest()


def motion_digest(motion: Motion) -> str:
    """SHA-256 of a motion in memory."""
    told = motion.skeleton.roles.items()
    total = hashlib.sha256(repr((motion.skeleton.names, motion.fps, *told)).encode())
    skeleton = motion.skeleton
    for array in (skeleton.parents, skeleton.offsets, skeleton.end_sites, motion.rotations, motion.root_positions):
        total.update(array.tobytes())
    if motion.translations is not None:
        total.update(motion.translations.tobytes())
    return total.hexdigest()
