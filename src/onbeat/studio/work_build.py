"""The job of a motion library: built in its own folder, where a build that was stopped goes on."""

from __future__ import annotations

from pathlib import Path

from onbeat.errors import OnbeatError
from onbeat.moves.library import MoveLibrary
from onbeat.studio.advice import here
from onbeat.studio.clip_list import ClipList
from onbeat.studio.tasks import BuildTask, Done
from onbeat.studio.telling import Tell

MOVES = "moves"


def built(task: BuildTask, tell: Tell) -> Done:
    """Build a library, and list its clips."""
    tell = tell.of({"moves": 1.0})
    try:
        library = _library(task, tell)
    except OnbeatError as error:
        raise OnbeatError(_named(str(error), task)) from None
    clips = [(clip.name, round(clip.seconds, 3)) for clip in library.clips if not clip.mirrored]
    problems = [_named(line, task) for line in library.problems]
    ClipList(clips, problems).write(Path(task.out))
    note = f"{len(problems)} of {len(task.files)} motions are left out" if problems else ""
    return Done(seconds=round(library.seconds, 3), clips=len(clips), note=note)


def _library(task: BuildTask, tell: Tell) -> MoveLibrary:
    from onbeat.moves.build import build_library
    from onbeat.moves.embedded import embedded_library

    def step(what: str, share: float) -> None:
        tell("moves", share, what)

    if not task.files:
        return embedded_library(step=step)
    return build_library([Path(path) for path, _ in task.files], Path(task.folder) / MOVES, step=step)


def _named(text: str, task: BuildTask) -> str:
    """What is said of files, said by the user's names of them."""
    for path, name in task.files:
        text = text.replace(path, name).replace(Path(path).name, name)
    return here(text.replace(task.folder, "the library"))
