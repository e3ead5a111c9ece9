"""What comes of a job: its items are ready, or say why they are not."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from msgspec.structs import replace

from onbeat.studio.export_formats import exported_file
from onbeat.studio.project import Project
from onbeat.studio.records import SHELVES, Item, JobRecord, ProjectDocument, Shelf
from onbeat.studio.tasks import Done, MotionSeen
from onbeat.studio.wire import DanceItem, ExportItem, LibraryItem, MotionItem, SongItem


def finish(project: Project, job: str, done: Done, made: Path) -> None:
    """Keep what was made and say so.

    Raises
    ------
    OnbeatError
        If it cannot be kept.
    """
    seen = {found.id: found for found in done.seen}
    for shelf, item in list(_worked_on(project.document, job)):
        if isinstance(item, MotionItem):
            _keep_view(project, made, item.id)
        else:
            project.keep(made, shelf, item.id)
    with project.change() as document:
        for shelf, item in list(_worked_on(document, job)):
            document.put(shelf, _ready(project, item, done, seen))
        _end(document, job, "done", None)


def give_up(document: ProjectDocument, job: str, state: Literal["failed", "cancelled"], error: str | None) -> None:
    """A job and what it was to make are over, inside a change of the project."""
    for shelf, item in list(_worked_on(document, job)):
        document.put(shelf, replace(item, state=state, job=None, error=error))
    _end(document, job, state, error)


def _worked_on(document: ProjectDocument, job: str) -> Iterator[tuple[Shelf, Item]]:
    """The items that a job works on."""
    for shelf in SHELVES:
        for item in document.shelf(shelf).values():
            if item.job == job:
                yield shelf, item


def _end(document: ProjectDocument, job: str, state: Literal["done", "failed", "cancelled"], error: str | None) -> None:
    """A job is over; it goes behind those that were over before, so that the oldest are forgotten first."""
    record = document.jobs.pop(job)
    share = 1.0 if state == "done" else record.item.share
    item = replace(record.item, state=state, error=error, share=share, left_s=None, message="")
    document.jobs[job] = JobRecord(item, record.needs, record.begun)


def _keep_view(project: Project, made: Path, motion: str) -> None:
    """The view of one motion of several that a job looked at."""
    view = made / f"{motion}.json"
    if view.is_file():
        own = made / f"{motion}.view"
        own.mkdir()
        view.rename(own / "view.json")
        project.keep(own, "motions", motion)


def _ready(project: Project, item: Item, done: Done, seen: dict[str, MotionSeen]) -> Item:
    """An item with what was found out about it."""
    if isinstance(item, MotionItem):
        return _seen(item, seen[item.id])
    item = replace(item, state="ready", job=None, error=None)
    if isinstance(item, SongItem):
        return replace(item, duration=done.seconds, tempo=done.tempo, meter=done.meter)
    if isinstance(item, LibraryItem):
        return replace(item, clips=done.clips, seconds=done.seconds, note=done.note)
    if isinstance(item, DanceItem):
        return replace(item, seconds=done.seconds, f50=done.f50, note=done.note)
    assert isinstance(item, ExportItem)
    return replace(item, bytes=exported_file(project, item).stat().st_size)


def _seen(item: MotionItem, found: MotionSeen) -> MotionItem:
    if found.error is not None:
        return replace(item, state="failed", job=None, error=found.error, rate_stored=_is_rate_stored(item, found))
    return replace(
        item,
        state="ready",
        job=None,
        error=None,
        seconds=found.seconds,
        fps=found.fps,
        body=found.body,
        note=found.note,
        rate_stored=_is_rate_stored(item, found),
    )


def _is_rate_stored(item: MotionItem, found: MotionSeen) -> bool:
    """What was seen without the user's word; with it, nobody asks the file."""
    return found.rate_stored if item.rate is None else item.rate_stored
