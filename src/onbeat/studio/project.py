"""A project's folder: what is kept where in it, and every change written before it is answered.

``project.json`` has all items and jobs, ``.lock`` is held by the studio that has it open. ``songs/ID/`` holds what the
user gave, ``sound.wav``, ``song.json``, ``curves.json``, and ``beats.json`` where the user put beats right;
``motions/ID/`` what the user gave, and ``view.json``; ``libraries/ID/`` a motion library ``moves/``, and
``clips.json``; ``dances/ID/`` see :mod:`onbeat.studio.dance_folder`; ``exports/ID/`` the file. ``incoming/`` and
``work/`` hold what is being uploaded and made; they are emptied when the studio begins.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from onbeat.errors import OnbeatError
from onbeat.files import make_folder, write_atomically
from onbeat.studio.records import SHELVES, ProjectDocument, Shelf, read_document

DOCUMENT, LOCK, INCOMING, WORK = "project.json", ".lock", "incoming", "work"


class Project:
    """A project that is open; nobody else can open it until it is closed, or its process has ended.

    Parameters
    ----------
    folder : of the project; made if it is not there.
    changed : is called after each change with the new revision.
    """

    def __init__(self, folder: Path, changed: Callable[[int], None] | None = None) -> None:
        _check_folder(folder)
        self.folder = make_folder(folder).resolve()
        self.changed = changed or (lambda revision: None)
        self._lock = _held(self.folder / LOCK)
        try:
            self.is_new = not (self.folder / DOCUMENT).exists()
            self.document = ProjectDocument() if self.is_new else self._read()
            self._written = msgspec.json.encode(self.document)
            for name in (*SHELVES, INCOMING, WORK):
                self._inside(make_folder(self.folder / name))
            self._tidy()
        except BaseException:
            self.close()
            raise

    @property
    def name(self) -> str:
        """What it is called: as its folder is."""
        return self.folder.name

    def close(self) -> None:
        """Let others open it."""
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1

    @contextmanager
    def change(self) -> Generator[ProjectDocument]:
        """The document, to be changed; it is written at the end, and stays as it was if anything goes wrong.

        Raises
        ------
        OnbeatError
            If it cannot be written.
        """
        try:
            yield self.document
            self.document.revision += 1
            self.document.forget_old_jobs()
            data = msgspec.json.encode(self.document)
            write_atomically(self.folder / DOCUMENT, data)
        except BaseException:
            self.document = msgspec.json.decode(self._written, type=ProjectDocument)
            raise
        self._written = data
        self.changed(self.document.revision)

    def place(self, shelf: Shelf, id: str) -> Path:
        """The folder of an item; its id has to be one of the document's."""
        if id not in self.document.shelf(shelf):
            raise OnbeatError(f"no {id!r} among the {shelf} of this project")
        return self._inside(self.folder / shelf / id)

    def fresh(self, shelf: Shelf, id: str) -> Path:
        """The folder of a new item, empty: what a change that failed has left there goes."""
        folder = self.place(shelf, id)
        shutil.rmtree(folder, ignore_errors=True)
        return make_folder(folder)

    def given(self, id: str) -> Path:
        """The file that the user gave for a song or a motion."""
        return self._inside(self.folder / self.document.places[id])

    def scratch(self, name: str = WORK) -> Path:
        """A new empty folder that nobody else uses, for what is being made."""
        try:
            return Path(tempfile.mkdtemp(dir=self.folder / name))
        except OSError as error:
            raise OnbeatError(f"cannot write in {self.folder / name}: {error.strerror or error}") from None

    def keep(self, made: Path, shelf: Shelf, id: str) -> None:
        """Move the files of a folder into that of an item, each in one step."""
        place = make_folder(self.place(shelf, id))
        try:
            for file in sorted(made.iterdir()):
                os.replace(file, place / file.name)
        except OSError as error:
            raise OnbeatError(f"cannot write in {place}: {error.strerror or error}") from None

    def remove_unused(self, shelf: Shelf, id: str, place: str | None = None) -> None:
        """Delete the folder of an item that is gone, and its file at ``place``; files of others stay."""
        if place is not None and place not in self.document.places.values():
            with contextlib.suppress(OSError, OnbeatError):
                self._inside(self.folder / place).unlink()
        holders = {id, *([place.split("/")[1]] if place and place.count("/") > 1 else [])}
        for holder in holders - set(self.document.shelf(shelf)):
            folder = self.folder / shelf / holder
            if not self._in_use(folder):
                shutil.rmtree(folder, ignore_errors=True)

    def _inside(self, path: Path) -> Path:
        """A path that no link and no damaged document leads out of the project."""
        if not path.resolve().is_relative_to(self.folder):
            raise OnbeatError(f"{path} leads out of the project {self.folder}; remove what is there")
        return path

    def _read(self) -> ProjectDocument:
        path = self.folder / DOCUMENT
        try:
            return read_document(path.read_bytes(), str(path))
        except OSError as error:
            raise OnbeatError(f"cannot read {path}: {error.strerror or error}") from None

    def _tidy(self) -> None:
        """What a studio that ended had begun and not kept goes."""
        for name in (INCOMING, WORK):
            for left in (self.folder / name).iterdir():
                shutil.rmtree(left, ignore_errors=True) if left.is_dir() else left.unlink(missing_ok=True)
        for shelf in SHELVES:
            for folder in (self.folder / shelf).iterdir():
                if folder.name not in self.document.shelf(shelf) and not self._in_use(folder):
                    shutil.rmtree(folder, ignore_errors=True)

    def _in_use(self, folder: Path) -> bool:
        """Whether a file of another item lies there: those of one archive share a folder."""
        inside = f"{folder.relative_to(self.folder).as_posix()}/"
        return any(place.startswith(inside) for place in self.document.places.values())


def _check_folder(folder: Path) -> None:
    """Refuse to fill a folder with other things in it."""
    if folder.exists() and not folder.is_dir():
        raise OnbeatError(f"{folder} is a file; give a folder for the project")
    if not folder.exists() or (folder / DOCUMENT).exists():
        return
    with contextlib.suppress(OSError):
        there = sorted(path.name for path in folder.iterdir() if path.name != LOCK and not _is_empty(path))
        if there:
            raise OnbeatError(
                f"{folder} has no {DOCUMENT} and is not empty ({there[0]} is there); give an empty folder or a new one"
            )


def _is_empty(path: Path) -> bool:
    """Whether it is an empty folder of a project that was just being made."""
    return path.name in (*SHELVES, INCOMING, WORK) and path.is_dir() and not any(path.iterdir())


def _held(path: Path) -> int:
    """The lock, which the operating system drops when its process ends, however it ends."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise OnbeatError(f"cannot write in {path.parent}: {error.strerror or error}; choose another folder") from None
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        raise OnbeatError(
            f"{path.parent} is open in another studio; use that one, end it, or give another folder"
        ) from None
    os.set_inheritable(handle, False)
    return handle
