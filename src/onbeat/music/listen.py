"""Hearing a song: from a file to its beats, downbeats, chord changes and intensity."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from onbeat._shapes import Float32
from onbeat.errors import AudioError
from onbeat.music.audio import RATE, Audio, audio_duration, read_blocks
from onbeat.music.fixes import NOTHING, Corrections
from onbeat.music.song import Song

SHORTEST = 2.0  # [s] two beats at the slowest tempo need this long
SILENT = 1e-4  # highest sample (−80 dB) under which a song is silent

Progress = Callable[[float], None]
Method = Callable[[Iterable[Float32], int, Progress | None], Song]

METHODS = ("barpointer", "onsets", "shiratori2006")
LITERAL = ("shiratori2006",)  # what these say of chord changes and intensity stays as they say it


def _method(name: str) -> Method:
    # Imported when called: scipy and numba take a second that `onbeat --help` need not wait for.
    if name == "barpointer":
        from onbeat.music.barpointer import listen_barpointer

        return listen_barpointer
    if name == "onsets":
        from onbeat.music.onset_tracker import listen_onsets

        return listen_onsets
    if name == "shiratori2006":
        from onbeat.music.shiratori2006 import listen_shiratori2006

        return listen_shiratori2006
    raise AudioError(f"no listening method {name!r}; there are {', '.join(METHODS)}")


def _same_bits() -> threadpool_limits:
    """Products of matrices on one thread: on more, their last bits differ, and with them those of the dance."""
    return threadpool_limits(1, "blas")


def _watched(blocks: Iterable[Float32], rate: int, name: str) -> Iterator[Float32]:
    """The blocks as they pass by; at their end a song that is too short or silent is refused, before it is analysed."""
    samples, peak = 0, 0.0
    for block in blocks:
        samples += len(block)
        peak = max(peak, float(np.abs(block).max(initial=0.0)))
        yield block
    seconds = samples / rate
    if seconds < SHORTEST:
        raise AudioError(f"{name}: {seconds:.2f} s is too short to hear a beat in; give at least {SHORTEST:g} s")
    if peak < SILENT:
        raise AudioError(
            f"{name}: silent for all of its {seconds:.1f} s (highest sample {peak:.1g} of 1): nothing to dance to; "
            "check the file, or choose another stretch with --start and --seconds"
        )


class _Stretch(NamedTuple):
    """What is heard of a sound: its name for messages, where the stretch begins, and how long the whole is; seconds."""

    name: str
    start: float
    length: float


def _hear(
    blocks: Iterable[Float32], rate: int, method: str, stretch: _Stretch, fixes: Corrections, progress: Progress | None
) -> Song:
    from onbeat.music.corrections import correct
    from onbeat.music.describe import as_perceived, describe
    from onbeat.music.profile import Profiler
    from onbeat.music.pulse import has_pulse, without_beats

    heard_by, profiler = _method(method), Profiler(rate)
    with _same_bits():
        song = heard_by(profiler.watch(_watched(blocks, rate, stretch.name)), rate, progress)
        profile = profiler.profile()
        if method not in LITERAL:
            song = as_perceived(song if has_pulse(profile, song.beats) else without_beats(song), profile)
        return describe(correct(song, profile, fixes, stretch.start, stretch.length), profile)


def listen_samples(
    audio: Audio,
    method: str = METHODS[0],
    title: str = "",
    progress: Progress | None = None,
    corrections: Corrections = NOTHING,
) -> Song:
    """Hear sound that is in memory already; arguments as of :func:`listen`.

    Raises
    ------
    AudioError
        If it is silent, or shorter than two seconds.
    """
    block = 20 * audio.rate
    blocks = (audio.samples[begin : begin + block] for begin in range(0, len(audio.samples), block))
    stretch = _Stretch(title or "the sound", 0.0, audio.duration)
    return replace(_hear(blocks, audio.rate, method, stretch, corrections, progress), title=title)


def listen(
    path: str | os.PathLike[str],
    method: str = METHODS[0],
    start: float = 0.0,
    seconds: float | None = None,
    progress: Progress | None = None,
    corrections: Corrections = NOTHING,
) -> Song:
    """Hear a song.

    Parameters
    ----------
    path : wav, flac, ogg or mp3; with the extra ``video`` also m4a, mp4 and others.
    method : one of ``METHODS``.
    start, seconds : the stretch to hear; the song's clock then starts at ``start``.
    progress : called with the seconds heard so far.
    corrections : beats, tempo or bars that somebody knows better.

    Raises
    ------
    AudioError
        If the file cannot be read, is silent, or is shorter than two seconds.
    """
    blocks = read_blocks(path, start, seconds, RATE)
    stretch = _Stretch(str(path), start, audio_duration(path))
    song = _hear(blocks, RATE, method, stretch, corrections, progress)
    return replace(song, title=os.fsencode(Path(path).stem).decode(errors="replace"))  # any bytes may name a file
