"""Exports of a project: dances as files to take away."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import Response

from onbeat.errors import OnbeatError
from onbeat.studio.answers import FieldError, answer, file_answer, order
from onbeat.studio.export_formats import FILM, exported_file, format_for
from onbeat.studio.studio import Studio
from onbeat.studio.wire import DanceItem, ExportItem, ExportOrder, FilmOrder

_FORBIDDEN = '/\\:*?"<>|'


async def order_export(request: Request) -> Response:
    """``POST /api/dances/ID/exports``: a dance in a format, and the job that writes it."""
    studio: Studio = request.app.state.studio
    dance = studio.ready("dances", request.path_params["id"], DanceItem)
    told = await order(request, ExportOrder)
    try:
        chosen = format_for(told.format, dance)
    except OnbeatError as error:
        raise FieldError("format", str(error)) from None
    film = _film(told)
    with studio.folder.change() as document:
        id = document.new_id("export")
        file = file_name(f"{dance.name}{_film_words(film)}", chosen.ending)
        job = studio.jobs.add("export", id, f"writing {file}", [dance.id, dance.song])
        item = ExportItem(id, dance.id, chosen.name, file, film, job=job.id)
        document.put("exports", item)
    studio.jobs.look()
    return answer(item, 201)


async def take_export(request: Request) -> Response:
    """``GET /api/exports/ID``: the file."""
    studio: Studio = request.app.state.studio
    item = studio.ready("exports", request.path_params["id"], ExportItem)
    return file_answer(exported_file(studio.folder, item), "application/octet-stream", item.file)


async def remove_export(request: Request) -> Response:
    """``DELETE /api/exports/ID``."""
    studio: Studio = request.app.state.studio
    item = studio.item("exports", request.path_params["id"], ExportItem)
    studio.remove("exports", item.id)
    return Response(status_code=204)


def _film(told: ExportOrder) -> FilmOrder | None:
    """How a video is to be; as usual where nothing is said of it, and refused where it is none."""
    if told.format != FILM:
        if told.film is not None:
            raise FieldError("film", f"film is for the format {FILM}; {told.format[:40]!r} is ordered")
        return None
    from onbeat.viewer.video import check_film

    film = FilmOrder() if told.film is None else told.film
    try:
        check_film((film.width, film.height), film.fps)
    except OnbeatError as error:
        raise FieldError("film", str(error)) from None
    return film


def _film_words(film: FilmOrder | None) -> str:
    """What of a video is not as usual, for its name: two of one dance are told apart.

    Examples
    --------
    >>> _film_words(FilmOrder(1080, 1920, flash=True)), _film_words(FilmOrder())
    (', 1080x1920, flashes', '')
    """
    if film is None:
        return ""
    usual = FilmOrder()
    size = "" if (film.width, film.height) == (usual.width, usual.height) else f", {film.width}x{film.height}"
    rate = "" if film.fps == usual.fps else f", {film.fps:g} fps"
    return size + rate + (", flashes" if film.flash else "")


def file_name(name: str, ending: str) -> str:
    """What a file is called when it is taken away: as its dance, without what file systems refuse.

    Examples
    --------
    >>> file_name('a/b: "c"', ".glb")
    'a b c.glb'
    """
    plain = " ".join("".join(" " if c in _FORBIDDEN else c for c in name).split()).strip(". ")
    return (plain or "dance") + ending
