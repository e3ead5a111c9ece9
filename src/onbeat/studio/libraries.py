"""Motion libraries of a project: built of its motions, their clips marked."""

from __future__ import annotations

from typing import Literal

from msgspec.structs import replace
from starlette.requests import Request
from starlette.responses import Response

from onbeat.studio.answers import FieldError, answer, order
from onbeat.studio.clip_list import ClipList
from onbeat.studio.records import TROUPE
from onbeat.studio.studio import InUseError, Studio, clean_name
from onbeat.studio.wire import ClipItem, LibraryItem, LibraryOrder, LibraryView, MotionItem


async def make_library(request: Request) -> Response:
    """``POST /api/libraries``: a library of motions, and the job that builds it."""
    studio: Studio = request.app.state.studio
    told = await order(request, LibraryOrder)
    motions = list(dict.fromkeys(told.motions))
    if not motions:
        raise FieldError("motions", "a library needs one motion or more; name some of the project")
    for id in motions:
        found = studio.item("motions", id, MotionItem)
        if found.state in ("failed", "cancelled"):
            raise FieldError("motions", f"{found.name} cannot be used: {found.error or 'it was not looked at'}")
        if found.lacks:
            raise FieldError("motions", f"{found.name} cannot be used yet: {found.lacks}")
    with studio.folder.change() as document:
        id = document.new_id("library")
        item = LibraryItem(id, clean_name(told.name, "library"), motions=motions)
        job = studio.jobs.add("build", id, f"the moves of {item.name}", motions)
        item = replace(item, job=job.id)
        document.put("libraries", item)
    studio.jobs.look()
    return answer(item, 201)


async def show_library(request: Request) -> Response:
    """``GET /api/libraries/ID``: its clips and their marks."""
    studio: Studio = request.app.state.studio
    item = studio.ready("libraries", request.path_params["id"], LibraryItem)
    return answer(_view(studio, item))


async def mark_clips(request: Request) -> Response:
    """``PUT /api/libraries/ID/marks``: what the user wants of some clips, or nothing any more."""
    studio: Studio = request.app.state.studio
    item = studio.ready("libraries", request.path_params["id"], LibraryItem)
    told = await order(request, dict[str, Literal["forbidden", "favourite"] | None])
    names = {name for name, _ in ClipList.read(studio.folder.place("libraries", item.id)).clips}
    for name in told:
        if name not in names:
            raise FieldError(name, f"no clip {name[:80]!r} in {item.name}")
    with studio.folder.change() as document:
        marks = document.marks.setdefault(item.id, {})
        for name, mark in told.items():
            marks.pop(name, None)
            if mark is not None:
                marks[name] = mark
    return answer(_view(studio, item))


async def remove_library(request: Request) -> Response:
    """``DELETE /api/libraries/ID``."""
    studio: Studio = request.app.state.studio
    item = studio.item("libraries", request.path_params["id"], LibraryItem)
    if item.id == TROUPE:
        raise InUseError("the troupe stays in every project")
    studio.remove("libraries", item.id)
    return Response(status_code=204)


def _view(studio: Studio, item: LibraryItem) -> LibraryView:
    found = ClipList.read(studio.folder.place("libraries", item.id))
    marks = studio.folder.document.marks.get(item.id, {})
    clips = [ClipItem(name, seconds, marks.get(name)) for name, seconds in found.clips]
    return LibraryView(item, clips, found.problems)
