"""The songs of the 2006 paper's experiments: heard as published and as onbeat hears, and what is true."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import soxr

from onbeat._shapes import Times
from onbeat.errors import OnbeatError
from onbeat.metrics.beats import f_measure
from onbeat.music.audio import RATE, Audio, read_audio
from onbeat.music.beat_files import read_beats
from onbeat.music.listen import listen_samples
from onbeat.music.picture import Envelope
from onbeat.music.song import Song
from onbeat.music.tempo import tempo_of
from onbeat.reproduce.data import Data

SECONDS, QUICK = 60.0, 20.0
"""Length of the songs; the paper's lasted about a minute."""
TEMPI = (100, 134, 84, 108, 76, 124, 92, 140, 84, 116, 100, 132, 148)
"""BPM of the 13 composed songs: those of the paper's Table I, then ten from 76 to 148 in steps of eight, mixed."""
METERS = (4, 4, 4, 4, 4, 3, 4, 4, 3, 4, 4, 3, 4)
FEW = 5
"""How many of them for a first look."""
WITHIN = 0.07
"""Seconds within which a beat is found, as beat trackers are judged."""
TRACKED = 0.9
"""F of beats from which on a song is said to be tracked; the paper does not say how it judged."""


@dataclass(frozen=True, eq=False)
class Tune:
    """A song, what is true of it and what is heard in it.

    Parameters
    ----------
    title : its name.
    truth : what is true of it, or where nobody knows, what onbeat hears.
    known : how the beats of ``truth`` are known: ``composed``, ``annotated``, or ``heard`` where they are not.
    published : heard as in Sec. III of the paper.
    ours : heard by onbeat.
    envelope : its waveform from afar.
    """

    title: str
    truth: Song
    known: str
    published: Song
    ours: Song
    envelope: Envelope


def interval(beats: Times) -> float:
    """Average seconds from a beat to the next, by a line through all; 0 for fewer than two.

    >>> round(interval(np.array([0.0, 0.6, 1.2])), 6)
    0.6
    """
    tempo = tempo_of(beats)
    return 60.0 / tempo if tempo > 0 else 0.0


def found(tune: Tune, heard: Song) -> float:
    """F of the heard beats against the true ones, within ``WITHIN`` seconds; the first second is not asked."""
    return f_measure(heard.beats[heard.beats >= 1.0], tune.truth.beats[tune.truth.beats >= 1.0], WITHIN)


def check_songs(data: Data) -> None:
    """Refuse songs that are not there, before anything is heard."""
    for path in data.songs:
        if not path.is_file():
            what = f"{path} is a folder" if path.is_dir() else f"no song {path}"
            raise OnbeatError(f"{what}; give audio files to --songs")


def tunes(data: Data, step: Callable[[float, str], None]) -> list[Tune]:
    """The songs that were given, or the composed ones.

    Raises
    ------
    OnbeatError
        If a song cannot be read or heard, or the beats beside one cannot.
    """
    check_songs(data)
    seconds = QUICK if data.quick else SECONDS
    made: list[Callable[[], Tune]] = []
    if data.songs:
        made = [lambda path=path: _read(path, seconds) for path in data.songs]
    else:
        count = FEW if data.quick else len(TEMPI)
        made = [lambda number=number: _composed(number, seconds, data.seed) for number in range(count)]
    every: list[Tune] = []
    for number, make in enumerate(made):
        step(number / len(made), f"hearing song {number + 1} of {len(made)}")
        every.append(make())
    return every


def _composed(number: int, seconds: float, seed: int) -> Tune:
    from onbeat.examples.song import demo_song, true_song

    song = demo_song(seconds, 1000 * seed + number + 1, float(TEMPI[number]), METERS[number])
    mono = np.asarray(soxr.resample(song.samples.mean(axis=1), song.rate, RATE), np.float32)
    title = f"composed song {number + 1}"
    return _heard(Audio(mono, RATE), title, replace(true_song(song), title=title), "composed")


def _read(path: Path, seconds: float) -> Tune:
    """A song of somebody's; beats in ``NAME.beats`` beside it are taken as true."""
    audio = read_audio(path, seconds=seconds)
    beside = path.with_suffix(".beats")
    if not beside.exists():
        return _heard(audio, path.stem)
    beats = read_beats(beside).times
    beats = beats[beats <= audio.duration]
    tune = _heard(audio, path.stem)
    empty = np.zeros(0)
    truth = replace(
        tune.ours, tempo=tempo_of(beats), beats=beats, downbeats=empty, chord_change=np.zeros(len(beats)),
        beat_strength=empty,
    )  # fmt: skip
    return replace(tune, truth=truth, known="annotated")


def _heard(audio: Audio, title: str, truth: Song | None = None, known: str = "heard") -> Tune:
    published = listen_samples(audio, "shiratori2006", title)
    ours = listen_samples(audio, title=title)
    return Tune(title, truth or ours, known, published, ours, Envelope.of([audio.samples], audio.rate))
