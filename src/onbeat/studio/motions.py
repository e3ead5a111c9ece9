"""Motion files of a project: taken in, one or an archive of them, and shown."""

from __future__ import annotations

import os
import shutil
from functools import partial
from pathlib import Path

from msgspec.structs import replace
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from onbeat.studio.answers import answer
from onbeat.studio.archives import Found, is_archive, one_file, shown_names, unpacked
from onbeat.studio.project import INCOMING
from onbeat.studio.studio import Studio, clean_name
from onbeat.studio.uploads import discard, received
from onbeat.studio.wire import MotionItem, TakenMotions

VIEW = "view.json"
MOST_TOLD = 100
"""Names of files that are passed over in an archive, beyond which no more are told."""


async def take_motions(request: Request) -> Response:
    """``POST /api/motions?name=walk.bvh``: a motion file or a zip of several, and the job that looks at them."""
    studio: Studio = request.app.state.studio
    name = clean_name(request.query_params.get("name", ""), "motion")
    upload = await received(request, studio.folder, studio.largest)
    folder = studio.folder.scratch(INCOMING)
    try:
        found = await run_in_threadpool(partial(_files, upload, folder, name, studio.largest))
        items = _taken(studio, folder, found.files)
    finally:
        discard(upload)
        shutil.rmtree(folder, ignore_errors=True)
    studio.jobs.look()
    return answer(TakenMotions(items, [clean_name(name, "?") for name in found.passed_over[:MOST_TOLD]]), 201)


def _files(upload: Path, folder: Path, name: str, largest: int) -> Found:
    if not name.lower().endswith(".npz") and is_archive(upload):  # NumPy's archives are zip files, too
        files, passed_over = unpacked(upload, folder, largest)
        return Found([(path, shown) for (path, _), shown in zip(files, shown_names(files), strict=True)], passed_over)
    return one_file(upload, folder, name)


def _taken(studio: Studio, folder: Path, found: list[tuple[Path, str]]) -> list[MotionItem]:
    """New motions whose files lie in a folder, which becomes that of the first."""
    with studio.folder.change() as document:
        items = [MotionItem(document.new_id("motion"), clean_name(name, "motion")) for _, name in found]
        first = items[0]
        more = f" and {len(items) - 1} more" if len(items) > 1 else ""
        job = studio.jobs.add("look", first.id, f"looking at {first.name}{more}", [])
        items = [replace(item, job=job.id) for item in items]
        for item, (path, _) in zip(items, found, strict=True):
            document.put("motions", item)
            document.places[item.id] = f"motions/{first.id}/{path.relative_to(folder).as_posix()}"
        os.replace(folder, studio.folder.fresh("motions", first.id))
    return items


async def show_motion(request: Request) -> Response:
    """``GET /api/motions/ID``: what is seen in it."""
    studio: Studio = request.app.state.studio
    item = studio.ready("motions", request.path_params["id"], MotionItem)
    view = (studio.folder.place("motions", item.id) / VIEW).read_bytes()
    return Response(view, media_type="application/json")


async def remove_motion(request: Request) -> Response:
    """``DELETE /api/motions/ID``."""
    studio: Studio = request.app.state.studio
    item = studio.item("motions", request.path_params["id"], MotionItem)
    studio.remove("motions", item.id)
    return Response(status_code=204)
