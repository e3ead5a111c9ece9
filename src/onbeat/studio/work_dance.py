"""The job of a dance: the song as the user has it, the library with its marks, the dance, and what the page shows."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from msgspec import structs
from threadpoolctl import threadpool_limits

from onbeat.dance.make import LONGEST, Dance, make_dance
from onbeat.dance.score import INTENSITY
from onbeat.dance.wishes import Kept, Wishes
from onbeat.errors import OnbeatError, PlanError
from onbeat.moves.library import MoveLibrary
from onbeat.music.fixes import Corrections
from onbeat.music.listen import listen
from onbeat.music.song import Song
from onbeat.studio.dance_folder import ROOT, SHOWN, StoredDance, write_scene
from onbeat.studio.dance_stages import made_again, stages_of_dancing
from onbeat.studio.song_view import bar_length
from onbeat.studio.tasks import DanceTask, Done, RetimeTask, SoundSource, marks_of
from onbeat.studio.telling import Tell
from onbeat.studio.wire import BeatsData, Mark
from onbeat.studio.work_build import MOVES
from onbeat.studio.work_listen import SOUND, with_name
from onbeat.viewer.pages.dance import dance_page_data
from onbeat.viewer.pages.graph_drawn import drawn_graph


def danced(task: DanceTask, tell: Tell) -> Done:
    """Dance, and put the dance in another time and on a robot where that is asked for."""
    tell, out = tell.of(stages_of_dancing(task.robot, task.speed)), Path(task.out)
    song = danced_song(task, tell)
    library = _library(task, tell)
    with threadpool_limits(1, "blas"):
        dance = _made(task, song, library, tell)
    stored = StoredDance(dance.motion.replace(name=task.name), dance.document, dance.song)
    stored.write(out, ROOT)
    if made_again(task.robot, task.speed):
        from onbeat.studio.work_retime import again_as

        order = RetimeTask(str(out), task.name, str(out), task.speed, task.robot)
        graph = drawn_graph(library, [move.clip for move in dance.document.moves])
        done = again_as(order, stored, graph, tell)
        return structs.replace(done, note="\n".join(filter(None, (_shortened(task, song), done.note))))
    stored.write(out, SHOWN)
    write_scene(out, dance_page_data(dance, library, None, stored.keyposes))
    f50 = dance.document.metrics["beats"]["f50"]
    return Done(seconds=dance.motion.duration, tempo=dance.song.tempo, f50=f50, note=_shortened(task, song))


def _shortened(task: DanceTask, song: Song) -> str:
    """That less is danced than was asked for, where the song ends before."""
    if task.seconds is None or task.seconds <= song.duration + 0.05:
        return ""
    return f"{task.seconds:g} seconds were asked for; the song ends after {song.duration:.1f}"


def danced_song(task: DanceTask, tell: Tell) -> Song:
    """The stretch to dance to, with the beats that the user sees.

    Raises
    ------
    PlanError
        If it is too long, or not in the song.
    """
    heard = Song.from_json(Path(task.song.heard).read_bytes(), task.song.name)
    seconds = heard.duration - task.start if task.seconds is None else task.seconds
    if seconds <= 0:
        raise PlanError(f"the dance begins at {task.start:g} s, but {task.song.name} lasts {heard.duration:.1f} s")
    if seconds > LONGEST:
        raise PlanError(
            f"a dance of {seconds / 60:.0f} minutes; one lasts at most {LONGEST / 60:.0f}: choose a stretch"
        )
    if task.song.beats is not None:
        heard = _heard_anew(task.song, heard, tell)
    return replace(heard.cut(task.start, seconds), title=task.song.name)


def _heard_anew(source: SoundSource, heard: Song, tell: Tell) -> Song:
    """The song with the user's beats: chords and accents are heard at them."""
    assert source.beats is not None
    sound = Path(source.heard).with_name(SOUND)
    lines = "".join(f"{time:.4f}\n" for time in source.beats.beats)
    if source.beats.downbeats:
        lines = "".join(
            f"{time:.4f} {place}\n" for time, place in _places(source.beats, bar_length(source.beats, heard.meter))
        )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "beats.txt"
        path.write_text(lines, "ascii")
        try:
            return listen(
                sound, progress=lambda s: tell("listening", s / heard.duration), corrections=Corrections(beats=path)
            )
        except OnbeatError as error:
            raise OnbeatError(with_name(str(error), source, sound, path)) from None


def _places(told: BeatsData, bar: int) -> list[tuple[float, int]]:
    """Of each beat its place in the bar from 1; those before the first downbeat end a bar of the usual length."""
    down = set(told.downbeats)
    first = next(k for k, beat in enumerate(told.beats) if beat in down)
    places: list[tuple[float, int]] = []
    place = 0
    for number, beat in enumerate(told.beats):
        place = (number - first) % max(bar, 1) + 1 if number < first else 1 if beat in down else place + 1
        places.append((beat, place))
    return places


def _library(task: DanceTask, tell: Tell) -> MoveLibrary:
    from onbeat.moves.embedded import embedded_library
    from onbeat.moves.store import open_library

    if task.library is None:
        return embedded_library(step=lambda what, share: tell("moves", share, what))
    tell("moves", 0.0)
    return open_library(Path(task.library) / MOVES)


def _made(task: DanceTask, song: Song, library: MoveLibrary, tell: Tell) -> Dance:
    names = {clip.name for clip in library.clips}
    marks: dict[str, Mark] = {name: mark for name, mark in task.marks.items() if name in names}
    kept = [Kept(StoredDance.read(Path(k.folder), ROOT).document, k.from_s, k.to_s) for k in task.keep]
    wishes = Wishes(
        frozenset(marks_of(marks, "forbidden")), frozenset(marks_of(marks, "favourite")), tuple(kept)
    )  # fmt: skip
    return make_dance(
        song,
        library,
        seed=task.seed,
        method=task.method,
        rhythm_only=task.intensity_weight == 0,
        intensity_weight=None if task.intensity_weight == 1 else INTENSITY * task.intensity_weight,
        wishes=wishes,
        step=lambda what, share: tell(what, share),
    )
