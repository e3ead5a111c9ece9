"""What is heard in a song: beats, downbeats, chord changes, intensity; and its document, ``song.json``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import msgspec
import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import AudioError

VERSION = 1

Said = msgspec.Meta


class IntensityDocument(msgspec.Struct, frozen=True):
    """Intensity over time."""

    times: Annotated[list[float], Said(description="seconds")]
    values: Annotated[list[float], Said(description="0…1, one for each time")]


class SongDocument(msgspec.Struct, frozen=True):
    """``song.json``: what is heard in a song; times in seconds from its start."""

    version: Annotated[int, Said(description="of this document; others are refused")]
    duration: Annotated[float, Said(description="seconds")]
    tempo: Annotated[float, Said(description="beats a minute, from a line through the beats; 0 without beats")]
    meter: Annotated[int, Said(description="beats in a bar")]
    beats: Annotated[list[float], Said(description="seconds")]
    downbeats: Annotated[list[float], Said(description="seconds, a subset of the beats")]
    chord_change: Annotated[list[float], Said(description="0…1 for each beat: how much the harmony changes there")]
    intensity: Annotated[IntensityDocument, Said(description="how intense the music is")]
    method: Annotated[str, Said(description="which method heard it")] = ""
    title: Annotated[str, Said(description="the song's name, for people")] = ""
    beat_strength: Annotated[list[float], Said(description="0…1 for each beat: its accent; 1 where it is left out")] = (
        msgspec.field(default_factory=list[float])
    )


def _frozen(values: object) -> Array:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


@dataclass(frozen=True, eq=False)
class Song:
    """What a dance needs to know of a song.

    Parameters
    ----------
    duration : seconds.
    tempo : beats per minute, from a line through the beats; 0 where no beat is heard.
    meter : beats in a bar.
    beats : (B,) seconds.
    downbeats : seconds, a subset of the beats.
    chord_change : (B,) degree of chord change at each beat, 0…1.
    intensity_times : (N,) seconds.
    intensity : (N,) musical intensity, 0…1.
    method : which method heard it.
    title : its name, for people.
    beat_strength : (B,) accent of each beat, 0…1; all 1 where nothing is given.

    Examples
    --------
    >>> song = Song(2.0, 120.0, 4, [0.5, 1.0, 1.5], [0.5], [1, 0, 0], [0, 1], [0.2, 0.8])
    >>> float(song.intensity_at(np.array([0.5]))[0])
    0.5
    """

    duration: float
    tempo: float
    meter: int
    beats: Times
    downbeats: Times
    chord_change: Array
    intensity_times: Times
    intensity: Array
    method: str = ""
    title: str = ""
    beat_strength: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        if not len(self.beat_strength):
            object.__setattr__(self, "beat_strength", np.ones(len(self.beats)))
        for name in ("beats", "downbeats", "chord_change", "intensity_times", "intensity", "beat_strength"):
            object.__setattr__(self, name, _frozen(getattr(self, name)))
        if len(self.beat_strength) != len(self.beats):
            raise AudioError(f"a song with {len(self.beats)} beats has {len(self.beat_strength)} beat strengths")
        if len(self.chord_change) != len(self.beats) or len(self.intensity) != len(self.intensity_times):
            raise AudioError(
                f"a song with {len(self.beats)} beats has {len(self.chord_change)} chord changes, and "
                f"{len(self.intensity)} intensities at {len(self.intensity_times)} times; they must agree"
            )

    def intensity_at(self, times: Times) -> Array:
        """Intensity at any times, by linear interpolation."""
        if not len(self.intensity):
            return np.zeros(len(times))
        return np.interp(times, self.intensity_times, self.intensity)

    def cut(self, start: float, seconds: float) -> Song:
        """The song from ``start`` on for ``seconds``, its times shifted to begin at 0."""
        end = min(start + seconds, self.duration)
        inside = (self.beats >= start) & (self.beats < end)
        within = (self.intensity_times >= start) & (self.intensity_times < end)
        return Song(
            duration=max(end - start, 0.0),
            tempo=self.tempo,
            meter=self.meter,
            beats=self.beats[inside] - start,
            downbeats=self.downbeats[(self.downbeats >= start) & (self.downbeats < end)] - start,
            chord_change=self.chord_change[inside],
            intensity_times=self.intensity_times[within] - start,
            intensity=self.intensity[within],
            method=self.method,
            title=self.title,
            beat_strength=self.beat_strength[inside],
        )

    def document(self) -> SongDocument:
        """The song as its document; times to 0.1 ms, values to 1e-4."""
        return SongDocument(
            version=VERSION,
            duration=round(self.duration, 4),
            tempo=round(self.tempo, 3),
            meter=self.meter,
            beats=np.round(self.beats, 4).tolist(),
            downbeats=np.round(self.downbeats, 4).tolist(),
            chord_change=np.round(self.chord_change, 4).tolist(),
            intensity=IntensityDocument(
                np.round(self.intensity_times, 4).tolist(), np.round(self.intensity, 4).tolist()
            ),
            method=self.method,
            title=self.title,
            beat_strength=np.round(self.beat_strength, 4).tolist(),
        )

    def to_json(self) -> bytes:
        """The document as JSON bytes."""
        return msgspec.json.encode(self.document()) + b"\n"

    @classmethod
    def from_json(cls, data: bytes, source: str = "song.json") -> Song:
        """Read a document; an ``AudioError`` says what is wrong with it."""
        try:
            document = msgspec.json.decode(data, type=SongDocument)
        except msgspec.DecodeError as error:
            raise AudioError(f"{source}: not a song document: {error}; write one with `onbeat listen`") from None
        if document.version != VERSION:
            raise AudioError(f"{source}: version {document.version}; this onbeat reads version {VERSION}")
        return cls(
            document.duration,
            document.tempo,
            document.meter,
            np.array(document.beats),
            np.array(document.downbeats),
            np.array(document.chord_change),
            np.array(document.intensity.times),
            np.array(document.intensity.values),
            document.method,
            document.title,
            np.array(document.beat_strength),
        )
