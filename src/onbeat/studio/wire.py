"""What goes between the studio's server and its page: JSON under ``/api``, each kind of it a class here.

The page's own view (``viewer-js/src/studio/contract.ts``) is written from these classes:
``python -m onbeat.studio.wire > viewer-js/src/studio/contract.ts``; a test keeps the two equal. Seconds, metres,
radians; all times of a song are on its own clock, those of a dance on the dance's: second ``t`` of a dance sounds as
second ``start + speed t`` of its song. Described for others in ``docs/studio.md``.
"""

from __future__ import annotations

import sys
from typing import Literal

import msgspec

from onbeat.viewer.contract import CurveData, MetricData, PageData
from onbeat.viewer.typescript import declarations

VERSION = 1
"""Of what is spoken here; the page refuses another."""
JobState = Literal["waiting", "running", "done", "failed", "cancelled"]
JobKind = Literal["listen", "look", "build", "dance", "retime", "robot", "export"]
State = Literal["waiting", "ready", "failed", "cancelled"]
Mark = Literal["forbidden", "favourite"]


class JobItem(msgspec.Struct, frozen=True):
    """A job: what is to be done for the item ``of``, how far it is (``share`` 0…1) and how long it will take."""

    id: str
    kind: Literal["listen", "look", "build", "dance", "retime", "robot", "export"]
    of: str
    title: str
    state: Literal["waiting", "running", "done", "failed", "cancelled"]
    share: float = 0.0
    left_s: float | None = None
    message: str = ""
    error: str | None = None


class SongItem(msgspec.Struct, frozen=True):
    """A song of the project; ``job`` works on it, ``error`` says why it is ``failed``."""

    id: str
    name: str
    state: Literal["waiting", "ready", "failed", "cancelled"] = "waiting"
    job: str | None = None
    error: str | None = None
    duration: float = 0.0
    tempo: float = 0.0
    meter: int = 4
    edited: bool = False


class MotionItem(msgspec.Struct, frozen=True):
    """A motion file of the project; ``body`` says in words who moves, ``note`` what was guessed of the file.

    ``fps`` are its frames a second: those that the user said (``rate``), else those it stores, or those that were
    assumed where ``rate_stored`` is false. ``lacks`` says what a file that waits without a job waits for: an AMC for
    its skeleton, or a skeleton for its motions.
    """

    id: str
    name: str
    state: Literal["waiting", "ready", "failed", "cancelled"] = "waiting"
    job: str | None = None
    error: str | None = None
    seconds: float = 0.0
    fps: float = 0.0
    body: str = ""
    note: str = ""
    rate: float | None = None
    rate_stored: bool = True
    lacks: str = ""


class LibraryItem(msgspec.Struct, frozen=True):
    """A motion library made of ``motions``; that with the id ``troupe`` is always there, made of none."""

    id: str
    name: str
    state: Literal["waiting", "ready", "failed", "cancelled"] = "waiting"
    job: str | None = None
    error: str | None = None
    motions: list[str] = []
    clips: int = 0
    seconds: float = 0.0
    note: str = ""


class KeptStretch(msgspec.Struct, frozen=True):
    """A stretch of an earlier dance, in seconds of its clock, that the new one is to have at the same time."""

    dance: str
    from_s: float
    to_s: float


class DanceOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What is to be danced: ``seconds`` of the song from ``start`` on, all of it for none.

    ``intensity_weight`` is the λ of the papers against its usual value: 0 follows the beat alone, 1 as usual. ``speed``
    is that of the music, ``robot`` the name of who is to dance it, none for a character.
    """

    song: str
    library: str = "troupe"
    start: float = 0.0
    seconds: float | None = None
    method: str = "optimal"
    seed: int = 0
    intensity_weight: float = 1.0
    robot: str | None = None
    speed: float = 1.0
    keep: list[KeptStretch] = []
    name: str = ""


class DanceItem(msgspec.Struct, frozen=True):
    """A dance: ``danced`` to an order, or the dance ``source`` ``retimed`` to another speed or put on a ``robot``.

    Its second t sounds as second ``start + speed t`` of its song.
    """

    id: str
    name: str
    kind: Literal["danced", "retimed", "robot"]
    order: DanceOrder
    state: Literal["waiting", "ready", "failed", "cancelled"] = "waiting"
    job: str | None = None
    error: str | None = None
    source: str | None = None
    song: str = ""
    start: float = 0.0
    speed: float = 1.0
    robot: str | None = None
    seconds: float = 0.0
    f50: float | None = None
    note: str = ""


class FilmOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A video: pixels across and down, pictures a second, and whether a ring runs over the floor on every beat."""

    width: int = 1280
    height: int = 720
    fps: float = 30.0
    flash: bool = False


class ExportItem(msgspec.Struct, frozen=True):
    """A dance as a file to take away, at ``/api/exports/ID`` once it is ready; ``file`` is its name there."""

    id: str
    dance: str
    format: str
    file: str
    film: FilmOrder | None = None
    state: Literal["waiting", "ready", "failed", "cancelled"] = "waiting"
    job: str | None = None
    error: str | None = None
    bytes: int = 0


class RobotItem(msgspec.Struct, frozen=True):
    """A robot that a dance can be put on."""

    name: str
    title: str


class MethodItem(msgspec.Struct, frozen=True):
    """A method of choosing moves, and what it does in a sentence."""

    name: str
    title: str


class FormatItem(msgspec.Struct, frozen=True):
    """A format of exports: ``who`` can be written in it, and which package is ``missing`` for it, or none."""

    name: str
    title: str
    who: Literal["all", "characters", "robots", "g1"]
    missing: str = ""


class Project(msgspec.Struct, frozen=True):
    """All that is in the project; ``revision`` grows with each change."""

    version: int
    name: str
    revision: int
    largest: int
    songs: list[SongItem]
    motions: list[MotionItem]
    libraries: list[LibraryItem]
    dances: list[DanceItem]
    exports: list[ExportItem]
    jobs: list[JobItem]
    robots: list[RobotItem]
    methods: list[MethodItem]
    formats: list[FormatItem]


class SongView(msgspec.Struct, frozen=True):
    """What is heard in a song, or put right by the user (``edited``); ``chord_change`` and ``confidence`` per beat.

    ``heard_beats`` are those that were heard, whatever the user put in their place.
    """

    id: str
    name: str
    duration: float
    tempo: float
    meter: int
    beats: list[float]
    downbeats: list[float]
    chord_change: list[float]
    confidence: list[float]
    intensity: CurveData
    waveform: CurveData
    edited: bool
    key: str = ""
    heard_beats: list[float] = []


class BeatsData(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Beats as the user has them, seconds of the song; the downbeats are some of them."""

    beats: list[float]
    downbeats: list[float] = []


class MotionView(msgspec.Struct, frozen=True):
    """What is seen in a motion file, and ``scene`` to play it."""

    id: str
    name: str
    seconds: float
    fps: float
    body: str
    note: str
    stops: list[float]
    intensity: CurveData
    keyposes: list[float]
    scene: PageData


class TakenMotions(msgspec.Struct, frozen=True):
    """What was taken of a motion file or an archive of them, and names of what is in the archive and was not.

    ``found`` are motions that waited for a skeleton that has come now.
    """

    motions: list[MotionItem]
    passed_over: list[str]
    found: list[MotionItem] = []


class RateOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Frames a second of motions whose files store none, or a wrong rate; what their files say for none."""

    motions: list[str]
    fps: float | None


class RatedMotions(msgspec.Struct, frozen=True):
    """Motions that are read again at another rate, and the libraries that are built again of them."""

    motions: list[MotionItem]
    libraries: list[LibraryItem]


class SkeletonOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The skeleton, one of the project's motions that is an ASF file, with which an AMC file is to be read."""

    skeleton: str


class LibraryOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A library to build of motions of the project."""

    name: str
    motions: list[str]


class ClipItem(msgspec.Struct, frozen=True):
    """A clip of a library; ``mark`` is what the user wants of it."""

    name: str
    seconds: float
    mark: Literal["forbidden", "favourite"] | None = None


class LibraryView(msgspec.Struct, frozen=True):
    """A library's clips, without their mirror images, and the files that are left out of it, a line each."""

    item: LibraryItem
    clips: list[ClipItem]
    problems: list[str]


class DanceView(msgspec.Struct, frozen=True):
    """A dance to look at: ``scene`` is what a dance page holds, without the sound; ``metrics`` are all its figures."""

    item: DanceItem
    metrics: list[MetricData]
    scene: PageData


class RetimeOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The same dance at another speed of its music, inside the body's limits."""

    speed: float
    name: str = ""


class RobotOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The same dance on a robot."""

    robot: str
    name: str = ""


class ExportOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A dance as a file; ``film`` is for a video, which without it is as usual."""

    format: str
    film: FilmOrder | None = None


class NameOrder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Another name."""

    name: str


class ErrorData(msgspec.Struct, frozen=True):
    """Why something is refused, in a sentence, and which field of what was sent is meant."""

    error: str
    field: str | None = None


class EventData(msgspec.Struct, frozen=True, omit_defaults=True):
    """What ``/api/events`` tells: the project changed, or a job went on."""

    revision: int | None = None
    job: JobItem | None = None


STRUCTS = (
    JobItem, SongItem, MotionItem, LibraryItem, KeptStretch, DanceOrder, DanceItem, FilmOrder, ExportItem,
    RobotItem, MethodItem, FormatItem, Project, SongView, BeatsData, MotionView, TakenMotions, RateOrder,
    RatedMotions, SkeletonOrder, LibraryOrder, ClipItem, LibraryView, DanceView, RetimeOrder, RobotOrder,
    ExportOrder, NameOrder, ErrorData, EventData,
)  # fmt: skip
"""All classes that go over the wire, parts before the whole."""


def typescript() -> str:
    """The page's view of all this; what dance pages have too it takes from their contract."""
    made = declarations(STRUCTS, VERSION, "python -m onbeat.studio.wire", "wire.py")
    head, _, rest = made.partition("\n\n")
    return f'{head}\n\nimport type {{ CurveData, MetricData, PageData }} from "../contract";\n\n{rest}'


if __name__ == "__main__":
    sys.stdout.write(typescript())
