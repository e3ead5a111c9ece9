"""What is heard in a song: beats, downbeats, chord changes, intensity; and its document, ``song.json``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

import msgspec
import numpy as np

from onbeat._shapes import Array, Times
from onbeat.errors import AudioError
from onbeat.music.tempo_curve import TempoCurve, tempo_curve

VERSION = 1

ARRAYS = ("beats", "downbeats", "chord_change", "intensity_times", "intensity", "beat_strength", "confidence")

Said = msgspec.Meta


class IntensityDocument(msgspec.Struct, frozen=True):
    """Intensity over time."""

    times: Annotated[list[float], Said(description="seconds")]
    values: Annotated[list[float], Said(description="0…1, one for each time")]


class TempoDocument(msgspec.Struct, frozen=True):
    """The tempo as it wanders: a line through the eight beats around each."""

    times: Annotated[list[float], Said(description="seconds: the beats")] = msgspec.field(default_factory=list[float])
    bpm: Annotated[list[float], Said(description="beats a minute, one for each time")] = msgspec.field(
        default_factory=list[float]
    )


class SectionDocument(msgspec.Struct, frozen=True):
    """A stretch of the song that is of one kind."""

    start: Annotated[float, Said(description="seconds")]
    end: Annotated[float, Said(description="seconds: where the next begins, or the song ends")]
    kind: Annotated[str, Said(description="`intro`, `build-up`, `break`, `main` or `ending`")]
    novelty: Annotated[float, Said(description="0…1: how much the music changes at its start; 0 for the first")] = 0.0


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
    confidence: Annotated[
        list[float], Said(description="0…1 for each beat: how likely it is right; none where that is not known")
    ] = msgspec.field(default_factory=list[float])
    tempo_curve: Annotated[TempoDocument, Said(description="the tempo as it wanders; follows from the beats")] = (
        msgspec.field(default_factory=TempoDocument)
    )
    chord_root: Annotated[
        list[str],
        Said(
            description="from each beat to the next the chord, by its root and third: `C:maj`, `A:min`, `N` for no "
            "chord; none where they are not known"
        ),
    ] = msgspec.field(default_factory=list[str])
    sections: Annotated[
        list[SectionDocument], Said(description="one after the other over all of the song; none where not known")
    ] = msgspec.field(default_factory=list[SectionDocument])
    key: Annotated[str, Said(description="`G:minor`; empty where none is heard or it is not known")] = ""
    tuning: Annotated[float, Said(description="cents above A = 440 Hz, −50…50")] = 0.0


@dataclass(frozen=True)
class Section:
    """A stretch of a song: ``start`` and ``end`` in seconds, one of ``sections.KINDS``, how new it is at its start."""

    start: float
    end: float
    kind: str
    novelty: float = 0.0


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
    confidence : (B,) how likely each beat is right, 0…1; empty where that is not known.
    chord_root : B chords, ``C:maj``, ``A:min`` or ``N``, each from a beat to the next; empty where not known.
    sections : one after the other, over all of the song; empty where not known.
    key : ``G:minor``; empty where none is heard.
    tuning : cents above A = 440 Hz.

    Confidence and chords of another number than the beats are not kept: they belonged to the beats from before a
    ``dataclasses.replace``.

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
    confidence: Array = field(default_factory=lambda: np.zeros(0))
    chord_root: Sequence[str] = ()
    sections: Sequence[Section] = ()
    key: str = ""
    tuning: float = 0.0

    def __post_init__(self) -> None:
        if not len(self.beat_strength):
            object.__setattr__(self, "beat_strength", np.ones(len(self.beats)))
        for name in ARRAYS:
            object.__setattr__(self, name, _frozen(getattr(self, name)))
        for name in ("confidence", "chord_root"):
            if len(getattr(self, name)) != len(self.beats):
                object.__setattr__(self, name, _frozen([]) if name == "confidence" else ())
        object.__setattr__(self, "chord_root", tuple(self.chord_root))
        object.__setattr__(self, "sections", tuple(self.sections))
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

    @property
    def tempo_curve(self) -> TempoCurve:
        """The local tempo at each beat."""
        return tempo_curve(self.beats)

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
            confidence=self.confidence[inside] if len(self.confidence) else self.confidence,
            chord_root=[name for name, kept in zip(self.chord_root, inside, strict=False) if kept],
            sections=_sections_within(self.sections, start, end),
            key=self.key,
            tuning=self.tuning,
        )

    def document(self) -> SongDocument:
        """The song as its document; times to 0.1 ms, values to 1e-4."""
        curve = tempo_curve(np.round(self.beats, 4))  # of the beats that a reader has
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
            confidence=np.round(self.confidence, 4).tolist(),
            tempo_curve=TempoDocument(np.round(curve.times, 4).tolist(), np.round(curve.bpm, 3).tolist()),
            chord_root=list(self.chord_root),
            sections=[
                SectionDocument(round(part.start, 4), round(part.end, 4), part.kind, round(part.novelty, 4))
                for part in self.sections
            ],
            key=self.key,
            tuning=round(self.tuning, 1),
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
        _check_lengths(document, source)
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
            np.array(document.confidence),
            document.chord_root,
            [Section(part.start, part.end, part.kind, part.novelty) for part in document.sections],
            document.key,
            document.tuning,
        )


def _check_lengths(document: SongDocument, source: str) -> None:
    for name, values in (("confidences", document.confidence), ("chord roots", document.chord_root)):
        if len(values) not in (0, len(document.beats)):
            raise AudioError(
                f"{source}: {len(document.beats)} beats have {len(values)} {name}; expected one for each beat, or none"
            )


def _sections_within(sections: Sequence[Section], start: float, end: float) -> list[Section]:
    """The parts of the sections within a stretch, on a clock that begins with it."""
    return [
        Section(max(part.start - start, 0.0), min(part.end, end) - start, part.kind, part.novelty)
        for part in sections
        if part.end > start and part.start < end
    ]
