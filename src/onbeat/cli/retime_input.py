"""What ``onbeat retime`` reads: the dance, its beats and keyposes, the music it is to be danced to, and the limits."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.text import Text

from onbeat._shapes import Times
from onbeat.cli.keypose_input import BeatFlags, beats_of
from onbeat.errors import OnbeatError
from onbeat.formats.joint_table import is_joint_table, read_joint_table
from onbeat.formats.read import motion_files, read_motion
from onbeat.formats.robot_csv import is_robot_csv
from onbeat.keyposes.document import KeyposesDocument
from onbeat.keyposes.extract import find_keyposes
from onbeat.limits.learned import learned_limits
from onbeat.limits.limits import Limits
from onbeat.limits.named import robot_limits
from onbeat.limits.read import read_limits
from onbeat.music import Song, listen
from onbeat.music.beat_files import read_beats
from onbeat.retime.sources import Character, Robot, Source, Table, source_of

MODELS = (".toml", ".urdf", ".xml", ".mjcf")
LISTS = (".json", ".txt", ".beats", ".csv")
STEADY = 0.5  # s; beats of a table of angles that has none: only the layers' knots are on them


@dataclass(frozen=True)
class Dance:
    """A dance as it was: what moves, and its beats and keyposes in seconds of its own."""

    source: Source
    beats: Times
    keyposes: Times


@dataclass(frozen=True)
class Music:
    """What is danced to: beats in seconds, the first to dance on, the end, and the song where it was heard."""

    beats: Times
    first: int
    until: float
    song: Song | None
    path: Path


def read_source(path: Path, fps: float | None, joints: list[str] | None) -> Source:
    """The dance in a file: a table of angles, a robot's motion, or a character's."""
    if path.suffix.lower() == ".csv" and is_joint_table(path) and not is_robot_csv(path):
        return source_of(read_joint_table(path, fps=fps), joints)
    return source_of(read_motion(path, fps=fps), joints)


def read_dance_of(source: Source, flags: BeatFlags, keyposes: Path | None) -> Dance:
    """The dance with its beats, told or its own, and its keyposes, told or found."""
    told = None if keyposes is None else told_keyposes(keyposes)
    if isinstance(source, Table):
        beats = _listed(flags) if flags.beats or flags.music else np.arange(0.0, source.curve.knots.end, STEADY)
        return Dance(source, beats, np.zeros(0) if told is None else told)
    beats, _ = beats_of(source.motion, flags)
    if told is None:
        told = np.asarray(find_keyposes(source.motion, beats).times)
    return Dance(source, beats, told)


def _listed(flags: BeatFlags) -> Times:
    listed = read_beats(flags.beats).times if flags.beats else listen(flags.music).beats if flags.music else np.zeros(0)
    return listed + flags.song_at


def told_keyposes(path: Path) -> Times:
    """The keyposes of a keyposes.json, in seconds."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise OnbeatError(f"cannot read {path}: {error.strerror or error}") from None
    document = KeyposesDocument.from_json(data, str(path))
    return np.array([keypose.time for keypose in document.keyposes])


def read_music(path: Path, first: int | None) -> Music:
    """The beats of a song that is heard, or those that are listed in a file; the first to dance on is a downbeat."""
    if path.suffix.lower() in LISTS:
        listed = read_beats(path)
        down = np.flatnonzero(listed.places == 1) if listed.places is not None else np.zeros(0, dtype=np.int64)
        song, beats, until = None, listed.times, np.inf
    else:
        with Console(stderr=True).status(Text(f"hearing {path.name}")):
            song = listen(path)
        beats, until = song.beats, song.duration
        down = np.flatnonzero(np.isin(song.beats, song.downbeats))
    if not len(beats):
        raise OnbeatError(f"{path}: no beats found; give a song that has some, or a list of beats")
    return Music(beats, int(down[0]) if first is None and len(down) else first or 0, float(until), song, path)


def limits_for(source: Source, robot: str | None, paths: list[Path]) -> Limits:
    """The limits of a robot by name, of a file that tells them, or learned from motions, at last from the dance's own.

    Raises
    ------
    OnbeatError
        If both a robot and files are given, or a table of angles has neither.
    """
    if robot and paths:
        raise OnbeatError(f"--robot {robot} and --limits {paths[0]}: give one of them")
    if robot:
        return robot_limits(robot)
    if paths and paths[0].suffix.lower() in MODELS:
        if len(paths) > 1:
            raise OnbeatError(f"{len(paths)} files of limits; one of them is needed: {paths[0]}")
        return read_limits(paths[0])
    if isinstance(source, Character):
        examples = [source.motion] if not paths else [read_motion(path) for path in _motions(paths)]
        return learned_limits(examples, skeleton=source.motion.skeleton)
    if isinstance(source, Robot) and not paths:
        return robot_limits("g1")
    raise OnbeatError("the limits of a robot are not learned from motions; give --robot NAME or --limits FILE.toml")


def _motions(paths: list[Path]) -> list[Path]:
    out = list[Path]()
    for path in paths:
        out += motion_files(path) if path.is_dir() else [path]
    if not out:
        raise OnbeatError(f"no motion files found in {', '.join(map(str, paths))}")
    return out
