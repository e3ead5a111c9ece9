"""The embedded song: a folk dance made from numbers alone, with its ground truth."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import soundfile

from onbeat._shapes import Array, Float32, Times
from onbeat.errors import AudioError
from onbeat.examples.accompaniment import play_guitar, play_pad
from onbeat.examples.arrangement import Section, form, lay_grid, sections
from onbeat.examples.bass import play_bass
from onbeat.examples.groove import play_drums
from onbeat.examples.harmony import Chord, choose_progressions
from onbeat.examples.mixing import Desk, master
from onbeat.examples.score import Score, write_score
from onbeat.examples.singers import play_tune
from onbeat.examples.synth import RATE
from onbeat.files import write_atomically
from onbeat.music.song import Song

_OPENING = 11  # seed 0 opens with this tune, a simple one in G major
_FORMATS = {".wav": ("WAV", "PCM_16"), ".flac": ("FLAC", "PCM_16"), ".mp3": ("MP3", "MPEG_LAYER_III")}


@dataclass(frozen=True, eq=False)
class DemoSong:
    """A song and all that is true of it.

    Parameters
    ----------
    samples : (N, 2) sound, −1…1.
    rate : samples a second.
    tempo : mean tempo in beats per minute.
    meter : beats in a bar.
    beats : (B,) seconds.
    downbeats : seconds, a subset of the beats.
    chords : the chord at each beat (root 0 = C … 11 = B, and quality).
    sections : name, start [s], end [s] and intensity 0…1 of each; they cover the song.
    title : its name.
    """

    samples: Float32
    rate: int
    tempo: float
    meter: int
    beats: Times
    downbeats: Times
    chords: tuple[Chord, ...]
    sections: tuple[Section, ...]
    title: str

    def __post_init__(self) -> None:
        for array in (self.samples, self.beats, self.downbeats):
            array.setflags(write=False)

    @property
    def duration(self) -> float:
        """Seconds."""
        return len(self.samples) / self.rate


def demo_score(
    seconds: float = 60.0, seed: int = 0, tempo: float = 106.0, meter: int = 4, drift: float = 0.02
) -> Score:
    """The score of :func:`demo_song` alone, without its sound."""
    rng = np.random.default_rng([seed + _OPENING, 0])
    grid = lay_grid(seconds, tempo, meter, drift)
    return write_score(grid, form(grid.bars), choose_progressions(rng), rng)


def demo_song(
    seconds: float = 60.0, seed: int = 0, tempo: float = 106.0, meter: int = 4, drift: float = 0.02
) -> DemoSong:
    """Compose, play and mix the embedded song; the same arguments give the same samples.

    Parameters
    ----------
    seconds : length; a shorter song has fewer sections.
    seed : chooses key, mode, chords, tune and groove.
    tempo : mean tempo in beats per minute.
    meter : beats in a bar, 3 or 4.
    drift : the tempo starts and ends this share below the mean and is as much above it in the middle.

    Raises
    ------
    AudioError
        If the song is too short for one bar and an end, or tempo, meter or drift are none of a dance.

    Examples
    --------
    >>> song = demo_song(12.0)
    >>> song.samples.shape, [section.name for section in song.sections]
    ((529200, 2), ['chorus', 'outro'])
    """
    score = demo_score(seconds, seed, tempo, meter, drift)
    desk = perform(score, seconds, seed)
    samples = master(desk.mix(np.random.default_rng([seed, 2])), fade=1.6)
    beats = np.array(score.grid.beats)
    return DemoSong(
        samples=samples,
        rate=RATE,
        tempo=_tempo(beats),
        meter=meter,
        beats=beats,
        downbeats=beats[::meter].copy(),
        chords=score.chords,
        sections=sections(score.parts, score.grid, len(samples) / RATE),
        title=f"onbeat demo song {seed}",
    )


def _tempo(beats: Times) -> float:
    """Beats per minute of the straight line nearest to the beats (by sums, whose order threads do not change)."""
    numbers = np.arange(len(beats)) - (len(beats) - 1) / 2.0
    return 60.0 * float((numbers**2).sum() / (numbers * beats).sum())


def perform(score: Score, seconds: float, seed: int) -> Desk:
    """Let all players play the score; the desk holds their tracks."""
    desk = Desk(round(seconds * RATE))
    drums, bass, guitar, tune = np.random.default_rng([seed, 1]).spawn(4)
    play_drums(desk, score, drums)
    play_bass(desk, score, bass)
    play_guitar(desk, score, guitar)
    play_pad(desk, score)
    play_tune(desk, score, tune)
    return desk


def true_song(demo: DemoSong) -> Song:
    """The ground truth as what a perfect listener hears.

    Chord change is the share of new chord tones; intensity is the sections', passing over within a beat.
    """
    changes = [1.0] + [now.change_from(before) for before, now in zip(demo.chords[:-1], demo.chords[1:], strict=True)]
    times, values = _intensity(demo)
    return Song(
        duration=demo.duration,
        tempo=demo.tempo,
        meter=demo.meter,
        beats=demo.beats,
        downbeats=demo.downbeats,
        chord_change=np.array(changes),
        intensity_times=times,
        intensity=values,
        method="truth",
        title=demo.title,
    )


def _intensity(demo: DemoSong) -> tuple[Times, Array]:
    """Ten values a second: the sections' intensity, passing over within a beat, falling to 0 with the last chord."""
    times = np.arange(0.0, demo.duration, 0.1)
    half = 30.0 / demo.tempo
    corners = [(section.start + half, section.intensity) for section in demo.sections]
    corners += [(section.end - half, section.intensity) for section in demo.sections[:-1]]
    corners += [(float(demo.beats[-1]) + half, demo.sections[-1].intensity), (demo.duration, 0.0)]
    corners.sort()
    at, values = np.array(corners).T
    return times, np.interp(times, at, values)


def write(demo: DemoSong, path: str | os.PathLike[str]) -> None:
    """Write the sound to a .wav, .flac or .mp3 file, whole or not at all; the same song gives the same bytes.

    Raises
    ------
    AudioError
        If the name ends otherwise. (Ogg is left out: each of its files carries a random serial number.)
    """
    suffix = Path(path).suffix.lower()
    if suffix not in _FORMATS:
        raise AudioError(f"cannot write {path}: the song is written as {', '.join(_FORMATS)}; choose one of these")
    write_atomically(path, encode(demo, suffix))


def encode(demo: DemoSong, suffix: str = ".flac") -> bytes:
    """The sound as the bytes of a .wav, .flac or .mp3 file."""
    container, subtype = _FORMATS[suffix]
    buffer = io.BytesIO()
    soundfile.write(buffer, demo.samples, demo.rate, format=container, subtype=subtype)
    return buffer.getvalue()
