"""What failed or was cancelled, tried again: by a new job, of what is kept in the project."""

from __future__ import annotations

from typing import NamedTuple

from msgspec.structs import replace
from starlette.requests import Request
from starlette.responses import Response

from onbeat.studio.answers import answer
from onbeat.studio.records import Item, Shelf
from onbeat.studio.studio import InUseError, NotHereError, Studio
from onbeat.studio.wire import DanceItem, JobKind, LibraryItem, MotionItem, SongItem

SHELVES: dict[str, Shelf] = {"songs": "songs", "motions": "motions", "libraries": "libraries", "dances": "dances"}


class _Work(NamedTuple):
    """A job to be: its kind, what is said of it, and the items that it needs."""

    kind: JobKind
    title: str
    needs: list[str]


async def try_again(request: Request) -> Response:
    """``POST /api/SHELF/ID/again``: an item that failed or was cancelled, and a new job for it."""
    studio: Studio = request.app.state.studio
    shelf = SHELVES.get(request.path_params["shelf"])
    if shelf is None:
        raise NotHereError(f"nothing of {request.path_params['shelf'][:40]!r} is tried again")
    item = _found(studio, shelf, request.path_params["id"])
    if item.state not in ("failed", "cancelled"):
        raise InUseError(f"{item.id} is {item.state}; what failed or was cancelled is tried again")
    work = _work(item)
    with studio.folder.change() as document:
        job = studio.jobs.add(work.kind, item.id, work.title, work.needs)
        item = replace(item, state="waiting", error=None, job=job.id)
        document.put(shelf, item)
    studio.jobs.look()
    return answer(item)


def _found(studio: Studio, shelf: Shelf, id: str) -> Item:
    found = studio.folder.document.shelf(shelf).get(id)
    if found is None:
        raise NotHereError(f"no {id[:40]!r} among the {shelf} of this project")
    return found


def _work(item: Item) -> _Work:
    match item:
        case SongItem():
            return _Work("listen", f"listening to {item.name}", [])
        case MotionItem():
            return _Work("look", f"looking at {item.name}", [])
        case LibraryItem():
            return _Work("build", f"the moves of {item.name}", item.motions)
        case DanceItem(kind="danced", order=order):
            needs = [order.song, order.library, *(stretch.dance for stretch in order.keep)]
            return _Work("dance", f"dancing {item.name}", list(dict.fromkeys(needs)))
        case DanceItem(robot=None):
            return _Work("retime", f"retiming {item.name}", [item.source or "", item.song])
        case DanceItem():
            return _Work("robot", f"putting {item.name} on its feet", [item.source or "", item.song])
        case _:
            raise NotHereError(f"{item.id} is not tried again")
