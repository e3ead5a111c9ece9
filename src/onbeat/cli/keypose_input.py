"""What the commands about keyposes read: a motion with its beats, and examples whose keyposes are marked."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import cyclopts
import numpy as np
from rich.console import Console
from rich.text import Text

from onbeat._shapes import Times
from onbeat.errors import MetricError, OnbeatError
from onbeat.formats.read import read_file
from onbeat.keyposes.extract import Options, Reading
from onbeat.keyposes.motion_tempo import motion_beats
from onbeat.keyposes.thresholds import Example
from onbeat.motion import Markers, Motion
from onbeat.music import listen
from onbeat.music.beat_files import read_beats

MARKS = ".keyposes.csv"
SOUNDS = (".wav", ".flac", ".ogg", ".mp3", ".m4a")


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class BeatFlags:
    """Where the beats come from; without any of these, from the motion itself.

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
    fps: float | None = None


NO_BEATS = BeatFlags()
"""None was given."""


def read_dance(path: Path, flags: BeatFlags) -> tuple[Motion | Markers, Times, Times]:
    """A motion or markers, the beats on its clock, and those of them that are known to be downbeats."""
    if flags.music and flags.beats:
        raise OnbeatError(f"--music {flags.music} and --beats {flags.beats}: give one of them")
    source = read_file(path, fps=flags.fps)
    if flags.beats:
        listed = read_beats(flags.beats)
        down = listed.times[listed.places == 1] if listed.places is not None else np.zeros(0)
        return source, listed.times + flags.song_at, down + flags.song_at
    if flags.music:
        with Console(stderr=True).status(Text(f"hearing {flags.music.name}")):
            song = listen(flags.music)
        return source, song.beats + flags.song_at, song.downbeats + flags.song_at
    found = motion_beats(source)
    tempo = 60.0 / float(np.median(np.diff(found)))
    print(f"no music given: {len(found)} beats from the motion itself, {tempo:.0f} a minute", file=sys.stderr)  # noqa: T201
    return source, found, np.zeros(0)


def read_example(path: Path, options: Options, song_at: float = 0.0, fps: float | None = None) -> Example:
    """A motion with its marked keyposes (``NAME.keyposes.csv``) and its beats (``NAME.beats`` or a song) beside it.

    Raises
    ------
    MetricError
        If there are no marks beside it.
    """
    marks = path.with_name(path.stem + MARKS)
    if not marks.is_file():
        raise MetricError(f"no {marks} beside {path.name}; write the seconds of its keyposes there, one a line")
    source, beats, _ = read_dance(path, _beside(path, song_at, fps))
    return Example(Reading(source, beats, options), read_beats(marks).times, path.name)


def _beside(path: Path, song_at: float, fps: float | None) -> BeatFlags:
    beats = path.with_suffix(".beats")
    if beats.is_file():
        return BeatFlags(beats=beats, song_at=song_at, fps=fps)
    song = next((found for ending in SOUNDS if (found := path.with_suffix(ending)).is_file()), None)
    return BeatFlags(music=song, song_at=song_at, fps=fps)
