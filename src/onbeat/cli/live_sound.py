"""What ``onbeat live`` hears: a microphone, a file, or the embedded song, as a listener and as sound for the page."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from onbeat.cli.live_flags import HearFlags
from onbeat.errors import AudioError

if TYPE_CHECKING:
    from onbeat.live.page.http import Sound
    from onbeat.live.sound.listener import Listener

MIMES = {".wav": "audio/wav", ".flac": "audio/flac", ".ogg": "audio/ogg", ".mp3": "audio/mpeg", ".m4a": "audio/mp4"}
LARGEST = 300_000_000
"""Bytes of a sound file that the page may be given."""
EMBEDDED = 60.0
"""Seconds of the embedded song."""


@dataclass(frozen=True, eq=False)
class Played:
    """What is heard, for a page: its name, its sound and length; no sound of a microphone."""

    name: str
    sound: Sound | None = None
    seconds: float = 0.0
    loops: bool = False


@dataclass(frozen=True, eq=False)
class Source:
    """A listener, not begun, and the same for a page."""

    listener: Listener
    played: Played


def source_of(flags: HearFlags, clock: Callable[[], float] = time.monotonic, speed_up: float = 1.0) -> Source:
    """What the flags ask to hear."""
    if flags.input == "mic":
        from onbeat.live.sound.microphone import Microphone

        device = int(flags.device) if flags.device is not None and flags.device.isdecimal() else flags.device
        return Source(Microphone(device), Played("the microphone"))
    if flags.input is None:
        return _embedded(clock, speed_up)
    return _file(Path(flags.input), flags.loop, clock, speed_up)


def _embedded(clock: Callable[[], float], speed_up: float) -> Source:
    from onbeat.examples.song import demo_song, encode
    from onbeat.live.page.http import Sound
    from onbeat.live.sound.array_source import ArraySource

    song = demo_song(EMBEDDED)
    listener = ArraySource(song.samples, song.rate, speed_up, True, clock)
    return Source(listener, Played(song.title, Sound(encode(song, ".flac"), MIMES[".flac"]), song.duration, True))


def _file(path: Path, loop: bool, clock: Callable[[], float], speed_up: float) -> Source:
    from onbeat.live.page.http import Sound
    from onbeat.live.sound.file_source import FileSource
    from onbeat.music.audio import audio_duration

    seconds = audio_duration(path)
    mime = MIMES.get(path.suffix.lower())
    sound = None
    try:
        if mime is not None and path.stat().st_size <= LARGEST:
            sound = Sound(path.read_bytes(), mime)
    except OSError as error:
        raise AudioError(f"cannot read {path}: {error.strerror or error}") from None
    return Source(FileSource(path, speed_up, loop, clock), Played(path.name, sound, seconds, loop))
