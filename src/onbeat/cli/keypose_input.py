"""What the commands about keyposes read: a motion with its beats, and examples whose keyposes are marked."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cyclopts
import numpy as np
from rich.console import Console
from rich.text import Text

from onbeat._shapes import Times
from onbeat.cli.source_rate import SourceRate
from onbeat.errors import MetricError, OnbeatError
from onbeat.formats.read import read_file, read_motion
from onbeat.keyposes.extract import Options, Reading
from onbeat.keyposes.marks import read_marks
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.thresholds import Example
from onbeat.motion import Markers, Motion
from onbeat.motion.role_file import roles_beside
from onbeat.music import Song, listen
from onbeat.music.beat_files import read_beats
from onbeat.music.tempo import danceable_beats, fold_of

MARKS = ".keyposes.csv"
SOUNDS = (".wav", ".flac", ".ogg", ".mp3", ".m4a")


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class BeatFlags:
    """Where the beats come from; without any of these, from the song.json beside a dance of onbeat's, or the motion.

    Parameters
    ----------
    music
        The song that is danced to; its beats are heard.
    beats
        The beats: a file with a time a line, or a song.json.
    song_at
        Second of the motion at which the song (or the clock of the beats) begins.
    fps
        Frames a second of a motion file that stores none (AMC).
    """

    music: Path | None = None
    beats: Path | None = None
    song_at: float = 0.0
    fps: SourceRate = None


NO_BEATS = BeatFlags()
"""None was given."""


def read_dance(path: Path, flags: BeatFlags, local: bool = True) -> tuple[Motion | Markers, Times, Times]:
    """A motion or markers, the beats on its clock, and those of them that are known to be downbeats.

    Without ``local`` markers need no known labels.
    """
    source = _source(path, flags.fps)
    return source, *beats_of(source, flags, local)


def beats_of(source: Motion | Markers, flags: BeatFlags, local: bool = True) -> tuple[Times, Times]:
    """The beats on the clock of a motion, and those of them that are known to be downbeats."""
    if flags.music and flags.beats:
        raise OnbeatError(f"--music {flags.music} and --beats {flags.beats}: give one of them")
    if not math.isfinite(flags.song_at) or (flags.song_at and not (flags.music or flags.beats)):
        raise OnbeatError(
            f"--song-at {flags.song_at:g}: give the second of the motion at which --music or --beats begin"
        )
    if flags.beats:
        listed = read_beats(flags.beats)
        down = listed.times[listed.places == 1] if listed.places is not None else np.zeros(0)
        return listed.times + flags.song_at, down + flags.song_at
    if flags.music:
        song = _heard(flags.music)
        if len(song.beats) < 2:
            raise OnbeatError(
                f"{'one beat is' if len(song.beats) else 'no beat is'} heard in {flags.music}: say where the beats are "
                "with --beats, or leave the song out, so that a pulse of the motion itself is taken"
            )
        return song.beats + flags.song_at, song.downbeats + flags.song_at
    found = motion_beats(source, local)
    tempo = 60.0 / float(np.median(np.diff(found)))
    print(f"no beats given: {len(found)} from the motion itself, {tempo:.0f} a minute", file=sys.stderr)  # noqa: T201
    return found, np.zeros(0)


def told_beats(flags: BeatFlags) -> Times:
    """The beats that are told, or heard in the song that is; none where neither is given."""
    if flags.beats:
        return read_beats(flags.beats).times + flags.song_at
    return _heard(flags.music).beats + flags.song_at if flags.music else np.zeros(0)


def _source(path: Path, fps: float | None) -> Motion | Markers:
    """What a file holds; markers of which a roles file tells the sites become the body that it tells of."""
    source = read_file(path, fps=fps)
    told = roles_beside(path) if isinstance(source, Markers) else None
    return source if told is None else read_motion(path, fps=fps)


@cache
def _heard(music: Path) -> Song:
    """The song, heard once for all motions; who may dance to other beats than are heard is told."""
    with Console(stderr=True).status(Text(f"hearing {music.name}")):
        song = listen(music)
    if fold := fold_of(song.tempo, danceable_beats(song).tempo):
        told = f"{song.tempo:.0f} BPM are heard in {music.name}; a dance that `onbeat dance` made is at {fold} of it"
        print(f"onbeat: {told}: its beats are in the song.json beside it, for --beats", file=sys.stderr)  # noqa: T201
    return song


def read_example(path: Path, options: Options, song_at: float = 0.0, fps: float | None = None) -> Example:
    """A motion with its marked keyposes (``NAME.keyposes.csv``) and its beats (``NAME.beats`` or a song) beside it.

    Raises
    ------
    MetricError
        If there are no marks beside it, or no beats and no song.
    """
    marks = path.with_name(path.stem + MARKS)
    if not marks.is_file():
        raise MetricError(f"no {marks} beside {path.name}; write the seconds of its keyposes there, one a line")
    flags = _beside(path, song_at, fps)
    source, beats, _ = read_dance(path, flags, "local" in options.order)
    truth = read_marks(marks, (len(source) - 1) / source.fps)
    return Example(Reading(source, beats, options), truth, path.name)


def _beside(path: Path, song_at: float, fps: float | None) -> BeatFlags:
    beats = path.with_suffix(".beats")
    if beats.is_file():
        return BeatFlags(beats=beats, song_at=song_at, fps=fps)
    song = next((found for ending in SOUNDS if (found := path.with_suffix(ending)).is_file()), None)
    if song is None:
        raise MetricError(
            f"no {beats.name} and no song {path.stem}.wav beside {path.name}; one of them has to give the beats"
        )
    return BeatFlags(music=song, song_at=song_at, fps=fps)
