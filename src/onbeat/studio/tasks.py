"""What a job's process is told to do, and what it tells on the way: lines of JSON over its pipes.

A task names every file that is read and the folder that is written, so that its process needs no project.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import msgspec

from onbeat.studio.wire import BeatsData, FilmOrder, Mark


class SoundSource(msgspec.Struct, frozen=True):
    """A song: the user's file (none for the embedded song), what was heard, and the user's corrections if any."""

    name: str
    file: str | None
    heard: str = ""
    beats: BeatsData | None = None


class ListenTask(msgspec.Struct, frozen=True, tag="listen"):
    """Hear a song: sound.wav, song.json and curves.json."""

    out: str
    song: SoundSource


class LookTask(msgspec.Struct, frozen=True, tag="look"):
    """Look at motion files, each an id, a path and a name: ID.json of each that can be read.

    ``rates`` are the frames a second of those of which the user said so, by their ids.
    """

    out: str
    files: list[tuple[str, str, str]]
    rates: dict[str, float] = {}


class BuildTask(msgspec.Struct, frozen=True, tag="build"):
    """Build a motion library in ``folder`` of files (path and name), or the troupe's for none: clips.json.

    ``rates`` are the frames a second of those of which the user said so, by their paths.
    """

    out: str
    folder: str
    files: list[tuple[str, str]]
    rates: dict[str, float] = {}


class KeptDance(msgspec.Struct, frozen=True):
    """A stretch to keep of the dance in a folder, in seconds of what it was before it was retimed."""

    folder: str
    from_s: float
    to_s: float


class DanceTask(msgspec.Struct, frozen=True, tag="dance"):
    """Dance to a song: the files of a dance (:mod:`onbeat.studio.dance_folder`); no ``library`` is the troupe's."""

    out: str
    name: str
    song: SoundSource
    library: str | None
    marks: dict[str, Literal["forbidden", "favourite"]]
    start: float
    seconds: float | None
    method: str
    seed: int
    intensity_weight: float
    keep: list[KeptDance] = []
    speed: float = 1.0
    robot: str | None = None


class RetimeTask(msgspec.Struct, frozen=True, tag="retime"):
    """The dance that a folder's was made of at another speed of its music, on a robot or not: files as of a dance."""

    out: str
    name: str
    folder: str
    speed: float
    robot: str | None = None


class ExportTask(msgspec.Struct, frozen=True, tag="export"):
    """The dance of a folder as a file; it is heard from second ``start`` of ``sound`` on, ``speed`` times as fast.

    ``film`` says how a video is to be.
    """

    out: str
    file: str
    format: str
    folder: str
    sound: str
    start: float
    speed: float
    robot: str | None = None
    film: FilmOrder = FilmOrder()


Task = ListenTask | LookTask | BuildTask | DanceTask | RetimeTask | ExportTask


class Progress(msgspec.Struct, frozen=True, tag="progress"):
    """How far a job is, 0…1, and what is done now."""

    share: float
    message: str


class MotionSeen(msgspec.Struct, frozen=True):
    """What was seen in a motion file, or why it cannot be used."""

    id: str
    error: str | None = None
    seconds: float = 0.0
    fps: float = 0.0
    body: str = ""
    note: str = ""
    rate_stored: bool = True


class Done(msgspec.Struct, frozen=True, tag="done"):
    """All is made; what of it is told in the project: of each kind of job some fields only."""

    seconds: float = 0.0
    tempo: float = 0.0
    meter: int = 4
    clips: int = 0
    f50: float | None = None
    note: str = ""
    seen: list[MotionSeen] = []


class Failed(msgspec.Struct, frozen=True, tag="failed"):
    """It cannot be done, and why."""

    error: str


Said = Progress | Done | Failed
LINE = 1 << 20
"""Bytes of the longest line."""


def marks_of(marks: Mapping[str, Mark], mark: Mark) -> list[str]:
    """Names of the clips with a mark, in order.

    Examples
    --------
    >>> marks_of({"walk": "forbidden", "jump": "favourite", "fall": "forbidden"}, "forbidden")
    ['fall', 'walk']
    """
    return sorted(name for name, found in marks.items() if found == mark)
