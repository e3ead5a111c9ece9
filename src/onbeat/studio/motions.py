"""Motion files of a project: taken in, one or an archive of them, and shown."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from msgspec.structs import replace
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from onbeat.studio.answers import FieldError, answer, order
from onbeat.studio.archives import Found, is_archive, one_file, shown_names, unpacked
from onbeat.studio.project import INCOMING
from onbeat.studio.records import ProjectDocument
from onbeat.studio.skeletons import (
    MOTION,
    SKELETON,
    is_skeleton,
    lacks_skeleton,
    put_beside,
    skeleton_of,
    what_it_lacks,
)
from onbeat.studio.studio import InUseError, Studio, clean_name
from onbeat.studio.uploads import discard, received
from onbeat.studio.wire import MotionItem, SkeletonOrder, TakenMotions

VIEW = "view.json"
MOST_TOLD = 100
"""Names of files that are passed over in an archive, beyond which no more are told."""


async def take_motions(request: Request) -> Response:
    """``POST /api/motions?name=walk.bvh``: a motion file or a zip of several, and the job that looks at them."""
    studio: Studio = request.app.state.studio
    name = clean_name(request.query_params.get("name", ""), "motion")
    upload = await received(request, studio.folder, studio.largest)
    folder = studio.folder.scratch(INCOMING)
    kept = studio.folder.folder / "motions"
    try:
        found = await run_in_threadpool(partial(_files, upload, folder, name, studio.largest))
        lacking = await run_in_threadpool(partial(_lacking, found.files, kept))
        items, woken = _taken(studio, folder, found.files, lacking)
    finally:
        discard(upload)
        shutil.rmtree(folder, ignore_errors=True)
    studio.jobs.look()
    return answer(TakenMotions(items, [clean_name(name, "?") for name in found.passed_over[:MOST_TOLD]], woken), 201)


def _files(upload: Path, folder: Path, name: str, largest: int) -> Found:
    if not name.lower().endswith(".npz") and is_archive(upload):  # NumPy's archives are zip files, too
        files, passed_over = unpacked(upload, folder, largest)
        return Found([(path, shown) for (path, _), shown in zip(files, shown_names(files), strict=True)], passed_over)
    return one_file(upload, folder, name)


def _lacking(found: Sequence[tuple[Path, str]], kept: Path) -> set[Path]:
    """The files that have to wait: AMC files that find no skeleton here nor in the project, and skeletons alone."""
    alone = [path for path, _ in found if is_skeleton(path.name)]
    waiting = set(alone)
    for path in (path for path, _ in found if lacks_skeleton(path)):
        skeleton = skeleton_of(path, alone) or skeleton_of(path, kept.rglob(f"*{SKELETON}"))
        if skeleton is None:
            waiting.add(path)
        else:
            put_beside(skeleton, path)
    return waiting


def _taken(
    studio: Studio, folder: Path, found: Sequence[tuple[Path, str]], lacking: set[Path]
) -> tuple[list[MotionItem], list[MotionItem]]:
    """New motions whose files lie in a folder, which becomes that of the first; and those that find a skeleton now."""
    with studio.folder.change() as document:
        items = [MotionItem(document.new_id("motion"), clean_name(name, "motion")) for _, name in found]
        items = [
            replace(item, lacks=what_it_lacks(path) if path in lacking else "")
            for item, (path, _) in zip(items, found, strict=True)
        ]
        woken = _woken(studio, document, [path for path in lacking if is_skeleton(path.name)])
        for item, (path, _) in zip(items, found, strict=True):
            document.put("motions", item)
            document.places[item.id] = f"motions/{items[0].id}/{path.relative_to(folder).as_posix()}"
        looked_at = look_at(studio, document, [*(item for item in items if not item.lacks), *woken])
        os.replace(folder, studio.folder.fresh("motions", items[0].id))
    now = {item.id: item for item in looked_at}
    return [now.get(item.id, item) for item in items], [now[item.id] for item in woken]


def _woken(studio: Studio, document: ProjectDocument, skeletons: Sequence[Path]) -> list[MotionItem]:
    """Motions of the project that waited for one of some skeletons, or could not be read with the one they had."""
    woken: list[MotionItem] = []
    for item in document.motions.values():
        given = studio.folder.given(item.id)
        if (item.lacks or item.state == "failed") and (skeleton := skeleton_of(given, skeletons)) is not None:
            put_beside(skeleton, given)
            woken.append(item)
    return woken


def look_at(studio: Studio, document: ProjectDocument, items: Sequence[MotionItem]) -> list[MotionItem]:
    """Motions with a job that looks at all of them, inside a change of the project."""
    if not items:
        return []
    more = f" and {len(items) - 1} more" if len(items) > 1 else ""
    job = studio.jobs.add("look", items[0].id, f"looking at {items[0].name}{more}", [])
    waiting = [replace(item, state="waiting", job=job.id, error=None, lacks="") for item in items]
    for item in waiting:
        document.put("motions", item)
    return waiting


async def choose_skeleton(request: Request) -> Response:
    """``PUT /api/motions/ID/skeleton``: an AMC file that waits is read with a skeleton of another name."""
    studio: Studio = request.app.state.studio
    told = await order(request, SkeletonOrder)
    item = studio.item("motions", request.path_params["id"], MotionItem)
    skeleton = studio.folder.document.motions.get(told.skeleton)
    if skeleton is None or not is_skeleton(skeleton.name):
        raise FieldError("skeleton", f"no skeleton {told.skeleton[:40]!r} in this project; drop its .asf file")
    given = studio.folder.given(item.id)
    if not (item.lacks or item.state == "failed") or given.suffix != MOTION:
        raise InUseError(f"{item.name} waits for no skeleton")
    put_beside(studio.folder.given(skeleton.id), given)
    with studio.folder.change() as document:
        [item] = look_at(studio, document, [item])
    studio.jobs.look()
    return answer(item)


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
