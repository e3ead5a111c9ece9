"""What a project keeps: its items, its jobs, what the user said of clips; all of it one document, ``project.json``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import msgspec

from onbeat.errors import OnbeatError
from onbeat.studio.wire import (
    DanceItem,
    ExportItem,
    JobItem,
    LibraryItem,
    MotionItem,
    SongItem,
)

VERSION = 1
"""Of ``project.json``; a newer one is refused."""
EMBEDDED_SONG, TROUPE = "song", "troupe"
"""Ids of the song and the library that are always there."""
KEPT_JOBS = 200
"""Finished jobs that are remembered."""
OVER = ("done", "failed", "cancelled")
Item = SongItem | MotionItem | LibraryItem | DanceItem | ExportItem
Shelf = Literal["songs", "motions", "libraries", "dances", "exports"]
SHELVES: tuple[Shelf, ...] = ("songs", "motions", "libraries", "dances", "exports")


class JobRecord(msgspec.Struct, frozen=True):
    """A job as it is kept: what the page sees of it, the items it cannot begin without, and how often it has begun."""

    item: JobItem
    needs: list[str] = []
    begun: int = 0


class ProjectDocument(msgspec.Struct):
    """``project.json``.

    Parameters
    ----------
    version : of this document.
    revision : how often it was written.
    made : how many ids were given away; none is ever given twice.
    songs, motions, libraries, dances, exports : items by their ids, in the order in which they came.
    places : of each song and motion the file that the user gave, relative to the project's folder.
    marks : of each library what the user wants of its clips, by their names.
    jobs : by their ids, in the order in which they are to be done.
    """

    version: int = VERSION
    revision: int = 0
    made: int = 0
    songs: dict[str, SongItem] = {}
    motions: dict[str, MotionItem] = {}
    libraries: dict[str, LibraryItem] = {}
    dances: dict[str, DanceItem] = {}
    exports: dict[str, ExportItem] = {}
    places: dict[str, str] = {}
    marks: dict[str, dict[str, Literal["forbidden", "favourite"]]] = {}
    jobs: dict[str, JobRecord] = {}

    def new_id(self, word: str) -> str:
        """An id that nothing has or had: the word and a number.

        Examples
        --------
        >>> document = ProjectDocument()
        >>> document.new_id("song"), document.new_id("dance")
        ('song-1', 'dance-2')
        """
        self.made += 1
        return f"{word}-{self.made}"

    def shelf(self, name: Shelf) -> dict[str, Item]:
        """The items of a kind."""
        return getattr(self, name)

    def found(self, id: str) -> tuple[Shelf, Item] | None:
        """The item with an id and its shelf, if there is one."""
        for name in SHELVES:
            if (item := self.shelf(name).get(id)) is not None:
                return name, item
        return None

    def put(self, name: Shelf, item: Item) -> None:
        """An item on its shelf, in the place of the one with its id."""
        self.shelf(name)[item.id] = item

    def forget_old_jobs(self) -> None:
        """Of the jobs that are over only the last are kept."""
        over = [id for id, record in self.jobs.items() if record.item.state in OVER]
        for id in over[: max(len(over) - KEPT_JOBS, 0)]:
            del self.jobs[id]

    def users(self, id: str) -> list[str]:
        """Names of what cannot do without an item: dances of a song, and what is yet to be made of it."""
        names = [dance.name for dance in self.dances.values() if dance.song == id]
        for record in self.jobs.values():
            if record.item.state not in OVER and id in record.needs:
                names.append(record.item.title)
        return list(dict.fromkeys(names))


def read_document(data: bytes, source: str) -> ProjectDocument:
    """The document of a project.

    Raises
    ------
    OnbeatError
        If it is damaged, or of a newer version.

    Examples
    --------
    >>> read_document(b'{"version": 9}', "project.json")
    Traceback (most recent call last):
    onbeat.errors.OnbeatError: project.json is of version 9; this onbeat reads version 1: use a newer onbeat
    """
    try:
        version = msgspec.json.decode(data, type=dict[str, msgspec.Raw]).get("version", msgspec.Raw(b"0"))
        found = msgspec.json.decode(version, type=int)
        if found != VERSION:
            newer = ": use a newer onbeat" if found > VERSION else ""
            raise OnbeatError(f"{source} is of version {found}; this onbeat reads version {VERSION}{newer}")
        document = msgspec.json.decode(data, type=ProjectDocument)
    except (msgspec.DecodeError, RecursionError, UnicodeError) as error:
        raise OnbeatError(
            f"{source} is damaged: {error}; bring back a copy of it, or give another folder for a new project"
        ) from None
    for shelf in SHELVES:
        _check_ids(document.shelf(shelf), source)
    _check_ids({id: record.item for id, record in document.jobs.items()}, source)
    return document


def _check_ids(items: Mapping[str, Item | JobItem], source: str) -> None:
    """Ids become names of folders: no other than those that are made here are taken from a file."""
    for id, item in items.items():
        if id != item.id or not (id.isascii() and id.replace("-", "").isalnum() and id.islower() and len(id) < 40):
            raise OnbeatError(f"{source} is damaged: {id!r} is no id of an item; bring back a copy of it")
