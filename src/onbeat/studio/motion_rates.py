"""Frames a second of motions whose files store none: what the user says is kept, and libraries are made anew of it."""

from __future__ import annotations

from collections.abc import Collection

from msgspec.structs import replace
from starlette.requests import Request
from starlette.responses import Response

from onbeat.studio.answers import FieldError, answer, order
from onbeat.studio.motions import look_at
from onbeat.studio.records import ProjectDocument
from onbeat.studio.studio import InUseError, Studio
from onbeat.studio.wire import LibraryItem, MotionItem, RatedMotions, RateOrder

SLOWEST, FASTEST = 1.0, 1000.0
"""Frames a second of a motion."""


async def say_rate(request: Request) -> Response:
    """``PUT /api/motions/rate``: frames a second of some motions, which are read again, and so their libraries.

    Dances that were made stay as they are: they are the user's, and may be danced again.
    """
    studio: Studio = request.app.state.studio
    told = await order(request, RateOrder)
    if told.fps is not None and not SLOWEST <= told.fps <= FASTEST:
        raise FieldError("fps", f"{told.fps:g} frames a second: give {SLOWEST:g} to {FASTEST:g}")
    if not told.motions:
        raise FieldError("motions", "name a motion or more of the project whose rate it is")
    motions = [_motion(studio, id) for id in dict.fromkeys(told.motions)]
    libraries = _libraries(studio, {item.id for item in motions})
    with studio.folder.change() as document:
        read = look_at(studio, document, [replace(item, rate=told.fps) for item in motions])
        built = [_built_again(studio, document, item) for item in libraries]
    studio.jobs.look()
    return answer(RatedMotions(read, built))


def _motion(studio: Studio, id: str) -> MotionItem:
    """A motion that was looked at: only then is it known what its file says."""
    item = studio.item("motions", id, MotionItem)
    if item.state == "waiting":
        raise InUseError(f"{item.name} {item.lacks or 'is being looked at'}; say its rate when it was read")
    return item


def _libraries(studio: Studio, motions: Collection[str]) -> list[LibraryItem]:
    """The libraries of motions that have to be built again; those that wait for their turn come after this anyway."""
    with_them = [
        item for item in studio.folder.document.libraries.values() if not set(motions).isdisjoint(item.motions)
    ]
    for item in with_them:
        if item.job is not None and studio.job(item.job).state == "running":
            raise InUseError(f"{item.name} is being built of it; wait until it is done, or cancel that")
    return [item for item in with_them if item.state == "ready"]


def _built_again(studio: Studio, document: ProjectDocument, item: LibraryItem) -> LibraryItem:
    job = studio.jobs.add("build", item.id, f"the moves of {item.name}", item.motions)
    item = replace(item, state="waiting", job=job.id, error=None)
    document.put("libraries", item)
    return item
