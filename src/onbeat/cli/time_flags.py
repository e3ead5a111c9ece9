"""Flags of commands that play a dance in another time: its own beats and keyposes, and the time it is to be in."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import cyclopts
import numpy as np
from rich.console import Console
from rich.text import Text

from onbeat._shapes import Times
from onbeat.cli.keypose_input import BeatFlags, beats_of
from onbeat.cli.own_song import own_song
from onbeat.errors import OnbeatError
from onbeat.keyposes.document import KeyposesDocument
from onbeat.keyposes.extract import find_keyposes
from onbeat.motion import Motion
from onbeat.music import Song, listen
from onbeat.music.beat_files import read_beats
from onbeat.retime.lock import TimeMap
from onbeat.retime.meeting import Meeting, meet

LISTS = (".json", ".txt", ".beats", ".csv")
SPEEDS = (0.1, 10.0)


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class OwnFlags:
    """The dance's own time.

    Parameters
    ----------
    danced_to
        The song that the dance was danced to; its beats are heard. Without it and --beats the song.json beside a
        dance that onbeat made, else the motion's own pulse.
    beats
        The beats of the dance: a file with a time a line, or a song.json.
    song_at
        Second of the motion at which --danced-to or --beats begin.
    keyposes
        A keyposes.json; without it they are found.
    source_fps
        Frames a second of a dance that stores none.
    """

    danced_to: Path | None = None
    beats: Path | None = None
    song_at: float = 0.0
    keyposes: Path | None = None
    source_fps: float | None = None

    @property
    def flags(self) -> BeatFlags:
        """Where the beats come from, as the commands about keyposes have it."""
        if self.danced_to and self.beats:
            raise OnbeatError(f"--danced-to {self.danced_to} and --beats {self.beats}: give one of them")
        return BeatFlags(self.danced_to, self.beats, self.song_at, self.source_fps)

    def beside(self, motion: Path) -> OwnFlags:
        """These, with the beats of the song that a dance of onbeat's was made to where none are told."""
        song = own_song(motion, self.danced_to, self.beats, self.song_at)
        return self if song is None else replace(self, beats=song)

    def of(self, motion: Motion) -> tuple[Times, Times]:
        """The beats and the keyposes of a motion, in its own seconds."""
        beats, _ = beats_of(motion, self.flags)
        found = np.asarray(find_keyposes(motion, beats).times) if self.keyposes is None else self.told_keyposes
        return beats, found

    @property
    def told_keyposes(self) -> Times:
        """The keyposes of ``keyposes``, in seconds; none without it."""
        if self.keyposes is None:
            return np.zeros(0)
        try:
            data = self.keyposes.read_bytes()
        except OSError as error:
            raise OnbeatError(f"cannot read {self.keyposes}: {error.strerror or error}") from None
        document = KeyposesDocument.from_json(data, str(self.keyposes))
        return np.array([keypose.time for keypose in document.keyposes])


@cyclopts.Parameter(name="*")
@dataclass(frozen=True)
class TimeFlags:
    """The time that the dance is to be in.

    Parameters
    ----------
    speed
        How much faster.
    music
        The song to dance to, or its beats (song.json or a list); beat by beat, through changes of tempo.
    first_beat
        The music's beat, from 0, on which the dance's first is; the first downbeat without it.
    """

    speed: float | None = None
    music: Path | None = None
    first_beat: int | None = None

    def check(self) -> None:
        """Refuse what cannot be, before anything is read."""
        if self.speed is not None and self.music is not None:
            raise OnbeatError("give --speed, how much faster, or --music, the song to dance to, one of them")
        if self.speed is not None and not SPEEDS[0] <= self.speed <= SPEEDS[1]:
            raise OnbeatError(f"--speed {self.speed:g}: give {SPEEDS[0]:g} to {SPEEDS[1]:g}; 1.2 is a fifth faster")


NO_OWN, NO_TIME = OwnFlags(), TimeFlags()
"""None was given."""


@dataclass(frozen=True)
class Music:
    """What is danced to: beats in seconds, the first to dance on, the end, and the song where it was heard."""

    beats: Times
    first: int
    until: float
    song: Song | None
    path: Path


@dataclass(frozen=True)
class When:
    """The music's seconds to the dance's, when it ends at the latest, and what it is danced to."""

    warp: TimeMap
    until: float = np.inf
    music: Music | None = None
    met: Meeting | None = None

    @classmethod
    def of(cls, beats: Times, flags: TimeFlags) -> When:
        """The time that is asked for, of a dance with beats (B,)."""
        if flags.music is None:
            return cls(TimeMap.steady(flags.speed or 1.0))
        music = read_music(flags.music, flags.first_beat)
        met = meet(beats, music.beats, music.first)
        return cls(met.warp, music.until, music, met)


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
