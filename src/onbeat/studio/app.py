"""The studio's app: which address is answered by what."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response, StreamingResponse
from starlette.routing import Route

from onbeat.errors import OnbeatError
from onbeat.studio import dances, exports, libraries, motion_rates, motions, songs
from onbeat.studio.again import try_again
from onbeat.studio.answers import answer, refusal, refused
from onbeat.studio.guard import Guard
from onbeat.studio.page import page
from onbeat.studio.studio import InUseError, Studio


def make_app(studio: Studio, host: str = "127.0.0.1", token: str | None = None, port: int = 0) -> Guard:
    """The app over a studio that is open; it is closed when the app ends.

    Parameters
    ----------
    studio : see there.
    host, port : what the server is bound to.
    token : what has to be shown to be let in; none on this machine alone.
    """
    app = Starlette(
        routes=_routes(),
        exception_handlers={OnbeatError: _refuse, HTTPException: _refuse, OSError: _refuse, Exception: _fault},
        lifespan=_lifespan,
    )
    app.state.studio = studio
    return Guard(app, host, token, port)


@asynccontextmanager
async def _lifespan(app: Starlette) -> AsyncGenerator[None]:
    studio: Studio = app.state.studio
    studio.jobs.begin()
    try:
        yield
    finally:
        await studio.close()


def _routes() -> list[Route]:
    return [
        Route("/", _page, methods=["GET"]),
        Route("/api/project", _project, methods=["GET"]),
        Route("/api/events", _events, methods=["GET"]),
        Route("/api/jobs/{id}/cancel", _cancel, methods=["POST"]),
        Route("/api/{shelf}/{id}/again", try_again, methods=["POST"]),
        Route("/api/songs", songs.take_song, methods=["POST"]),
        Route("/api/songs/{id}", songs.show_song, methods=["GET"]),
        Route("/api/songs/{id}", songs.remove_song, methods=["DELETE"]),
        Route("/api/songs/{id}/sound", songs.play_song, methods=["GET"]),
        Route("/api/songs/{id}/beats", songs.correct_beats, methods=["PUT"]),
        Route("/api/songs/{id}/beats", songs.restore_beats, methods=["DELETE"]),
        Route("/api/motions", motions.take_motions, methods=["POST"]),
        Route("/api/motions/rate", motion_rates.say_rate, methods=["PUT"]),
        Route("/api/motions/{id}/skeleton", motions.choose_skeleton, methods=["PUT"]),
        Route("/api/motions/{id}", motions.show_motion, methods=["GET"]),
        Route("/api/motions/{id}", motions.remove_motion, methods=["DELETE"]),
        Route("/api/libraries", libraries.make_library, methods=["POST"]),
        Route("/api/libraries/{id}", libraries.show_library, methods=["GET"]),
        Route("/api/libraries/{id}", libraries.remove_library, methods=["DELETE"]),
        Route("/api/libraries/{id}/marks", libraries.mark_clips, methods=["PUT"]),
        Route("/api/dances", dances.order_dance, methods=["POST"]),
        Route("/api/dances/{id}", dances.show_dance, methods=["GET"]),
        Route("/api/dances/{id}", dances.name_dance, methods=["PATCH"]),
        Route("/api/dances/{id}", dances.remove_dance, methods=["DELETE"]),
        Route("/api/dances/{id}/retimed", dances.retime_dance, methods=["POST"]),
        Route("/api/dances/{id}/robot", dances.dance_on_robot, methods=["POST"]),
        Route("/api/dances/{id}/exports", exports.order_export, methods=["POST"]),
        Route("/api/exports/{id}", exports.take_export, methods=["GET"]),
        Route("/api/exports/{id}", exports.remove_export, methods=["DELETE"]),
    ]


async def _page(request: Request) -> Response:
    shell, headers = page()
    return HTMLResponse(shell, headers=headers)


async def _project(request: Request) -> Response:
    studio: Studio = request.app.state.studio
    return answer(studio.told())


async def _events(request: Request) -> Response:
    studio: Studio = request.app.state.studio
    if studio.events.full:
        raise InUseError("too many pages are open; close some")
    return StreamingResponse(studio.events.listen(), media_type="text/event-stream")


async def _cancel(request: Request) -> Response:
    studio: Studio = request.app.state.studio
    job = studio.job(request.path_params["id"])
    return answer(studio.jobs.cancel(job.id))


async def _refuse(request: Request, error: Exception) -> Response:
    if isinstance(error, OnbeatError):
        return refused(error)
    if isinstance(error, HTTPException):
        said = {404: "nothing is here; the page is at /", 405: f"{request.method} is not answered here"}
        return refusal(error.status_code, said.get(error.status_code, error.detail))
    assert isinstance(error, OSError)
    studio: Studio = request.app.state.studio
    name = str(error.filename or "a file").replace(f"{studio.folder.folder}/", "")
    return refusal(500, f"{name} of the project: {error.strerror or error}; delete what it is of and make it again")


async def _fault(request: Request, error: Exception) -> Response:
    """What nobody thought of; its traceback is on stderr."""
    return refusal(500, f"the studio has a fault here ({type(error).__name__}), or a file of the project is damaged")
