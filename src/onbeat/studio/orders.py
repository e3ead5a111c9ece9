"""From a job of the project to the task of its process: which files it reads, and what else it has to know."""

from __future__ import annotations

from pathlib import Path

from onbeat.errors import OnbeatError
from onbeat.studio.export_formats import kept_name
from onbeat.studio.project import Project
from onbeat.studio.records import EMBEDDED_SONG, TROUPE
from onbeat.studio.song_view import SONG, edited_beats
from onbeat.studio.tasks import (
    BuildTask,
    DanceTask,
    ExportTask,
    KeptDance,
    ListenTask,
    LookTask,
    RetimeTask,
    SoundSource,
    Task,
)
from onbeat.studio.wire import DanceItem, ExportItem, FilmOrder, JobItem, LibraryItem

SOUND = "sound.wav"


def task_of(project: Project, job: JobItem, out: Path) -> Task:
    """What the process of a job is to do; it writes into ``out``.

    Raises
    ------
    OnbeatError
        If something it needs is gone.
    """
    document = project.document
    match job.kind:
        case "listen":
            return ListenTask(str(out), _source(project, job.of))
        case "look":
            motions = [motion for motion in document.motions.values() if motion.job == job.id]
            files = [(m.id, str(project.given(m.id)), m.name) for m in motions]
            return LookTask(str(out), files, {m.id: m.rate for m in motions if m.rate is not None})
        case "build":
            return _build(project, document.libraries[job.of], out)
        case "dance":
            return _dance(project, document.dances[job.of], out)
        case "retime" | "robot":
            return _again(project, document.dances[job.of], out)
        case "export":
            return _export(project, document.exports[job.of], out)


def _source(project: Project, id: str) -> SoundSource:
    song = project.document.songs[id]
    folder = project.place("songs", id)
    file = None if id == EMBEDDED_SONG else str(project.given(id))
    return SoundSource(song.name, file, str(folder / SONG), edited_beats(folder))


def _build(project: Project, item: LibraryItem, out: Path) -> BuildTask:
    motions = [project.document.motions[id] for id in item.motions if id in project.document.motions]
    if len(motions) < len(item.motions):
        raise OnbeatError(f"motions of the library {item.name} are gone; make another")
    folder = project.place("libraries", item.id)
    folder.mkdir(exist_ok=True)
    files = {motion.id: str(project.given(motion.id)) for motion in motions}
    rates = {files[motion.id]: motion.rate for motion in motions if motion.rate is not None}
    return BuildTask(str(out), str(folder), [(files[motion.id], motion.name) for motion in motions], rates)


def _dance(project: Project, item: DanceItem, out: Path) -> DanceTask:
    order, document = item.order, project.document
    library = None if order.library == TROUPE else str(project.place("libraries", order.library))
    kept: list[KeptDance] = []
    for stretch in order.keep:
        dance = document.dances.get(stretch.dance)
        if dance is None:
            raise OnbeatError("the dance of which a stretch is to be kept is gone; order it without")
        folder = str(project.place("dances", dance.id))
        kept.append(KeptDance(folder, stretch.from_s * dance.speed, stretch.to_s * dance.speed))
    return DanceTask(
        out=str(out),
        name=item.name,
        song=_source(project, order.song),
        library=library,
        marks=document.marks.get(order.library, {}),
        start=order.start,
        seconds=order.seconds,
        method=order.method,
        seed=order.seed,
        intensity_weight=order.intensity_weight,
        keep=kept,
        speed=order.speed,
        robot=order.robot,
    )


def _again(project: Project, item: DanceItem, out: Path) -> RetimeTask:
    if item.source is None or item.source not in project.document.dances:
        raise OnbeatError("the dance it is to be made of is gone")
    return RetimeTask(str(out), item.name, str(project.place("dances", item.source)), item.speed, item.robot)


def _export(project: Project, item: ExportItem, out: Path) -> ExportTask:
    dance = project.document.dances.get(item.dance)
    if dance is None or dance.song not in project.document.songs:
        raise OnbeatError("the dance or its song is gone")
    return ExportTask(
        out=str(out),
        file=kept_name(item.format),
        format=item.format,
        folder=str(project.place("dances", dance.id)),
        sound=str(project.place("songs", dance.song) / SOUND),
        start=dance.start,
        speed=dance.speed,
        robot=dance.robot,
        film=item.film or FilmOrder(),
    )
