"""The studio: a project that is open, its jobs, and who listens; what the answers to requests are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from msgspec.structs import replace

from onbeat.errors import OnbeatError
from onbeat.studio.crew import COMMAND
from onbeat.studio.events import Events
from onbeat.studio.export_formats import format_items
from onbeat.studio.jobs import Jobs
from onbeat.studio.orders import task_of
from onbeat.studio.project import Project as Folder
from onbeat.studio.records import EMBEDDED_SONG, OVER, SHELVES, TROUPE, Item, Shelf
from onbeat.studio.wire import VERSION, JobItem, LibraryItem, MethodItem, Project, RobotItem, SongItem

METHODS = (
    MethodItem("optimal", "the best over the whole song, without repeats"),
    MethodItem("shiratori2006", "three seconds ahead, first the rhythm, then the intensity: as in the paper of 2006"),
    MethodItem("greedy", "three seconds ahead, on the objective of the best"),
    MethodItem("walk", "at random, to see what chance does"),
)
ROBOTS = (
    RobotItem("g1", "Unitree G1"),
    RobotItem("hrp4c", "HRP-4C"),
    RobotItem("talos", "PAL Talos"),
)
LARGEST = 1 << 30
"""Bytes of an upload."""
LONGEST_NAME = 120
_ItemT = TypeVar("_ItemT", bound=Item)


class NotHereError(OnbeatError):
    """What was asked for is not in the project."""


class InUseError(OnbeatError):
    """Something cannot be done now: others need it, or it is not ready."""


@dataclass(frozen=True, eq=False)
class Studio:
    """A project that is open.

    Parameters
    ----------
    folder : where all is kept.
    jobs, events : see there.
    largest : bytes of an upload.
    """

    folder: Folder
    jobs: Jobs
    events: Events
    largest: int = LARGEST

    @classmethod
    def open(cls, folder: Path, workers: int = 2, largest: int = LARGEST, command: Sequence[str] = COMMAND) -> Studio:
        """Open a project, a new one with the embedded song and the troupe; ``jobs.begin`` lets its jobs run.

        Parameters
        ----------
        folder : of the project.
        workers : jobs that run at once.
        largest : bytes of an upload.
        command : what a job's process runs.

        Raises
        ------
        OnbeatError
            If it cannot be opened: another studio has it, it is damaged, or of a newer version.
        """
        events = Events()
        project = Folder(folder, events.changed)
        events.revision = project.document.revision
        studio = cls(project, Jobs(project, events, partial(task_of, project), workers, command), events, largest)
        try:
            studio._complete()
        except BaseException:
            project.close()
            raise
        return studio

    def _complete(self) -> None:
        """What is in every project."""
        document = self.folder.document
        if EMBEDDED_SONG in document.songs and TROUPE in document.libraries:
            return
        with self.folder.change() as document:
            song = SongItem(EMBEDDED_SONG, "the embedded song")
            troupe = LibraryItem(TROUPE, "the troupe")
            document.put("songs", song)
            document.put("libraries", troupe)
            listen = self.jobs.add("listen", song.id, f"listening to {song.name}", [])
            build = self.jobs.add("build", troupe.id, f"the moves of {troupe.name}", [])
            document.put("songs", replace(song, job=listen.id))
            document.put("libraries", replace(troupe, job=build.id))

    async def close(self) -> None:
        """End all jobs, for now, and let others open the project."""
        self.events.end()
        await self.jobs.end()
        self.folder.close()

    def told(self) -> Project:
        """All that is in the project."""
        document = self.folder.document
        return Project(
            version=VERSION,
            name=self.folder.name,
            revision=document.revision,
            largest=self.largest,
            songs=list(document.songs.values()),
            motions=list(document.motions.values()),
            libraries=list(document.libraries.values()),
            dances=list(document.dances.values()),
            exports=list(document.exports.values()),
            jobs=self.jobs.all(),
            robots=list(ROBOTS),
            methods=list(METHODS),
            formats=format_items(),
        )

    def item(self, shelf: Shelf, id: str, kind: type[_ItemT]) -> _ItemT:
        """An item of the project; a ``NotHereError`` where there is none of this id."""
        found = self.folder.document.shelf(shelf).get(id)
        if not isinstance(found, kind):
            raise NotHereError(f"no {id[:40]!r} among the {shelf} of this project")
        return found

    def ready(self, shelf: Shelf, id: str, kind: type[_ItemT]) -> _ItemT:
        """An item that is ready; an ``InUseError`` says what it is instead."""
        found = self.item(shelf, id, kind)
        if found.state != "ready":
            why = f": {found.error}" if found.error else ""
            raise InUseError(f"{id} is not ready but {found.state}{why}")
        return found

    def job(self, id: str) -> JobItem:
        """A job; a ``NotHereError`` where there is none of this id."""
        if id not in self.folder.document.jobs:
            raise NotHereError(f"no job {id[:40]!r} in this project")
        return self.jobs.item(id)

    def remove(self, shelf: Shelf, id: str) -> None:
        """Take an item out of the project and delete its files.

        Raises
        ------
        InUseError
            If others need it.
        """
        document = self.folder.document
        if users := document.users(id):
            raise InUseError(f"{id} is needed by {', '.join(users[:3])}; delete that first")
        item = document.shelf(shelf)[id]
        if item.job is not None and self._alone(item.job) and self.job(item.job).state not in OVER:
            self.jobs.cancel(item.job)
        with self.folder.change() as document:
            del document.shelf(shelf)[id]
            place = document.places.pop(id, None)
            document.marks.pop(id, None)
        self.folder.remove_unused(shelf, id, place)

    def _alone(self, job: str) -> bool:
        """Whether a job works on one item only."""
        document = self.folder.document
        return sum(item.job == job for shelf in SHELVES for item in document.shelf(shelf).values()) == 1


def clean_name(name: str, otherwise: str) -> str:
    r"""A name as it is shown: printable, in one line, not too long.

    Examples
    --------
    >>> clean_name("../a\x00b\n c ", "song")
    '../ab c'
    """
    plain = " ".join("".join(c if c.isprintable() or c.isspace() else "" for c in name).split())
    return plain[:LONGEST_NAME].strip() or otherwise
