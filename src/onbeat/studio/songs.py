"""Songs of a project: taken in, shown, heard, put right."""

from __future__ import annotations

import re
import shutil

import numpy as np
from msgspec.structs import replace
from starlette.requests import Request
from starlette.responses import Response

from onbeat.music.tempo import tempo_of
from onbeat.studio.answers import answer, file_answer, order
from onbeat.studio.orders import SOUND
from onbeat.studio.records import EMBEDDED_SONG
from onbeat.studio.song_view import BEATS, SONG, bar_length, checked_beats, keep_beats, song_view
from onbeat.studio.studio import InUseError, Studio, clean_name
from onbeat.studio.uploads import discard, received
from onbeat.studio.wire import BeatsData, SongItem

_ENDING = re.compile(r"\.[A-Za-z0-9]{1,8}$")


async def take_song(request: Request) -> Response:
    """``POST /api/songs?name=song.mp3``: a new song, and the job that hears it."""
    studio: Studio = request.app.state.studio
    name = clean_name(request.query_params.get("name", ""), "song")
    upload = await received(request, studio.folder, studio.largest)
    try:
        with studio.folder.change() as document:
            id = document.new_id("song")
            job = studio.jobs.add("listen", id, f"listening to {name}", [])
            document.put("songs", SongItem(id, name, job=job.id))
            ending = _ENDING.search(name)
            document.places[id] = f"songs/{id}/original{ending[0].lower() if ending else ''}"
            studio.folder.fresh("songs", id)
            shutil.move(upload, studio.folder.given(id))
    finally:
        discard(upload)
    studio.jobs.look()
    return answer(studio.item("songs", id, SongItem), 201)


async def show_song(request: Request) -> Response:
    """``GET /api/songs/ID``: what is heard in it."""
    studio: Studio = request.app.state.studio
    item = studio.ready("songs", request.path_params["id"], SongItem)
    return answer(song_view(studio.folder.place("songs", item.id), item))


async def play_song(request: Request) -> Response:
    """``GET /api/songs/ID/sound``: its sound, or a range of it."""
    studio: Studio = request.app.state.studio
    item = studio.ready("songs", request.path_params["id"], SongItem)
    return file_answer(studio.folder.place("songs", item.id) / SOUND, "audio/wav")


async def correct_beats(request: Request) -> Response:
    """``PUT /api/songs/ID/beats``: the user's beats in the place of those heard."""
    studio: Studio = request.app.state.studio
    item = studio.ready("songs", request.path_params["id"], SongItem)
    told = await order(request, BeatsData)
    beats = checked_beats(told, item.duration)
    folder = studio.folder.place("songs", item.id)
    meter = bar_length(beats, item.meter)
    keep_beats(folder, beats)
    tempo = tempo_of(np.array(beats.beats))
    return _changed(studio, replace(item, tempo=round(tempo, 3), meter=meter, edited=True))


async def restore_beats(request: Request) -> Response:
    """``DELETE /api/songs/ID/beats``: what was heard is back."""
    from onbeat.music.song import Song

    studio: Studio = request.app.state.studio
    item = studio.ready("songs", request.path_params["id"], SongItem)
    folder = studio.folder.place("songs", item.id)
    heard = Song.from_json((folder / SONG).read_bytes(), item.name)
    (folder / BEATS).unlink(missing_ok=True)
    return _changed(studio, replace(item, tempo=heard.tempo, meter=heard.meter, edited=False))


def _changed(studio: Studio, item: SongItem) -> Response:
    with studio.folder.change() as document:
        document.put("songs", item)
    return answer(song_view(studio.folder.place("songs", item.id), item))


async def remove_song(request: Request) -> Response:
    """``DELETE /api/songs/ID``."""
    studio: Studio = request.app.state.studio
    item = studio.item("songs", request.path_params["id"], SongItem)
    if item.id == EMBEDDED_SONG:
        raise InUseError("the embedded song stays in every project")
    studio.remove("songs", item.id)
    return Response(status_code=204)
