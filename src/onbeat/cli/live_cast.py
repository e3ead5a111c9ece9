"""Who dances in ``onbeat live``: read, and put together."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np

import onbeat
from onbeat.cli.keypose_input import BeatFlags, beats_of
from onbeat.cli.live_flags import BodyFlags, HearFlags
from onbeat.cli.progress import Stages
from onbeat.errors import LibraryError, OnbeatError
from onbeat.formats.read import read_motion

if TYPE_CHECKING:
    from onbeat.live.cast import Cast, Known
    from onbeat.moves.library import MoveLibrary


class Settings(msgspec.Struct, frozen=True):
    """All that a session depends on beside what it hears; kept with recordings."""

    motions: list[str]
    moves: str | None
    robot: str | None
    simulate: bool
    beats: str | None
    song_at: float
    fps: float | None
    tempo: str
    latency: float
    onbeat: str

    @classmethod
    def of(cls, motions: Sequence[Path], hear: HearFlags, body: BodyFlags) -> Settings:
        """From the flags; paths are made absolute, so that a recording finds them again."""
        _check(motions, body)
        robot = body.robot
        if robot is not None and Path(robot).suffix:
            robot = str(Path(robot).absolute())
        return cls(
            [str(path.absolute()) for path in motions],
            None if body.moves is None else str(body.moves.absolute()),
            robot,
            body.simulate,
            None if body.beats is None else str(body.beats.absolute()),
            body.song_at,
            body.fps,
            hear.tempo,
            hear.latency / 1000,
            onbeat.__version__,
        )

    @classmethod
    def read(cls, kept: object, folder: Path) -> Settings:
        """Those of a recording."""
        try:
            read = msgspec.convert(kept, cls)
            HearFlags(tempo=read.tempo, latency=1000 * read.latency).check()
        except (msgspec.ValidationError, OnbeatError) as error:
            raise OnbeatError(f"{folder} is a damaged recording: {error}") from None
        return read

    @property
    def tempi(self) -> tuple[float, float]:
        """Slowest and fastest beats per minute to dance in."""
        return HearFlags(tempo=self.tempo).tempi

    @property
    def body(self) -> BodyFlags:
        """Who dances."""
        moves, beats = (None if path is None else Path(path) for path in (self.moves, self.beats))
        return BodyFlags(moves, self.robot, self.simulate, beats, self.song_at, self.fps)


def cast_of(settings: Settings, stages: Stages) -> Cast:
    """The embedded troupe, a library, or choreographies; as characters or on a robot."""
    from onbeat.live import cast

    motions, flags = [Path(path) for path in settings.motions], settings.body
    if flags.robot is not None:
        from onbeat.cli.robot import read_robot
        from onbeat.live.robot.cast import on_robot

        robot = read_robot(flags.robot)
        return on_robot(known(motions, flags, stages), robot, flags.simulate, stages)
    if motions:
        return cast.following(known(motions, flags, stages))
    return cast.improvising(_library(flags.moves, stages))


def known(motions: Sequence[Path], flags: BodyFlags, stages: Stages) -> list[Known]:
    """Choreographies with their beats and keyposes; those of the embedded troupe where none is given."""
    from onbeat.keyposes.extract import find_keyposes
    from onbeat.live.cast import Known

    if not motions:
        from onbeat.examples.troupe import dance_library

        return [
            Known(one.motion, np.asarray(one.beats), np.asarray(one.keyposes)) for one in dance_library()[:EMBEDDED]
        ]
    out = list[Known]()
    for k, path in enumerate(motions):
        stages("reading", k / len(motions), path.name)
        motion = read_motion(path, fps=flags.fps).replace(name=path.stem)
        beats, down = beats_of(motion, BeatFlags(beats=flags.beats, song_at=flags.song_at))
        places = np.searchsorted(beats, down - 1e-6)
        first = int(places[0]) if len(places) else 0
        meter = round(float(np.median(np.diff(places)))) if len(places) > 1 else 4
        out.append(Known(motion, beats[first:], np.asarray(find_keyposes(motion, beats).times), max(meter, 1)))
    return out


EMBEDDED = 3
"""Choreographies of the embedded troupe that a robot dances."""


def _check(motions: Sequence[Path], flags: BodyFlags) -> None:
    if motions and flags.moves is not None:
        raise OnbeatError(f"{motions[0]} and --moves {flags.moves}: give choreographies or a library, one of them")
    if flags.moves is not None and flags.robot is not None:
        raise OnbeatError("--moves with --robot: a robot dances choreographies; give motion files without --moves")
    if flags.simulate and flags.robot is None:
        raise OnbeatError("--simulate: it is a robot that is simulated; name one with --robot")
    if flags.beats is not None and len(motions) != 1:
        raise OnbeatError(f"--beats {flags.beats}: they are those of one choreography; {len(motions)} are given")
    missing = [path for path in (*motions, flags.beats) if path is not None and not path.exists()]
    if missing:
        raise OnbeatError(f"no file {missing[0]}; give a motion file (docs/files.md)")
    if flags.moves is not None and not flags.moves.exists():
        raise LibraryError(f"no file or folder {flags.moves}; give a library or a folder of motion files to --moves")


def _library(moves: Path | None, stages: Stages) -> MoveLibrary:
    from onbeat.moves.cache import build_or_open
    from onbeat.moves.embedded import embedded_library

    def step(what: str, share: float) -> None:
        stages("moves", share, what)

    return embedded_library(step=step) if moves is None else build_or_open(moves, mirror=True, step=step)
