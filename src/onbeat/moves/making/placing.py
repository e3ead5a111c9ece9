"""Reading motion files and making clips of them: tasks that may run anywhere, each for itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from onbeat.errors import BodyError, LibraryError
from onbeat.moves.disk.layout import Shape, arrays_of
from onbeat.moves.making.clips import ChangedError, Stage, read_recording
from onbeat.moves.recordings import Recording


class Reading(NamedTuple):
    """What reading a file gave.

    Parameters
    ----------
    content : of the recording; nothing ("") where what was read is not what it was when it was found.
    body : digest of its skeleton; nothing where it cannot be used.
    seconds : how long it is.
    notes : what its reader warned of.
    problem : why it cannot be used.
    """

    content: str
    body: str = ""
    seconds: float = 0.0
    notes: tuple[str, ...] = ()
    problem: str | None = None


def look(recordings: tuple[Recording, ...]) -> tuple[Reading, ...]:
    """Read files to see whether they can be clips, and of which body."""
    return tuple(_look(recording) for recording in recordings)


def _look(recording: Recording) -> Reading:
    try:
        read = read_recording(recording)
        return Reading(recording.content, read.body, read.seconds, read.notes)
    except ChangedError as error:
        return Reading("", problem=str(error))
    except LibraryError as error:
        return Reading(recording.content, problem=str(error))


@dataclass(frozen=True)
class Place:
    """A recording that is to be put on the stage.

    Parameters
    ----------
    recording : which.
    model : the recording whose body is the stage's (see ``clips.Stage``).
    mirror : make the mirror image as well.
    """

    recording: Recording
    model: Recording
    mirror: bool


class Placed(NamedTuple):
    """The clips that were made of a recording: key of the stretch, counts, arrays of each; or why there is none."""

    content: str
    clips: tuple[tuple[str, Shape, tuple[np.ndarray, ...]], ...] = ()
    problem: str | None = None


def place(task: Place) -> Placed:
    """Make the clips of a recording, and their mirror images."""
    recording = task.recording
    try:
        made = stage_of(task.model).clips(read_recording(recording), 0, mirror=task.mirror)
        clips = tuple((stretch.key, Shape.of(clip), tuple(arrays_of(clip))) for stretch, clip in made)
        return Placed(recording.content, clips)
    except ChangedError as error:
        return Placed("", problem=str(error))
    except (BodyError, LibraryError) as error:
        return Placed(recording.content, problem=str(error))


@lru_cache(maxsize=2)
def stage_of(model: Recording) -> Stage:
    """The stage that a recording tells; read once in each process."""
    return Stage(read_recording(model))


def batches(recordings: Sequence[Recording], size: int = 8) -> list[tuple[Recording, ...]]:
    """Recordings in parts, each read by one task."""
    return [tuple(recordings[start : start + size]) for start in range(0, len(recordings), size)]
