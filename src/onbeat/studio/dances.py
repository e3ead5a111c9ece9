"""Dances of a project: ordered, shown, retimed, put on robots, named."""

from __future__ import annotations

import re

import msgspec
from msgspec.structs import replace
from starlette.requests import Request
from starlette.responses import Response

from onbeat.errors import OnbeatError
from onbeat.studio.answers import FieldError, answer, order
from onbeat.studio.dance_orders import check_order, check_robot, check_speed
from onbeat.studio.studio import Studio, clean_name
from onbeat.studio.wire import DanceItem, DanceOrder, JobKind, LibraryItem, NameOrder, RetimeOrder, RobotOrder, SongItem
from onbeat.viewer.contract import VERSION, MetricData

SCENE = "scene.json"


class _Scene(msgspec.Struct, frozen=True):
    """Of a scene what has to be known of it here."""

    version: int
    metrics: list[MetricData]


async def order_dance(request: Request) -> Response:
    """``POST /api/dances``: a dance, and the job that makes it."""
    studio: Studio = request.app.state.studio
    told = await order(request, DanceOrder)
    check_order(studio, told)
    song = studio.item("songs", told.song, SongItem)
    library = studio.item("libraries", told.library, LibraryItem)
    name = clean_name(told.name, "") or _new_name(studio, f"{_stem(song.name)}, {library.name}")
    needs = [told.song, told.library, *(stretch.dance for stretch in told.keep)]
    item = DanceItem(
        "", name, "danced", told, song=song.id, start=told.start, speed=told.speed, robot=told.robot
    )  # fmt: skip
    return _ordered(studio, item, "dance", f"dancing {name}", list(dict.fromkeys(needs)))


def _ordered(studio: Studio, item: DanceItem, kind: JobKind, title: str, needs: list[str]) -> Response:
    with studio.folder.change() as document:
        id = document.new_id("dance")
        job = studio.jobs.add(kind, id, title, needs)
        item = replace(item, id=id, job=job.id)
        document.put("dances", item)
    studio.jobs.look()
    return answer(item, 201)


async def retime_dance(request: Request) -> Response:
    """``POST /api/dances/ID/retimed``: the same dance at another speed of its music."""
    studio: Studio = request.app.state.studio
    source = studio.ready("dances", request.path_params["id"], DanceItem)
    told = await order(request, RetimeOrder)
    check_speed(told.speed)
    before = _without(source.name, f"{source.speed:g} ×")
    name = clean_name(told.name, "") or _new_name(studio, f"{before}, {told.speed:g} ×")
    kind: JobKind = "retime" if source.robot is None else "robot"
    item = replace(_again(source, name), kind="retimed", speed=told.speed)
    return _ordered(studio, item, kind, f"retiming {name}", [source.id, source.song])


async def dance_on_robot(request: Request) -> Response:
    """``POST /api/dances/ID/robot``: the same dance on a robot."""
    studio: Studio = request.app.state.studio
    source = studio.ready("dances", request.path_params["id"], DanceItem)
    told = await order(request, RobotOrder)
    check_robot(told.robot)
    name = clean_name(told.name, "") or _new_name(studio, f"{_without(source.name, source.robot)}, {told.robot}")
    item = replace(_again(source, name), kind="robot", robot=told.robot)
    return _ordered(studio, item, "robot", f"putting {name} on its feet", [source.id, source.song])


def _again(source: DanceItem, name: str) -> DanceItem:
    """A new dance made of another."""
    return replace(
        source, id="", name=name, source=source.id, state="waiting", job=None, seconds=0.0, f50=None, note=""
    )


async def show_dance(request: Request) -> Response:
    """``GET /api/dances/ID``: its figures, and the scene that plays it."""
    studio: Studio = request.app.state.studio
    item = studio.ready("dances", request.path_params["id"], DanceItem)
    scene = (studio.folder.place("dances", item.id) / SCENE).read_bytes()
    known = msgspec.json.decode(scene, type=_Scene)
    if known.version != VERSION:
        raise OnbeatError(f"{item.name} was made by another version of onbeat; dance it again to see it")
    view = {"item": item, "metrics": known.metrics, "scene": msgspec.Raw(scene)}
    return answer(view)


async def name_dance(request: Request) -> Response:
    """``PATCH /api/dances/ID``: another name."""
    studio: Studio = request.app.state.studio
    item = studio.item("dances", request.path_params["id"], DanceItem)
    name = clean_name((await order(request, NameOrder)).name, "")
    if not name:
        raise FieldError("name", "a dance needs a name of at least one letter")
    item = replace(studio.item("dances", item.id, DanceItem), name=name)
    with studio.folder.change() as document:
        document.put("dances", item)
    return answer(item)


async def remove_dance(request: Request) -> Response:
    """``DELETE /api/dances/ID``: the dance, and what was exported of it."""
    studio: Studio = request.app.state.studio
    item = studio.item("dances", request.path_params["id"], DanceItem)
    studio.remove("dances", item.id)
    for export in [e.id for e in studio.folder.document.exports.values() if e.dance == item.id]:
        studio.remove("exports", export)
    return Response(status_code=204)


def _new_name(studio: Studio, name: str) -> str:
    """A name that no dance has yet: numbered where others have it."""
    taken = {dance.name for dance in studio.folder.document.dances.values()}
    name = clean_name(name, "dance")
    numbers = (f"{name} {number}" for number in range(2, len(taken) + 3))
    return next(one for one in (name, *numbers) if one not in taken)


def _without(name: str, part: str | None) -> str:
    """A name without one of its parts, and the number that came with it.

    Examples
    --------
    >>> _without("waltz, 1.2 × 3, g1", "1.2 ×")
    'waltz, g1'
    """
    return name if part is None else re.sub(rf", {re.escape(part)}( \d+)?(?=,|$)", "", name)


def _stem(name: str) -> str:
    """A song's name without its ending."""
    stem, dot, ending = name.rpartition(".")
    return stem if dot and stem and len(ending) <= 5 else name
