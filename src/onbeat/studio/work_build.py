"""The job of a motion library: built in its own folder, where a build that was stopped goes on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from onbeat.errors import OnbeatError
from onbeat.formats.read import read_motion
from onbeat.moves.build import build_recordings
from onbeat.moves.engine import Engine
from onbeat.moves.library import MoveLibrary
from onbeat.moves.making.generations import Options
from onbeat.moves.recordings import Recording, find_recordings
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
    from onbeat.moves.embedded import embedded_library

    def step(what: str, share: float) -> None:
        tell("moves", share, what)

    if not task.files:
        return embedded_library(step=step)
    found = find_recordings([Path(path) for path, _ in task.files])
    recordings = [_at_rate(recording, task.rates) for recording in found]
    return build_recordings(recordings, Path(task.folder) / MOVES, Options(), step=step, engine=Engine(workers=2))


def _at_rate(recording: Recording, rates: Mapping[str, float]) -> Recording:
    """The recording at the rate that the user said, if there is one: as another recording, for it moves otherwise."""
    rate = rates.get(str(recording.path))
    if rate is None or recording.path is None:
        return recording
    digest = hashlib.sha256(f"{recording.digest} {rate!r}".encode()).hexdigest() if recording.digest else ""
    return replace(recording, digest=digest, read=partial(read_motion, recording.path, rate), path=None)


def _named(text: str, task: BuildTask) -> str:
    """What is said of files, said by the user's names of them."""
    for path, name in task.files:
        text = text.replace(path, name).replace(Path(path).name, name)
    return here(text.replace(task.folder, "the library"))
